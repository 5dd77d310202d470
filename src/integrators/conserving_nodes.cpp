#include "integrators/conserving_nodes.h"

#include <cassert>

#include "elements/node_motion.h"
#include "integrators/gathered.h"
#include "math/lanes.h"
#include "math/simd.h"

namespace flexarm {
namespace {

template <class NodePack>
void scatter(const NodePack& pack, const ConservingNode<Pack>& node, Balance& balance) {
  std::array<double*, Pack::kLanes> targets = {};  // initialised for compilers that warn about unused lanes
  for (int lane = 0; lane < pack.lanes; ++lane) targets[lane] = balance.residual.at(pack.nodes[lane]);
  add_lanes<6>(node.residual.data(), pack.lanes, targets.data());
  for (int lane = 0; lane < pack.lanes && balance.tangent; ++lane) {
    Eigen::Map<Matrix6> tangent(balance.tangent->diagonal_block(pack.nodes[lane]));
    for (int c = 0; c < 3; ++c) {
      tangent(c, c) += node.translational[lane];
      for (int r = 0; r < 3; ++r) tangent(3 + r, 3 + c) += node.rotational(r, c)[lane];
    }
  }
}

}  // namespace

ConservingNodes::ConservingNodes(const Model& model, const TimeRule& rule) : velocity_factor_(rule.velocity_factor()) {
  int lane = 0;
  for (std::size_t i = 0; i < model.inertias.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    Matrix3 rotary = inertia.rotary;
    if (rule.nodal_rotary_inertia) rotary += inertia.beam_rotary;
    const bool is_damped = !inertia.rotary_damping.isZero(0);
    if (inertia.mass == 0 && rotary.isZero(0) && !is_damped) continue;
    if (lane == 0) packs_.emplace_back();
    NodePack& pack = packs_.back();
    for (int l = lane; l < Pack::kLanes; ++l) {
      pack.nodes[l] = static_cast<int>(i);
      set_lane(pack.inertia.mass, l, inertia.mass);
      set_lane(pack.inertia.rotary, l, rotary);
      set_lane(pack.damping, l, inertia.rotary_damping);
    }
    pack.is_damped = pack.is_damped || is_damped;
    pack.lanes = lane + 1;
    lane = (lane + 1) % Pack::kLanes;
  }
}

void ConservingNodes::add(const StepMotion& step, Balance& balance) const {
  simd::run([&] {
    for (const NodePack& pack : packs_) {
      const auto begin = [&](int lane) -> const NodePose& { return step.begin[pack.nodes[lane]]; };
      const auto end = [&](int lane) -> const NodePose& { return step.end[pack.nodes[lane]]; };
      const auto state = [&](int lane) -> const NodeState& { return step.state.nodes[pack.nodes[lane]]; };
      NodeMotion<Pack> node;
      node.begin = gathered_quaternion([&](int lane) -> const Quaternion& {
                     return begin(lane).orientation;
                   }).toRotationMatrix();
      node.end =
          gathered_quaternion([&](int lane) -> const Quaternion& { return end(lane).orientation; }).toRotationMatrix();
      node.displacement = gathered_vector([&](int lane) -> const Vector3& { return end(lane).position; }) -
                          gathered_vector([&](int lane) -> const Vector3& { return begin(lane).position; });
      node.increment = gathered_vector([&](int lane) -> const Vector3& { return step.increments[pack.nodes[lane]]; });
      node.velocity = gathered_vector([&](int lane) -> const Vector3& { return state(lane).velocity; });
      node.angular_velocity = gathered_vector([&](int lane) -> const Vector3& { return state(lane).angular_velocity; });
      node.inverse_tangent = cayley::inverse_tangent(node.increment);
      const bool with_tangent = balance.tangent != nullptr;
      ConservingNode<Pack> forces(pack.inertia, node, velocity_factor_, step.step, with_tangent);
      if (pack.is_damped) {
        const NodeDamping<Pack> damping(pack.damping, node, step.step, with_tangent);
        forces.residual.tail<3>() += damping.moment;
        if (with_tangent) forces.rotational += damping.derivative;
        for (int lane = 0; lane < pack.lanes; ++lane) balance.dissipated += damping.dissipated[lane];
      }
      scatter(pack, forces, balance);
    }
  });
}

NodeState motion_at_end(const StepConfiguration& configuration, int node) {
  return advanced(configuration.scheme(), configuration.begin()[node], configuration.end()[node],
                  configuration.state().nodes[node], configuration.increments()[node], configuration.step());
}

void advance_nodes(const StepConfiguration& configuration, State& state) {
  assert(state.nodes.size() == configuration.begin().size());
  for (std::size_t i = 0; i < state.nodes.size(); ++i)
    state.nodes[i] = motion_at_end(configuration, static_cast<int>(i));
}

}  // namespace flexarm
