#pragma once
/// Decides whether a model's steps with a scheme can be taken in a plane.

#include "model/plane_finder.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Returns the plane, or the reason why steps are three-dimensional.
PlaneSearch find_step_plane(const Model& model, const Scheme& scheme);

}  // namespace flexarm
