#pragma once
/// What drove prescribed motions over the last steps, for output.

#include <array>
#include <cstddef>
#include <vector>

namespace flexarm {

/// Efforts of motions, averaged over whole steps. A prescribed coordinate's own velocity flips its sign from step to
/// step around the motion's, and with it the effort; what is put out is free of that and belongs to the end of a step
/// (theory.md, "Published velocities and efforts").
struct DriveEfforts {
  static constexpr int kLength = 3;
  std::vector<double> impulse;                     ///< per coordinate: of the step under way [N s or N m s]
  std::array<std::vector<double>, kLength> means;  ///< per coordinate, newest first [N or N m]
  int count = 0;                                   ///< of means that hold

  void resize(std::size_t coordinates);
  /// A whole step begins.
  void begin();
  /// It has ended, after `duration` [s].
  void end(double duration);
  /// Nothing before counts: these are the efforts [N or N m].
  void restart(const std::vector<double>& efforts);
  /// Effort at the end of the last step, of second order from the third step on [N or N m].
  double at_end(std::size_t coordinate) const;
};

}  // namespace flexarm
