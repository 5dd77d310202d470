#include "flexarm/accuracy/trajectory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"

namespace flexarm {
namespace {

/// Relative to the mechanism's size. Points that move by less are at rest.
constexpr double kAtRest = 1e-6;

}  // namespace

double largest_displacement(const Trajectory& trajectory) {
  double largest = 0;
  for (const Vector3& point : trajectory) largest = std::max(largest, (point - trajectory.front()).norm());
  return largest;
}

double trajectory_distance(const Trajectory& trajectory, const Trajectory& reference) {
  if (reference.size() < 2 || trajectory.size() != reference.size())
    throw std::invalid_argument(fmt::format("a trajectory of {} points cannot be compared with a reference of {}",
                                            trajectory.size(), reference.size()));
  const std::size_t last = reference.size() - 1;
  double sum = 0;
  for (std::size_t i = 0; i <= last; ++i) {
    const double weight = i == 0 || i == last ? 0.5 : 1.0;
    sum += weight * (trajectory[i] - reference[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(last));
}

double trajectory_error(const Trajectory& trajectory, const Trajectory& reference) {
  const double distance = trajectory_distance(trajectory, reference);
  const double scale = largest_displacement(reference);
  if (!(scale > 0)) throw std::invalid_argument("the reference does not move");
  return distance / scale;
}

JudgedPoints::JudgedPoints(const Simulation& simulation, const std::string& frame)
    : has_probes_(!simulation.scene().probes.empty()), count_(simulation.scene().probes.size()) {
  const std::vector<std::string>& names = simulation.link_names();
  for (std::size_t link = 0; link < names.size(); ++link)
    if (!simulation.is_fixed_to_world(link) || simulation.is_flexible(link)) links_.push_back(link);
  if (frame.empty()) return;
  const auto found = std::find(names.begin(), names.end(), frame);
  if (found == names.end()) throw std::invalid_argument(fmt::format("there is no link '{}'", frame));
  frame_ = found - names.begin();
}

void JudgedPoints::positions(const Simulation& simulation, std::vector<Vector3>& positions) const {
  positions.resize(size());
  for (std::size_t i = 0; i < size(); ++i)
    positions[i] = has_probes_ ? simulation.probe_pose(i).position : simulation.tip_pose(links_[i]).position;
  if (!frame_) return;
  const Pose frame = simulation.link_pose(*frame_);
  for (Vector3& position : positions) position = frame.orientation.conjugate() * (position - frame.position);
}

std::vector<Vector3> JudgedPoints::positions(const Simulation& simulation) const {
  std::vector<Vector3> found;
  positions(simulation, found);
  return found;
}

void JudgedMotion::add(const std::vector<Vector3>& positions) {
  if (positions.size() != points.size())
    throw std::invalid_argument(
        fmt::format("positions: expected those of {} points, got {}", points.size(), positions.size()));
  for (std::size_t i = 0; i < points.size(); ++i) points[i].push_back(positions[i]);
}

double JudgedMotion::largest_displacement() const {
  double largest = 0;
  for (const Trajectory& point : points) largest = std::max(largest, flexarm::largest_displacement(point));
  return largest;
}

bool is_at_rest(const JudgedMotion& motion, double mechanism) {
  return motion.largest_displacement() < kAtRest * mechanism;
}

double length_of_errors(const JudgedMotion& motion, double mechanism) {
  return is_at_rest(motion, mechanism) ? mechanism : motion.largest_displacement();
}

double motion_error(const JudgedMotion& motion, const JudgedMotion& reference, double scale) {
  if (motion.points.size() != reference.points.size())
    throw std::invalid_argument(fmt::format("a motion of {} points cannot be compared with one of {}",
                                            motion.points.size(), reference.points.size()));
  if (!(scale > 0)) throw std::invalid_argument("a scale of errors must be positive");
  double largest = 0;
  for (std::size_t i = 0; i < motion.points.size(); ++i)
    largest = std::max(largest, trajectory_distance(motion.points[i], reference.points[i]));
  return largest / scale;
}

}  // namespace flexarm
