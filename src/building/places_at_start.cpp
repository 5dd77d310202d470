#include "building/places_at_start.h"

#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "building/elementary_joints.h"
#include "building/scene_plan.h"
#include "joints/joint_kinematics.h"

namespace flexarm {
namespace {

/// Largest gap of a loop, relative to the extent of the mechanism, that counts as round-off of the numbers in a scene.
constexpr double kRoundOffGap = 1e-6;
/// A joint is far beyond the end of a line if it is further away than this part of the line's length.
constexpr double kFarBeyond = 0.25;

scene::Diagnostic warning_about(const scene::JointDescription& joint, const char* tag, const std::string& text,
                                double length) {
  return {scene::Diagnostic::Severity::Warning,
          joint.location.file,
          joint.location.line,
          fmt::format("<{}> '{}'", tag, joint.name),
          fmt::format("'{:.3g}' m", length),
          text};
}

/// How far a point (link frame) is beyond the nearer end of a line, in the direction of the line there [m]; 0: beside
/// the line.
double way_beyond(const Centreline& line, const Vector3& point) {
  const double nearest = line.nearest(point), length = line.length();
  if (nearest > 0 && nearest < length) return 0;
  const Pose end = line.at(nearest);
  const double way = (point - end.position).dot(end.orientation * Vector3::UnitX());
  return nearest > 0 ? way : -way;
}

}  // namespace

double loop_gap(const scene::JointDescription& joint, const Pose& parent, const Pose& child) {
  const Pose frame = parent * joint.origin;
  NodePose meeting{frame.position, frame.orientation, frame.orientation.toRotationMatrix()};
  for (const JointMap& map : elementary_joints(joint)) meeting = slave_pose(map, meeting, Released());
  return (meeting.position - (child * joint.child_origin).position).norm();
}

scene::Diagnostics open_loops(const scene::SceneDescription& scene, const Model& model) {
  std::unordered_map<std::string, Pose> links;  // at the start
  for (const LinkFrame& link : model.links) {
    const Attachment& frame = link.frame;
    const Pose node =
        frame.node < 0 ? Pose() : Pose{model.nodes[frame.node].position, model.nodes[frame.node].orientation};
    links.emplace(link.name, node * frame.offset);
  }
  scene::Diagnostics findings;
  for (const scene::JointDescription& joint : scene.loop_joints) {
    const double gap = loop_gap(joint, links.at(joint.parent), links.at(joint.child));
    if (gap > kRoundOffGap * model.length_scale)
      findings.push_back(warning_about(
          joint, "loop_joint",
          fmt::format("the loop is open at the start; its place on link '{}' is moved to close it", joint.child), gap));
  }
  return findings;
}

scene::Diagnostics joints_beyond_beams(const scene::SceneDescription& scene) {
  std::unordered_map<std::string, Centreline> lines;
  for (const scene::LinkDescription& link : scene.links)
    if (link.beam) lines.emplace(link.name, centreline_of(link));
  scene::Diagnostics findings;
  const auto judge = [&](const scene::JointDescription& joint, const char* tag, const std::string& link,
                         const Vector3& place) {
    const auto line = lines.find(link);
    if (line == lines.end() || joint.is_hidden) return;
    const double length = line->second.length(), beyond = way_beyond(line->second, place);
    if (beyond > kFarBeyond * length)
      findings.push_back(warning_about(
          joint, tag,
          fmt::format("its place on link '{}' is beyond the end of the line, which is {:.6g} m long: a rigid offset "
                      "connects them",
                      link, length),
          beyond));
  };
  for (const scene::JointDescription& joint : scene.joints) judge(joint, "joint", joint.parent, joint.origin.position);
  for (const scene::JointDescription& joint : scene.loop_joints) {
    judge(joint, "loop_joint", joint.parent, joint.origin.position);
    judge(joint, "loop_joint", joint.child, joint.child_origin.position);
  }
  return findings;
}

}  // namespace flexarm
