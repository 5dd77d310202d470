#pragma once
/// How what sensors measure of a beam's section changes as its nodes move.

#include <vector>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Derivatives of a scalar by {displacement, spin} of a few nodes, world axes.
struct NodalGradient {
  std::vector<int> nodes;
  Eigen::RowVectorXd row;
  /// `velocities`: {v, w} of all nodes, world axes.
  double along(const std::vector<Vector6>& velocities) const;
};

/// Of fibre_strain(), with local interpolation.
NodalGradient fibre_strain_gradient(const Model& model, const State& state, const ProbePoint& point);
/// Of a component of the resultant of section_point() there, with local interpolation.
NodalGradient section_force_gradient(const Model& model, const State& state, const ProbePoint& point, int component);

}  // namespace flexarm
