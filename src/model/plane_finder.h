#pragma once
/// Finds the plane in which a mechanism moves. (docs/notes/planar.md)

#include <optional>
#include <string>

#include "model/model.h"
#include "model/plane.h"
#include "model/state.h"

namespace flexarm {

struct PlaneSearch {
  std::optional<PlaneOfMotion> plane;
  std::string reason;  ///< what lies out of it, or cannot be told; empty if there is a plane
};

/// The plane of which the model is its own mirror image: geometry, sections, inertia, joints, loads and gravity. What
/// starts in it stays there. Everything is to fit to round-off.
PlaneSearch find_plane(const Model& model);

/// Whether all that a step of the energy-momentum family goes on from has nothing out of the plane but round-off.
bool lies_in_plane(const Model& model, const PlaneOfMotion& plane, const State& state);
/// The same of wrenches and commands in a state. Free joints' coordinates are the only ones whose efforts may point out
/// of it.
bool acts_in_plane(const Model& model, const PlaneOfMotion& plane, const State& state);

}  // namespace flexarm
