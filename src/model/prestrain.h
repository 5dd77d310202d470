#pragma once
/// Strains at which a beam is free of stress, caused by heat, tendons or shape memory.

#include <array>

#include "flexarm/math/pose.h"

namespace flexarm {

struct Model;

/// The prestrain of a beam, equal in all its sections. It adds to the strains of the undeformed line.
struct Prestrain {
  /// Indices into Model::histories: axial, shear y, z [-], torsion, bending y, z [1/m] of the reference line; -1: none.
  std::array<int, 6> histories = {-1, -1, -1, -1, -1, -1};
  Vector3 centroid = Vector3::Zero();  ///< mass centroid in the section [m]
};

/// Returns {Gamma, K} about the mass centroid [-, 1/m] at a time [s]. `index`: into Model::prestrains; negative: zero.
Vector6 prestrain_at(const Model& model, int index, double time);
/// Returns the mean of prestrain_at() between two times [s].
Vector6 mean_prestrain(const Model& model, int index, double begin, double end);

}  // namespace flexarm
