#pragma once
/// What a simulation gives back: values, in SI units.

#include <complex>
#include <string>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

/// Outcome of a step; a value, never an exception.
struct StepResult {
  enum class Reason {
    None,
    NoConvergence,
    SingularTangent,
    NotFinite,
    RotationTooLarge,
    EnergyDefect,
    OffTheLine,
    DrivenOffTheLine,
    OpenLoop,
    NeverRests,
    HitTooFast
  };
  bool converged = false;
  int iterations = 0;  ///< Newton iterations of all sub-steps
  int halvings = 0;    ///< times that a sub-step had to be halved
  int factorisations = 0;
  Reason reason = Reason::None;  ///< why it failed
};
/// Outcome of the search for an equilibrium.
struct StaticResult : StepResult {
  /// The link that moves most when the equilibrium to which the loads lead is left; empty: it is stable.
  std::string falling_link;
  /// A link that may stand elsewhere as well, as on an upright hinge; empty: there is none.
  std::string loose_link;
};
/// Which equilibrium is asked for.
enum class Equilibrium {
  Stable,  ///< that to which the loads lead or, where this is not stable, one to which the mechanism falls from it
  UnderTheLoads  ///< that to which the loads lead, stable or not
};
/// In words, for people to read.
const char* to_string(StepResult::Reason reason);

/// Energies of a state [J]; work and dissipation are path integrals since the start. The potential is that of gravity:
/// zero at the world's origin or, where a mechanism is far from it, at the first joint on its root link.
struct Energies {
  double kinetic = 0, strain = 0, potential = 0, work = 0, dissipated = 0;
  double total() const { return kinetic + strain + potential; }
};

/// One point of a deformed centreline: the reference line of the section, wherever its mass centroid lies.
struct BeamPoint {
  double arc_length = 0;                ///< of the undeformed line [m]
  Pose pose;                            ///< of the section, in the world; between nodes by the local interpolation
  Vector6 strain = Vector6::Zero();     ///< {Gamma, K} in the section frame [-, 1/m], by the scheme's interpolation
  Vector6 resultant = Vector6::Zero();  ///< {N, M} in the section frame [N, N m], elastic: without damping
};

/// Pose and velocity of a named point.
struct ProbeState {
  Pose pose;
  // Of second order in the step, see Simulation::velocity.
  Vector3 velocity = Vector3::Zero();          ///< world axes [m/s]
  Vector3 angular_velocity = Vector3::Zero();  ///< the same [rad/s]
};

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

}  // namespace flexarm
