#include "integrators/explicit_reactions.h"

#include "integrators/explicit_loads.h"
#include "integrators/held_efforts.h"

namespace flexarm {
namespace {

Vector3 position_of(const ArticulatedBodies& bodies, int node) {
  return node < 0 ? Vector3(Vector3::Zero()) : bodies.position(node);
}

Matrix3 rotation_of(const ArticulatedBodies& bodies, int node) {
  return node < 0 ? Matrix3(Matrix3::Identity()) : bodies.rotation(node);
}

/// Moves the point that a wrench's moment is about by `way`.
Vector6 about(Vector6 wrench, const Vector3& way) {
  wrench.tail<3>() -= way.cross(Vector3(wrench.head<3>()));
  return wrench;
}

}  // namespace

Vector6 ExplicitReactions::transmitted(const ReactionPlace& place, const ArticulatedBodies& bodies,
                                       const std::vector<Vector6>& closures) const {
  const bool closes = place.closure >= 0;
  const int node = closes ? model_.closures[place.closure].child : model_.joints[place.joint].slave;
  const Vector6& wrench = closes ? closures[place.closure] : bodies.transmitted(place.joint);
  const Vector3 point =
      position_of(bodies, place.point.node) + rotation_of(bodies, place.point.node) * place.point.offset.position;
  return (place.is_reversed ? -1 : 1) * about(wrench, point - bodies.position(node));
}

double ExplicitReactions::held_effort(const HeldJoint& held, const ArticulatedBodies& bodies,
                                      const std::vector<double>& values, const State& state) const {
  const JointMap& joint = model_.joints[model_.coordinates[held.coordinate].joint];
  const int node = joint.master;
  const Vector3 place = position_of(bodies, node);
  const Matrix3 rotation = rotation_of(bodies, node);
  Vector6 wrench = node < 0 ? Vector6(Vector6::Zero()) : momentum_rate(held, state.nodes[node]);
  wrench.head<3>() -= held.mass * model_.gravity;
  wrench = about(wrench, -(rotation * held.centre));
  for_each_load(model_, state, values, bodies, [&](const NodalLoad& load, const Vector6& acting) {
    if (load.link >= 0 && held.links[load.link]) wrench -= acting;
  });
  for (const int outboard : held.outboard)
    wrench += about(bodies.transmitted(outboard), place - bodies.position(model_.joints[outboard].slave));
  const Vector3 axis = rotation * joint.rotation,
                travel = rotation * joint.translation + axis.cross(Vector3(rotation * joint.arm));
  return travel.dot(wrench.head<3>()) + axis.dot(wrench.tail<3>());
}

void ExplicitReactions::accept(const ArticulatedBodies& bodies, const std::vector<Vector6>& closures,
                               const std::vector<double>& values, State& state) const {
  for (std::size_t i = 0; i < model_.reactions.size(); ++i)
    Eigen::Map<Vector6>(state.last_transmitted.data() + 6 * i) = transmitted(model_.reactions[i], bodies, closures);
  for (const HeldJoint& held : model_.held) state.efforts[held.coordinate] = held_effort(held, bodies, values, state);
}

}  // namespace flexarm
