#pragma once
/// The tension of an elastic line that pulls and never pushes.

namespace flexarm {

/// The two measures of a line: its length between its ends, and the length of the same material without tension [m].
struct TendonLengths {
  double length = 0, rest = 0;
};

/// What a line does over a step, with the derivatives by the lengths at its end.
struct TendonStep {
  double tension = 0;                 ///< per change of the length, >= 0 [N]
  double by_length = 0, by_rest = 0;  ///< [N/m]
  double release = 0;                 ///< energy per change of the rest length, <= 0 [N]
  double release_by_length = 0, release_by_rest = 0;
  double dissipated = 0;  ///< [J]
};

/// An elastic line with a damper in parallel. Its energy is EA (L - L0)^2 / (2 L0) if it is longer than its rest length
/// L0, else zero. The damper resists the rate of L - L0 as far as the line is taut.
struct TendonLaw {
  double stiffness = 0;  ///< EA [N]
  double damping = 0;    ///< [N s/m]

  double energy(const TendonLengths& line) const;   ///< [J]
  double tension(const TendonLengths& line) const;  ///< elastic part [N]
  bool is_taut(const TendonLengths& line) const { return line.length > line.rest; }

  /// Means over a step of `duration` (0: an equilibrium). tension * change of length + release * change of rest length
  /// is exactly the change of the energy plus what is dissipated. (docs/notes/lines.md 2)
  TendonStep means(const TendonLengths& begin, const TendonLengths& end, double duration) const;
  /// Values at the end of a step. `rate`: of L - L0 at the end, `rate_slope`: its derivative by the change of L - L0.
  /// `change`: of L - L0 over the step.
  TendonStep at_end(const TendonLengths& end, double rate, double rate_slope, double change) const;
};

}  // namespace flexarm
