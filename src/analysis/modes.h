#pragma once
/// Modes of small motion about an equilibrium.

#include <complex>
#include <vector>

#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

using ComplexVector6 = Eigen::Matrix<std::complex<double>, 6, 1>;

/// A motion Re(shape exp((rate + 2 pi i frequency) t)) of small amplitude. Its shape is complex where nodes do not move
/// in phase: the real part now, less the imaginary one a quarter of a period later, but for growth or decay.
struct Mode {
  double frequency = 0;                     ///< of the oscillation [Hz]; 0: none
  double rate = 0;                          ///< [1/s]; > 0: grows, < 0: decays, 0: neither, up to round-off
  std::vector<ComplexVector6> node_motion;  ///< {displacement, spin} of every node, world axes; largest component 1
  std::vector<std::complex<double>> coordinate_motion;  ///< of every coordinate [m, rad], in the same units

  /// Nothing holds the motion, and it goes on at constant speed or stands still.
  bool is_free() const { return frequency == 0 && rate == 0; }
  /// Growing: by oscillation.
  bool is_flutter() const { return rate > 0 && frequency > 0; }
  /// Growing without oscillation.
  bool is_divergence() const { return rate > 0 && frequency == 0; }
  /// Of critical damping: 1 where it decays without oscillation, < 0 where it grows; 0 for a free motion.
  double damping_ratio() const;
};

/// Modes of (lambda^2 M + lambda D + K) phi = 0 about the configuration of `state`, at rest, under the loads at time 0:
/// the growing ones first, then by |lambda|; the `count` first. K is the tangent of the static residual, M the
/// consistent mass, D the damping of beams, joints and touched stops (not friction), in the unknowns of the mechanism.
/// K is unsymmetric under follower loads, and is taken as it is.
///
/// Without damping a motion gives one mode, and of the two that belong to a divergence the growing one; with damping, a
/// motion that does not oscillate gives two.
/// `contact_time`: of touched stops [s].
/// @throws std::runtime_error if the problem cannot be solved.
std::vector<Mode> natural_modes(const Model& model, const State& state, int count,
                                double contact_time = Scheme().contact_time);

}  // namespace flexarm
