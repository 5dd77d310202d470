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
  std::string reason;  ///< why there is no plane; empty if there is one
};

/// Finds a plane about which the model is symmetric: geometry, sections, inertia, joints, loads and gravity are their
/// own mirror images, up to round-off. A motion that starts in such a plane stays in it.
PlaneSearch find_plane(const Model& model);

/// Whether all poses, velocities and memories that a step of the energy-momentum family starts from lie in the plane,
/// up to round-off.
bool lies_in_plane(const Model& model, const PlaneOfMotion& plane, const State& state);
/// Whether the wrenches and commands of a state act in the plane. Of the coordinates only those of free joints are
/// checked, since the efforts of others cannot act out of the plane.
bool acts_in_plane(const Model& model, const PlaneOfMotion& plane, const State& state);

}  // namespace flexarm
