#include "building/spring_builder.h"

#include <utility>

#include "building/model_builder.h"
#include "joints/closure_maps.h"

namespace flexarm {
namespace {

NodePose pose_of(const Model& model, int node) {
  return node < 0 ? NodePose() : model.nodes[node];
}

/// In the frame of its node [m].
Vector3 arm_of(const Attachment& place, const Vector3& point) {
  return place.offset * point;
}

}  // namespace

void place_springs(const ScenePlan& plan, Model& model) {
  for (const scene::PointSpring& spring : plan.scene.point_springs) {
    Attachment from = attachment(plan, model, spring.from, spring.from_at);
    Attachment to = attachment(plan, model, spring.to, spring.to_at);
    LoopClosure ends;
    ends.parent_arm = arm_of(from, spring.from_at);
    ends.child_arm = arm_of(to, spring.to_at);
    ends.parent = from.node;
    ends.child = to.node;
    if (from.node == to.node)
      throw ModelError(at(spring.location, "<spring>") + "both ends belong to the same rigid body");
    if (ends.child < 0) {
      std::swap(ends.parent, ends.child);
      std::swap(ends.parent_arm, ends.child_arm);
    }
    ends.name = "spring from " + spring.from + " to " + spring.to;
    const NodePose parent = pose_of(model, ends.parent), child = pose_of(model, ends.child);
    const double length =
        (child.position + child.rotation * ends.child_arm - parent.position - parent.rotation * ends.parent_arm).norm();
    model.springs.push_back({static_cast<int>(model.closures.size()), spring.stiffness,
                             spring.rest_length.value_or(length), spring.damping});
    model.closures.push_back(ends);
  }
}

}  // namespace flexarm
