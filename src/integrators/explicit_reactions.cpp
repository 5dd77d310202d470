#include "integrators/explicit_reactions.h"

#include "integrators/explicit_loads.h"

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

/// The rate of momentum of the links that a held joint carries, minus their weight, about their centre of mass.
Vector6 needed_wrench(const HeldJoint& held, int node, const Vector3& gravity, const ArticulatedBodies& bodies) {
  Vector6 wrench = Vector6::Zero();
  wrench.head<3>() = -held.mass * gravity;
  if (node < 0) return wrench;
  const Matrix3& rotation = bodies.rotation(node);
  const Vector3 centre = rotation * held.centre, spin = bodies.velocity(node).tail<3>(),
                change = bodies.acceleration(node).tail<3>();
  const Matrix3 inertia = rotation * held.inertia * rotation.transpose();
  wrench.head<3>() += held.mass * (bodies.acceleration(node).head<3>() + change.cross(centre) +
                                   spin.cross(Vector3(spin.cross(centre))));
  wrench.tail<3>() = inertia * change + spin.cross(Vector3(inertia * spin));
  return wrench;
}

}  // namespace

Vector6 ExplicitReactions::transmitted(const ReactionPlace& place, const ArticulatedBodies& bodies,
                                       const std::vector<Vector6>& closures) const {
  const bool closes = place.closure >= 0;
  const int node = closes ? model_.closures[place.closure].child : model_.joints[place.joint].slave;
  const Vector6& wrench = closes ? closures[place.closure] : bodies.transmitted(place.joint);
  const Vector3 link =
      position_of(bodies, place.link.node) + rotation_of(bodies, place.link.node) * place.link.offset.position;
  return (place.is_reversed ? -1 : 1) * about(wrench, link - bodies.position(node));
}

double ExplicitReactions::held_effort(const HeldJoint& held, const ArticulatedBodies& bodies,
                                      const std::vector<double>& values, const State& state) const {
  const JointMap& joint = model_.joints[model_.coordinates[held.coordinate].joint];
  const int node = joint.master;
  const Vector3 place = position_of(bodies, node);
  const Matrix3 rotation = rotation_of(bodies, node);
  Vector6 wrench = about(needed_wrench(held, node, model_.gravity, bodies), -(rotation * held.centre));
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
