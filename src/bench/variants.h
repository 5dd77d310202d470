#pragma once
/// The rows of the report: schemes with their options.

#include <string>
#include <vector>

#include "schemes/scheme.h"

namespace flexarm::bench {

struct Variant {
  IntegratorDescription integrator;
  Scheme scheme;  ///< for the integrator's step; dissipation depends on it

  /// "m1, total", "newmark, total, additive"; the scheme's name alone with its default options.
  std::string name() const;
  /// True if strains do not change under a superposed rigid motion.
  bool claims_invariance() const { return scheme.interpolation == Interpolation::Local; }
  /// True if the twisting of a beam does not depend on how fast it spins.
  bool claims_spin_independence() const { return scheme.beam_rotation == RotationRule::Unscaled; }
  /// True if a step backwards undoes one forwards.
  bool claims_time_symmetry() const { return scheme.mid_functions == MidFunctions::Symmetric; }
  /// True if a configuration of the nodes has one configuration of the points.
  bool claims_path_independence() const { return claims_invariance() || scheme.interpolation == Interpolation::Total; }
};

const char* to_string(Interpolation interpolation);

/// Every scheme with its default options, then with each other interpolation that it takes; Newmark's rule with the
/// additive weak form, too.
std::vector<Variant> variants();
/// The schemes with their default options only.
std::vector<Variant> default_variants();

}  // namespace flexarm::bench
