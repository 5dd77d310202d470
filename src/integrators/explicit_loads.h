#pragma once
/// Loads and wrenches of programs at an instant, for explicit schemes. (docs/notes/explicit.md 3)

#include <vector>

#include "elements/load.h"
#include "joints/articulated_bodies.h"
#include "model/carried_origin.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// {force, moment about the load's node}, world axes [N, N m]. `scale`: value of the load's function of time.
inline Vector6 load_wrench(const NodalLoad& load, double scale, const ArticulatedBodies& bodies) {
  const Matrix3& rotation = bodies.rotation(load.node);
  return load_action(load, scale, rotation, rotation, LoadPoint::End).wrench;
}

/// The same for the spring of a load. `origin`: of the bodies' positions, in the world [m].
inline Vector6 pull_wrench(const NodalLoad& load, const Vector3& origin, const ArticulatedBodies& bodies) {
  const Vector3 arm = bodies.rotation(load.node) * load.arm;
  const Vector6& velocity = bodies.velocity(load.node);
  const Vector3 place = origin + bodies.position(load.node) + arm,
                moving = velocity.head<3>() + velocity.tail<3>().cross(arm),
                force = load.pull.stiffness * (load.pull.target - place) - load.pull.damping * moving;
  Vector6 wrench;
  wrench << force, arm.cross(force);
  return wrench;
}

/// Calls visit(load, wrench) for the loads of the scene and the wrenches of programs. `values`: of the model's
/// functions of time.
template <class Visit>
void for_each_load(const Model& model, const State& state, const std::vector<double>& values,
                   const ArticulatedBodies& bodies, const Visit& visit) {
  for (const NodalLoad& load : model.loads) visit(load, load_wrench(load, values[load.history], bodies));
  for (const NodalLoad& load : state.wrenches) {
    visit(load, load_wrench(load, 1, bodies));
    if (load.pull.acts()) visit(load, pull_wrench(load, world_origin(model, state), bodies));
  }
}

}  // namespace flexarm
