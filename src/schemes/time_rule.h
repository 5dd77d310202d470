#pragma once
/// The rules of a time integration scheme that elements need.

#include "flexarm/schemes/integrator_description.h"

namespace flexarm {

struct ExplicitTableau;  // schemes/explicit_tableau.h

/// At which instant of a step the stress acts, and how material moments are transformed to spatial ones.
enum class StressRule {
  EndPoint,           ///< at t_{n+1} (statics, Newmark family)
  Conjugate,          ///< average of both ends; moments by the average rotation (EM family)
  ExponentialMoment,  ///< average of both ends; moments by T(omega) Lambda_n (M1, M2, beta_1)
  CayleyMoment        ///< average of both ends; moments by S(w) Lambda_n (STD, beta_2)
};

/// How the energy balance of an element over a step is made exact.
enum class EnergyCorrection {
  None,
  Multiplier,  ///< lambda C s (EM)
  AxialBeta,   ///< beta g_v(Delta N, 0), as Muñoz 2004, eq. 6.22-6.27 (beta_1, beta_2)
  FullBeta     ///< beta g_v(Delta N, Delta M), repaired (docs/notes/beam.md 3.3)
};

/// How the material angular velocity W follows from the rotation over a step.
enum class RotationRule {
  TangentScaled,  ///< (W_0 + W_1)/2 = Omega/h with the tangent-scaled increment, which joints map exactly
  Unscaled        ///< with the rotation vector
};

/// The generalised shape functions that test the moment rows of the EM family.
enum class MidFunctions {
  Explicit,  ///< those of the middle of the step, predicted from the last step: constant during the iteration
  Symmetric  ///< the average of both ends, which makes the step symmetric in time: not constant
};

/// Numerical dissipation that acts on the stress alone, at each stiffness point:
///   F += C [stiffness (s - y) + inertance (w_1 - w_0)/h]
/// with the strain increment s, its running average y_1 = y_0 + forgetting (s - y_0), and the strain rate
/// (w_0 + w_1)/2 = s/h. Momenta are conserved exactly, and the sum of kinetic energy T, potential V and
/// (stiffness/forgetting y.Cy + inertance w.Cw)/2 never grows.
struct NumericalDissipation {
  double stiffness = 0, forgetting = 0;  ///< [-]
  double inertance = 0;                  ///< [s^2]
  bool any() const { return stiffness > 0; }
};

/// Members of the Hilber-Hughes-Taylor family (Muñoz 2004, sec. 4.2).
enum class HhtForm {
  None,
  AdditiveForces,  ///< HHT1: interpolates forces conjugate to total rotation vectors in time
  SpinForces,      ///< HHT2: interpolates forces conjugate to spins
  Kinematics       ///< HHT3: interpolates the configuration
};

/// All rules of a scheme for beams, bodies and joints.
struct TimeRule {
  bool is_static = false;  ///< equilibrium: no inertia and no rates
  /// An explicit method, which has nothing of the other rules; null: an implicit scheme.
  const ExplicitTableau* tableau = nullptr;
  /// Statics: test moment rows by the variation of strains, as steps of the EM family do at rest; else by Lagrange
  /// functions.
  bool tests_vary_strains = false;
  StressRule stress = StressRule::Conjugate;
  EnergyCorrection correction = EnergyCorrection::None;
  RotationRule beam_rotation = RotationRule::TangentScaled;  ///< at the mass points (or nodes) of beams
  RotationRule body_rotation = RotationRule::TangentScaled;
  bool nodal_rotary_inertia = true;  ///< lump the rotary inertia of beams at nodes; else integrate it at mass points
  bool backward_velocity = false;    ///< v_1 = Delta r / h (M2); else (v_0 + v_1)/2 = Delta r / h
  MidFunctions mid_functions = MidFunctions::Explicit;
  NumericalDissipation dissipation;
  double damping_relaxation = 0;  ///< h_0 of StructuralDamper [s]; 0: a dashpot at the middle of the step (EM family)
  HhtForm hht = HhtForm::None;
  double beta = 0.25, gamma = 0.5, alpha = 0;  ///< Newmark family
  Interpolation interpolation = Interpolation::Local;
  bool cayley_interpolation = false;  ///< interpolate increments tangent-scaled (STD); with Interpolation::Incremental
  WeakForm weak_form = WeakForm::Spin;

  /// Sets alpha, beta and gamma of the HHT method: second order, with the largest dissipation of high frequencies.
  void set_alpha(double value) {
    alpha = value;
    gamma = 0.5 - alpha;
    beta = 0.25 * (1 - alpha) * (1 - alpha);
  }
  /// Whether beams and nodes belong to the room study_schemes/, the library of which is loaded for them.
  bool is_for_study() const {
    if (!is_static) return stress != StressRule::Conjugate;
    return interpolation != Interpolation::Local || weak_form != WeakForm::Spin || hht == HhtForm::AdditiveForces;
  }
  /// Whether joints use the incremental maps N_Delta; otherwise they use N_delta at t_{n+1}.
  bool is_incremental() const { return stress != StressRule::EndPoint; }
  /// The factor in v_1 = velocity_factor() Delta r / h - (velocity_factor() - 1) v_0, for conserving schemes.
  double velocity_factor() const { return backward_velocity ? 1 : 2; }
  /// Weight of the end of the step in moment arms. Conserving schemes: the weight that makes angular momentum exact;
  /// Newmark family: 1.
  double arm_weight() const { return !is_incremental() ? 1 : backward_velocity ? 0 : 0.5; }
  /// gamma in the rate at the end of a step: (increment / h - (1 - gamma) rate at the beginning) / gamma.
  double rate_gamma() const { return is_incremental() ? 1 / velocity_factor() : gamma; }
};

}  // namespace flexarm
