#include "integrators/step_plane.h"

#include <fmt/format.h>

#include "solver/planar_tangent.h"

namespace flexarm {

PlaneSearch find_step_plane(const Model& model, const Scheme& scheme) {
  if (!scheme.may_be_planar) return {std::nullopt, "three dimensions are requested"};
  if (scheme.is_static || scheme.stress != StressRule::Conjugate)
    return {std::nullopt, fmt::format("scheme '{}' computes in three dimensions only", scheme.name)};
  PlaneSearch search = find_plane(model);
  if (search.plane && !PlanarTangent::suits(model, DegreesOfFreedom(model)))
    return {std::nullopt, "beams whose far ends are held by joints are computed in three dimensions only"};
  return search;
}

}  // namespace flexarm
