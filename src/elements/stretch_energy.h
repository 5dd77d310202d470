#pragma once
/// Elastic energy of a material whose unstretched amount may change: a line that is paid out, oil that is pumped in.

namespace flexarm {

/// A stretch, and the amount of the same material without stress, to which the stretch is relative: both lengths [m],
/// or both volumes [m^3].
struct Stretch {
  double stretch = 0, rest = 0;
};

/// Derivatives of the energy by the stretch and by the amount, and their derivatives by both numbers at the end.
struct StretchForces {
  double force = 0, force_by_stretch = 0, force_by_rest = 0;        ///< energy per change of the stretch, >= 0
  double release = 0, release_by_stretch = 0, release_by_rest = 0;  ///< energy per change of the amount, <= 0
};

/// The energy k x^2 / (2 L) of a stretch x > 0 of the amount L, else zero. `stiffness` k: EA [N], or a bulk modulus
/// [Pa].
struct StretchEnergy {
  double stiffness = 0;

  double energy(const Stretch& at) const;  ///< [J]
  /// Means over a step: force * change of stretch + release * change of amount is exactly the change of the energy.
  /// (docs/notes/lines.md 2)
  StretchForces means(const Stretch& begin, const Stretch& end) const;
  StretchForces at(const Stretch& end) const;
};

}  // namespace flexarm
