#include "messages/trails.h"

#include <algorithm>

#include "flexarm/scene/scene_description.h"
#include "messages/colors.h"
#include "messages/conversions.h"
#include "messages/markers.h"

namespace flexarm::messages {
namespace {

/// Largest number of instants on a trail, however fast the simulation runs; instants in between are dropped.
constexpr double kMostInstants = 500;

}  // namespace

void Trails::update() {
  const double now = simulation_.time();
  if (!instants_.empty() && now < instants_.back().time) instants_.clear();
  while (!instants_.empty() && instants_.front().time < now - duration_) instants_.pop_front();
  // The newest instant stays on the trail only if the instant before it is far enough back in time.
  const std::size_t count = instants_.size();
  if (count >= 2 && now - instants_[count - 2].time < duration_ / kMostInstants) instants_.pop_back();
  if (!instants_.empty() && instants_.back().time == now) return;
  Instant instant{now, {}};
  for (std::size_t i = 0; i < simulation_.scene().probes.size(); ++i)
    instant.places.push_back(simulation_.probe_pose(i).position);
  instants_.push_back(std::move(instant));
}

void Trails::add_to(const std_msgs::Header& header, double width, visualization_msgs::MarkerArray& message) const {
  for (std::size_t i = 0; i < simulation_.scene().probes.size(); ++i) {
    visualization_msgs::Marker line =
        make_marker(header, "trails", visualization_msgs::Marker::LINE_STRIP, static_cast<int>(i) + 1);
    line.scale.x = width;
    if (instants_.size() >= 2)
      for (const Instant& instant : instants_) {
        const double age = (instants_.back().time - instant.time) / duration_;
        line.points.push_back(to_point(instant.places[i]));
        line.colors.push_back(make_color(0.9, 0.9, 0.5, std::max(1 - age, 0.0)));
      }
    add_if_any(std::move(line), message);
  }
}

}  // namespace flexarm::messages
