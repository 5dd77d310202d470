#include "pull_handles.h"

#include <ros/console.h>

#include <algorithm>
#include <utility>

#include "flexarm/scene/scene_description.h"
#include "messages/conversions.h"
#include "pictures/scene_extent.h"

namespace flexarm::node {
namespace {

constexpr double kSize = 0.06;  ///< size of a handle per radius of the scene
/// rviz sends feedback four times a second while a marker is dragged.
constexpr std::chrono::milliseconds kPatience(1500);
constexpr double kPullWarningPeriod = 1;  // s

visualization_msgs::InteractiveMarkerControl ball(double size) {
  visualization_msgs::Marker marker;
  marker.type = visualization_msgs::Marker::SPHERE;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  marker.color.r = marker.color.g = marker.color.b = 0.9F;
  marker.color.a = 0.5F;
  visualization_msgs::InteractiveMarkerControl control;
  control.name = "pull";
  control.orientation.w = 1;
  control.orientation_mode = visualization_msgs::InteractiveMarkerControl::VIEW_FACING;
  control.interaction_mode = visualization_msgs::InteractiveMarkerControl::MOVE_3D;
  control.always_visible = 1;
  control.markers.push_back(marker);
  return control;
}

}  // namespace

PullHandles::PullHandles(const ros::NodeHandle& private_node, const Simulation& shown, const std::string& root_frame,
                         const Spring& spring, Apply apply)
    : shown_(shown),
      root_frame_(root_frame),
      spring_(spring),
      apply_(std::move(apply)),
      server_(private_node.resolveName("pull")) {
  add_handles();
  const double size = kSize * pictures::scene_extent(shown).radius;
  for (const Handle& handle : handles_) show(handle, size);
  for (Handle& handle : handles_)
    server_.setCallback(shown_.link_names()[handle.link],
                        [this, &handle](const visualization_msgs::InteractiveMarkerFeedbackConstPtr& feedback) {
                          receive(handle, *feedback);
                        });
  server_.applyChanges();
}

void PullHandles::add_handles() {
  const std::vector<scene::Probe>& probes = shown_.scene().probes;
  for (std::size_t link = 0; link < shown_.link_names().size(); ++link) {
    if (shown_.is_fixed_to_world(link)) continue;
    Handle handle{link, Vector3::Zero(), nullptr, std::nullopt, {}};
    const auto probe = std::find_if(probes.begin(), probes.end(),
                                    [&](const scene::Probe& each) { return each.link == shown_.link_names()[link]; });
    const auto& inertial = shown_.scene().links[link].inertial;
    if (probe != probes.end()) {
      handle.at = probe->at;
      handle.place = [this, index = probe - probes.begin()] { return shown_.probe_pose(index).position; };
    } else if (shown_.scene().links[link].beam) {
      handle.at = shown_.undeformed_sections(link, 0).back().position;
      handle.place = [this, link] { return shown_.tip_pose(link).position; };
    } else {
      if (inertial) handle.at = inertial->center_of_mass;
      handle.place = [this, link, at = handle.at] { return shown_.link_pose(link) * at; };
    }
    handles_.push_back(std::move(handle));
  }
}

void PullHandles::show(const Handle& handle, double size) {
  visualization_msgs::InteractiveMarker marker;
  // No stamp, so that rviz answers in this frame, whatever its fixed frame is.
  marker.header.frame_id = root_frame_;
  marker.name = shown_.link_names()[handle.link];
  marker.scale = static_cast<float>(size);
  marker.pose.position = messages::to_point(handle.place());
  marker.pose.orientation.w = 1;
  marker.controls.push_back(ball(size));
  server_.insert(marker);
}

void PullHandles::follow() {
  geometry_msgs::Pose pose;
  pose.orientation.w = 1;
  for (const Handle& handle : handles_) {
    if (handle.target) continue;
    pose.position = messages::to_point(handle.place());
    server_.setPose(shown_.link_names()[handle.link], pose);
  }
  server_.applyChanges();
}

void PullHandles::receive(Handle& handle, const Feedback& feedback) {
  handle.last_feedback = Clock::now();
  if (feedback.event_type == Feedback::MOUSE_UP) {
    if (std::exchange(handle.target, std::nullopt)) apply();
    return;
  }
  if (feedback.event_type != Feedback::POSE_UPDATE) return;
  const Vector3 target = messages::to_vector(feedback.pose.position);
  if (feedback.header.frame_id != root_frame_ || !target.allFinite()) {
    ROS_WARN_STREAM_THROTTLE(kPullWarningPeriod, "'" << feedback.marker_name
                                                     << "' is not pulled: expected finite coordinates in "
                                                     << "frame '" << root_frame_ << "', got " << target.transpose()
                                                     << " in '" << feedback.header.frame_id << "'");
    return;
  }
  handle.target = target;
  apply();
}

void PullHandles::let_go_of_lost() {
  bool any = false;
  for (Handle& handle : handles_)
    if (handle.target && Clock::now() - handle.last_feedback > kPatience) {
      handle.target.reset();
      any = true;
    }
  if (any) apply();
}

void PullHandles::forget() {
  for (Handle& handle : handles_) handle.target.reset();
}

void PullHandles::apply() const {
  std::vector<AppliedWrench> pulls;
  for (const Handle& handle : handles_)
    if (handle.target)
      pulls.push_back({handle.link, handle.at, {}, false, {*handle.target, spring_.stiffness, spring_.damping}});
  apply_(pulls);
}

}  // namespace flexarm::node
