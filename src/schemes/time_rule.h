#pragma once
/// The parts of a time integration scheme that elements need.

#include "flexarm/schemes/integrator_description.h"

namespace flexarm {

/// Where in a step the stress acts, and how the material moment is turned into space.
enum class StressRule {
  EndPoint,           ///< at t_{n+1} (statics, Newmark family)
  Conjugate,          ///< average of both ends; moments by the average rotation (EM family)
  ExponentialMoment,  ///< average of both ends; moments by T(omega) Lambda_n (M1, M2, beta_1)
  CayleyMoment        ///< average of both ends; moments by S(w) Lambda_n (STD, beta_2)
};

/// What closes the energy balance of an element within a step.
enum class EnergyCorrection {
  None,
  Multiplier,  ///< lambda C s (EM)
  AxialBeta,   ///< beta g_v(Delta N, 0), as Muñoz 2004, eq. 6.22-6.27 (beta_1, beta_2)
  FullBeta     ///< beta g_v(Delta N, Delta M), repaired (beam.md 3.3)
};

/// How a material angular velocity follows the rotation over a step.
enum class RotationRule {
  TangentScaled,  ///< (W_0 + W_1)/2 = Omega/h with the tangent-scaled increment: the one that joints map exactly
  Unscaled        ///< with the rotation vector
};

/// Which generalised shape functions test the moment rows of the EM family; they stay the same during the iteration ...
enum class MidFunctions {
  Explicit,  ///< ... those of the middle if the step goes on like the last one
  Symmetric  ///< or not: the average of both ends, which makes the step symmetric in time
};

/// Numerical dissipation by the stress alone, per stiffness point: F += C [stiffness (s - y) + inertance (w_1 - w_0)/h]
/// with the strain increment s, its running average y_1 = y_0 + forgetting (s - y_0), and the strain rate
/// (w_0 + w_1)/2 = s/h. Momenta stay exact, and T + V + (stiffness/forgetting y.Cy + inertance w.Cw)/2 never grows.
struct NumericalDissipation {
  double stiffness = 0, forgetting = 0;  ///< [-]
  double inertance = 0;                  ///< [s^2]
  bool any() const { return stiffness > 0; }
};

/// Members of the Hilber-Hughes-Taylor family (Muñoz 2004, sec. 4.2).
enum class HhtForm {
  None,
  AdditiveForces,  ///< HHT1: forces conjugate to total rotation vectors are interpolated in time
  SpinForces,      ///< HHT2: forces conjugate to spins
  Kinematics       ///< HHT3: the configuration
};

struct TimeRule {
  bool is_static = false;           ///< equilibrium of forces instead of a step: nothing has inertia or a rate
  bool tests_vary_strains = false;  ///< statics: moment rows are tested as in steps of the EM family at rest, by what
                                    ///< strains vary with; else by Lagrange functions
  StressRule stress = StressRule::Conjugate;
  EnergyCorrection correction = EnergyCorrection::None;
  RotationRule beam_rotation = RotationRule::TangentScaled;  ///< at the mass points (or nodes) of beams
  RotationRule body_rotation = RotationRule::TangentScaled;
  bool nodal_rotary_inertia = true;  ///< beams' rotary inertia lumped at the nodes; else integrated at the mass points
  bool backward_velocity = false;    ///< v_1 = Delta r / h (M2); else (v_0 + v_1)/2
  MidFunctions mid_functions = MidFunctions::Explicit;
  NumericalDissipation dissipation;
  double damping_relaxation = 0;  ///< h_0 of StructuralDamper [s]; 0: a dashpot at the middle of the step (EM family)
  HhtForm hht = HhtForm::None;
  double beta = 0.25, gamma = 0.5, alpha = 0;  ///< Newmark family
  Interpolation interpolation = Interpolation::Local;
  bool cayley_interpolation = false;  ///< increments interpolated tangent-scaled (STD), with Interpolation::Incremental
  WeakForm weak_form = WeakForm::Spin;

  /// Hilber, Hughes and Taylor's beta and gamma, of second order with the largest dissipation of high frequencies.
  void set_alpha(double value) {
    alpha = value;
    gamma = 0.5 - alpha;
    beta = 0.25 * (1 - alpha) * (1 - alpha);
  }
  /// True for the schemes whose joints use the incremental maps N_Delta; false: N_delta at t_{n+1}.
  bool is_incremental() const { return stress != StressRule::EndPoint; }
  /// v_1 = velocity_factor() Delta r / h - (velocity_factor() - 1) v_0 (conserving schemes).
  double velocity_factor() const { return backward_velocity ? 1 : 2; }
  /// Of the end of the step in moment arms: those that make angular momentum exact, or in the Newmark family those at
  /// the end.
  double arm_weight() const { return !is_incremental() ? 1 : backward_velocity ? 0 : 0.5; }
  /// Of the rate at the end of a step, (increment / h - (1 - rate_gamma()) rate at the beginning) / rate_gamma().
  double rate_gamma() const { return is_incremental() ? 1 / velocity_factor() : gamma; }
};

}  // namespace flexarm
