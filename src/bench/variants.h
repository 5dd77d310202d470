#pragma once
/// The rows of the properties report: schemes with their options.

#include <string>
#include <vector>

#include "schemes/scheme.h"

namespace flexarm::bench {

struct Variant {
  IntegratorDescription integrator;
  Scheme scheme;  ///< with the integrator's step, on which dissipation depends

  /// "m1, total", "newmark, total, additive"; with default options only the scheme's name.
  std::string name() const;
  /// True if strains do not change under a superposed rigid motion.
  bool claims_invariance() const { return scheme.interpolation == Interpolation::Local; }
  /// True if the twisting of a beam does not depend on its spin.
  bool claims_spin_independence() const { return scheme.beam_rotation == RotationRule::Unscaled; }
  /// True if a step backwards undoes a step forwards.
  bool claims_time_symmetry() const { return scheme.mid_functions == MidFunctions::Symmetric; }
  /// True if the configuration of the nodes determines that of the points.
  bool claims_path_independence() const { return claims_invariance() || scheme.interpolation == Interpolation::Total; }
};

const char* to_string(Interpolation interpolation);

/// All schemes with default options, then with each other interpolation that they support. Newmark's rule also with the
/// additive weak form.
std::vector<Variant> variants();
/// All schemes with default options only.
std::vector<Variant> default_variants();

}  // namespace flexarm::bench
