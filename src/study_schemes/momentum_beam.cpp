#include "study_schemes/momentum_beam.h"

#include <cassert>
#include <cmath>

#include "elements/orders.h"
#include "math/cayley.h"
#include "math/so3.h"

namespace flexarm {
namespace {

// ---------------------------------------------------------------- moments in world axes

/// The map A from material moments to world axes: T(omega) Lambda_n or, for StressRule::CayleyMoment, S(w) Lambda_n.
/// For constant material a, d(A a) = derivative(a) * spin of the section at the end.
class MomentMap {
 public:
  /// `begin`, `end`: rotations of the section at both ends of the step.
  MomentMap(StressRule rule, const Matrix3& begin, const Matrix3& end);
  const Matrix3& map() const { return map_; }
  Matrix3 derivative(const Vector3& material) const;

 private:
  bool is_scaled_;
  Vector3 increment_;
  Matrix3 begin_, map_;
};

MomentMap::MomentMap(StressRule rule, const Matrix3& begin, const Matrix3& end)
    : is_scaled_(rule == StressRule::CayleyMoment), begin_(begin) {
  const Quaternion relative = so3::quaternion_from_matrix(end * begin.transpose());
  increment_ = is_scaled_ ? cayley::increment(relative) : so3::log(relative);
  map_ = (is_scaled_ ? cayley::tangent(increment_) : so3::tangent(increment_)) * begin;
}

Matrix3 MomentMap::derivative(const Vector3& material) const {
  const Vector3 a = begin_ * material;
  return is_scaled_ ? Matrix3(cayley::xi_tangent(increment_, a) * cayley::inverse_tangent(increment_))
                    : Matrix3(so3::xi_tangent(increment_, a) * so3::inverse_tangent(increment_));
}

// ---------------------------------------------------------------- energy of the beta schemes (beam.md 3.3)

/// Returns {Delta r, w} of the nodes, with tangent-scaled w. The incremental maps of joints are exact for these.
template <int Nodes>
Eigen::Matrix<double, 6 * Nodes, 1> nodal_increments(const ElementNodes<Nodes>& nodes) {
  Eigen::Matrix<double, 6 * Nodes, 1> increment;
  for (int i = 0; i < Nodes; ++i) {
    increment.template segment<3>(6 * i) = nodes.end[i] - nodes.begin[i];
    increment.template segment<3>(6 * i + 3) = nodes.increment[i];
  }
  return increment;
}

/// Adds the change of strain energy of a stiffness point, and its gradient, which are the internal forces at the end.
template <int Nodes>
void add_strain_energy(const typename BeamElement<Nodes>::StiffnessPoint& constants, const PointKinematics& begin,
                       const PointKinematics& end, const GeneralisedShapeFunctions<Nodes>& generalised,
                       ElementEnergy<Nodes>& energy) {
  const Vector6 average = constants.stiffness * (0.5 * (begin.strain + end.strain));
  energy.change += constants.weight * average.dot(end.strain - begin.strain);
  const Vector6 stress = constants.stiffness * end.strain;
  add_point_residual<Nodes>(constants.weight, constants.derivative, GeneralisedTests<Nodes>{generalised},
                            end.rotation * stress.template head<3>(), end.rotation * stress.template tail<3>(),
                            end.tangent, energy.gradient);
}

/// Adds the change of translational kinetic energy and its gradient.
template <int Nodes>
void add_kinetic_energy(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, double factor, double step,
                        ElementEnergy<Nodes>& energy) {
  assert(step != 0 && factor != 0);
  std::array<Vector3, Nodes> velocity;
  for (int i = 0; i < Nodes; ++i)
    velocity[i] = (factor / step) * (nodes.end[i] - nodes.begin[i]) - (factor - 1) * nodes.velocity[i];
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j) {
      energy.change +=
          0.5 * element.mass(i, j) * (velocity[i] - nodes.velocity[i]).dot(velocity[j] + nodes.velocity[j]);
      energy.gradient.template segment<3>(6 * i) += (factor / step) * element.mass(i, j) * velocity[j];
    }
}

/// Returns the work of nodal forces {f_i, phi_i} along the nodal increments {Delta r, w} [J]; w is tangent-scaled.
template <int Nodes>
double work_of(const Eigen::Matrix<double, 6 * Nodes, 1>& forces, const ElementNodes<Nodes>& nodes) {
  return nodal_increments(nodes).dot(forces);
}

/// Adds beta * correction to the system, with the beta for which the work of the total along the nodal increments is
/// energy.change. Adds the tangent of this, too (beam.md 3.3; eq. F.37-F.39 of Muñoz 2004 leave out G).
template <int Nodes>
void correct_energy(const ElementNodes<Nodes>& nodes, const ElementEnergy<Nodes>& energy,
                    const ElementSystem<Nodes>& correction, bool with_tangent, ElementSystem<Nodes>& system) {
  const Eigen::Matrix<double, 6 * Nodes, 1> increment = nodal_increments(nodes);
  const double work = increment.dot(system.residual), denominator = increment.dot(correction.residual);
  // Without a change of strain, the correction is zero and cannot do work.
  if (std::abs(denominator) <= 1e-14 * (std::abs(energy.change) + std::abs(work)) || denominator == 0) return;
  const double beta = (energy.change - work) / denominator;
  system.residual += beta * correction.residual;
  if (!with_tangent) return;
  system.tangent += beta * correction.tangent;
  Eigen::Matrix<double, 6 * Nodes, 1> row = energy.gradient;  // g_E - G^T g_beta - K^T increment
  row.noalias() -= system.tangent.transpose().lazyProduct(increment);
  for (int i = 0; i < Nodes; ++i) {
    row.template segment<3>(6 * i) -= system.residual.template segment<3>(6 * i);
    row.template segment<3>(6 * i + 3) -=
        nodes.increment_inverse_tangent[i].transpose() * system.residual.template segment<3>(6 * i + 3);
  }
  system.tangent.noalias() += (correction.residual / denominator) * row.transpose();
}

// ---------------------------------------------------------------- points

/// A stiffness point over a step.
template <int Nodes>
struct Point {
  PointKinematics end;
  GeneralisedShapeFunctions<Nodes> generalised;
  Matrix3 average_rotation;  // (Lambda_n + Lambda_{n+1}) / 2
  Vector3 arm;               // r'_*: (r'_n + r'_{n+1}) / 2, or r'_n
  double arm_weight;         // weight of the end of the step in `arm`
};

/// Material stress resultants at a point, the map of the moment to world axes, and their derivatives.
struct StressState {
  Vector6 stress, seen;                           // `seen`: for the geometric part of the tangent
  Eigen::Matrix<double, 6, 9> stress_derivative;  // columns {dr', spin, spin'}
  Matrix3 moment_map;                             // A
  Matrix3 moment_derivative = Matrix3::Zero();    // d(A a) / d(spin) at constant material moment a
};

/// Adds a point's forces and their tangent.
template <int Nodes, class Tests>
void add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const Tests& tests, const Point<Nodes>& p,
               const StressState& state, bool with_tangent, ElementSystem<Nodes>& system) {
  const Matrix3& average = p.average_rotation;
  const Vector3 n = average * state.stress.template head<3>(), m = state.moment_map * state.stress.template tail<3>();
  add_point_residual<Nodes>(constants.weight, constants.derivative, tests, n, m, p.arm, system.residual);
  if (!with_tangent) return;
  Eigen::Matrix<double, 6, 9> resultants;
  resultants.template topRows<3>().noalias() = average.lazyProduct(state.stress_derivative.template topRows<3>());
  resultants.template bottomRows<3>().noalias() =
      state.moment_map.lazyProduct(state.stress_derivative.template bottomRows<3>());
  resultants.template block<3, 3>(0, 3) -= 0.5 * so3::hat(Vector3(p.end.rotation * state.seen.template head<3>()));
  resultants.template block<3, 3>(3, 3) += state.moment_derivative;
  Eigen::Matrix<double, 3, 9> couple = so3::hat(p.arm) * resultants.template topRows<3>();
  const Vector3 seen_n = average * state.seen.template head<3>(),
                seen_m = state.moment_map * state.seen.template tail<3>();
  couple.template leftCols<3>() -= p.arm_weight * so3::hat(seen_n);
  add_point_residual<Nodes>(constants.weight, constants.derivative, tests, seen_n - n, seen_m - m, p.arm,
                            system.carried);
  add_point_tangent<Nodes>(constants.weight, tests, {constants.derivative, p.generalised}, resultants, couple,
                           system.tangent);
}

/// Computes the stiffness points of an element over a step. `end`: output, the points at the end.
template <int Nodes>
void evaluate_points(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const PointKinematics* begin,
                     double arm_weight, bool with_variation,
                     std::array<Point<Nodes>, BeamElement<Nodes>::kStiffnessPoints>& points, PointKinematics* end) {
  const ElementRotations<Nodes> rotations(nodes, with_variation);
  const auto rotation_at = stiffness_rotations(element, nodes, rotations);
  for (int k = 0; k < BeamElement<Nodes>::kStiffnessPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    Point<Nodes>& p = points[k];
    p.end = end_kinematics<Nodes>(constants, nodes, rotation_at(k, p.generalised));
    p.average_rotation = 0.5 * (begin[k].rotation + p.end.rotation);
    p.arm_weight = arm_weight;
    p.arm = (1 - arm_weight) * begin[k].tangent + arm_weight * p.end.tangent;
    end[k] = p.end;
  }
}

/// Adds translational inertia, (1/h) int I^i I^j mass ds (v_{n+1} - v_n), with
/// v_{n+1} = factor Delta r / h - (factor - 1) v_n.
template <int Nodes>
void add_translational_inertia(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, double factor,
                               double step, bool with_tangent, ElementSystem<Nodes>& system) {
  std::array<Vector3, Nodes> force;
  for (int i = 0; i < Nodes; ++i)
    force[i] = (factor / step) * ((nodes.end[i] - nodes.begin[i]) / step - nodes.velocity[i]);
  add_translational<Nodes>(element.mass, force, factor / (step * step), with_tangent, system);
}

/// Adds mass-proportional damping by the mean velocity Delta r / h.
template <int Nodes>
void add_mass_damping(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, double step,
                      bool with_tangent, ElementSystem<Nodes>& system) {
  if (element.mass_damping == 0) return;
  std::array<Vector3, Nodes> mean, force;
  for (int i = 0; i < Nodes; ++i) {
    mean[i] = (nodes.end[i] - nodes.begin[i]) / step;
    force[i] = element.mass_damping * mean[i];
  }
  add_translational<Nodes>(element.mass, force, element.mass_damping / step, with_tangent, system);
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j)
      system.dissipated += element.mass_damping * step * element.mass(i, j) * mean[i].dot(mean[j]);
}

/// The stress C (begin Sigma_n + end Sigma_{n+1}), or only its forces N.
struct StressWeights {
  double begin, end;
  bool forces_only = false;
};

/// Adds the internal forces of a stress.
template <int Nodes>
void add_stress(const BeamElement<Nodes>& element, StressRule rule, const StressWeights& weights,
                const std::array<Point<Nodes>, BeamElement<Nodes>::kStiffnessPoints>& points,
                const PointKinematics* begin, const Vector6* carried, bool with_tangent, ElementSystem<Nodes>& system) {
  for (int k = 0; k < BeamElement<Nodes>::kStiffnessPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    const Point<Nodes>& p = points[k];
    StressState state;
    state.stress = constants.stiffness * (weights.begin * begin[k].strain + weights.end * p.end.strain);
    if (weights.forces_only) state.stress.template tail<3>().setZero();
    const MomentMap map(rule, begin[k].rotation, p.end.rotation);
    state.moment_map = map.map();
    state.seen = state.stress;
    if (with_tangent) {
      if (carried) {
        state.seen = constants.stiffness * (weights.begin * begin[k].strain + weights.end * carried[k]);
        if (weights.forces_only) state.seen.template tail<3>().setZero();
      }
      state.stress_derivative.noalias() = weights.end * constants.stiffness.lazyProduct(strain_derivative(p.end));
      if (weights.forces_only) state.stress_derivative.template bottomRows<3>().setZero();
      state.moment_derivative = map.derivative(state.seen.template tail<3>());
    }
    add_point<Nodes>(constants, LagrangeTests<Nodes>{constants.shape, constants.derivative}, p, state, with_tangent,
                     system);
  }
}

}  // namespace

template <int Nodes>
void momentum_beam(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const TimeRule& rule,
                   const PointKinematics* begin, double step, const RotaryTerm<Nodes>& rotary, bool with_tangent,
                   PointKinematics* end, ElementSystem<Nodes>& system, const Vector6* carried) {
  assert(step != 0 && begin && end && rotary);
  const bool is_corrected = rule.correction != EnergyCorrection::None;
  system.set_zero();
  std::array<Point<Nodes>, BeamElement<Nodes>::kStiffnessPoints> points;
  evaluate_points<Nodes>(element, nodes, begin, rule.arm_weight(), with_tangent || is_corrected, points, end);
  add_stress<Nodes>(element, rule.stress, {0.5, 0.5}, points, begin, carried, with_tangent, system);
  add_translational_inertia<Nodes>(element, nodes, rule.velocity_factor(), step, with_tangent, system);
  ElementEnergy<Nodes> energy;
  rotary(with_tangent, is_corrected ? &energy : nullptr, system);
  if (is_corrected) {
    for (int k = 0; k < BeamElement<Nodes>::kStiffnessPoints; ++k)
      add_strain_energy<Nodes>(element.stiffness_points[k], begin[k], points[k].end, points[k].generalised, energy);
    add_kinetic_energy<Nodes>(element, nodes, rule.velocity_factor(), step, energy);
    ElementSystem<Nodes> correction;
    correction.set_zero();
    add_stress<Nodes>(element, rule.stress, {-1, 1, rule.correction == EnergyCorrection::AxialBeta}, points, begin,
                      nullptr, with_tangent, correction);
    correct_energy<Nodes>(nodes, energy, correction, with_tangent, system);
  }
  if (element.stiffness_damping > 0) {
    const double viscosity = element.stiffness_damping / step;
    ElementSystem<Nodes> viscous;
    viscous.set_zero();
    add_stress<Nodes>(with_damped_stiffness(element), rule.stress, {-viscosity, viscosity}, points, begin, carried,
                      with_tangent, viscous);
    system.residual += viscous.residual;
    system.carried += viscous.carried;
    system.tangent += viscous.tangent;
    // The actual work on the nodes. It equals eta C (change of strain)^2 / h only up to the order of the scheme.
    system.dissipated += work_of(viscous.residual, nodes);
  }
  add_mass_damping<Nodes>(element, nodes, step, with_tangent, system);
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes) template decltype(momentum_beam<Nodes>) momentum_beam<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
