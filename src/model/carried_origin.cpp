#include "model/carried_origin.h"

#include <cassert>
#include <cmath>

namespace flexarm {

Vector3 carried_translation(const JointMap& joint, const State& state) {
  if (joint.kind != JointMapKind::Free || joint.master >= 0) return Vector3::Zero();
  return joint.origin.orientation.conjugate() * state.origin;
}

void carry_origin(const Model& model, State& state) {
  assert(state.nodes.size() == model.nodes.size() && state.released.size() == model.joints.size_with_held());
  if (!model.floats) return;
  const Vector3& place = state.nodes[model.joints.front().slave].position;
  if (place.norm() <= kFarInSizes * model.length_scale) return;
  // Move the origin by multiples of a power of two, so that subtracting them is exact.
  const double unit = std::exp2(std::ceil(std::log2(model.length_scale)));
  const Vector3 way = unit * (place / unit).array().round();
  state.origin += way;
  for (NodeState& node : state.nodes) node.position -= way;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointMap& joint = model.joints[j];
    if (joint.master < 0) state.released[j].displacement -= joint.origin.orientation.conjugate() * way;
  }
}

}  // namespace flexarm
