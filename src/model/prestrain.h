#pragma once
/// Strains at which a beam is free of stress, caused by heat, tendons or shape memory.

#include <array>

#include "flexarm/math/pose.h"

namespace flexarm {

struct Model;

/// Of all sections of a beam, beside the strains of its undeformed line.
struct Prestrain {
  /// Indices into Model::histories: axial, shear y, z [-], torsion, bending y, z [1/m] of the reference line; -1: none.
  std::array<int, 6> histories = {-1, -1, -1, -1, -1, -1};
  Vector3 centroid = Vector3::Zero();  ///< mass centroid in the section [m]
};

/// {Gamma, K} about the mass centroid [-, 1/m] of Model::prestrains at a time [s]; zero where `index` is negative.
Vector6 prestrain_at(const Model& model, int index, double time);
/// Its mean over a time.
Vector6 mean_prestrain(const Model& model, int index, double begin, double end);

}  // namespace flexarm
