#pragma once
/// Whether a model's steps by a scheme are taken in a plane.

#include "model/plane_finder.h"
#include "schemes/scheme.h"

namespace flexarm {

/// The plane, or why steps are three-dimensional.
PlaneSearch find_step_plane(const Model& model, const Scheme& scheme);

}  // namespace flexarm
