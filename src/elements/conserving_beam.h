#pragma once
/// Beams over a step for the energy-momentum (EM) family (beam.md 3.2, beyond.md 1):
///   g_v^i = int {I^i' n,  I_t^i' m - I_t^i r'_arm x n} ds,  n = Lambda_bar N_a,  m = Lambda_bar M_a.
/// Momenta are conserved for any stress N_a, M_a and any test functions with sum I_t = 1, if the arm r'_arm suits the
/// rule of the velocities. The conjugate strain s of a step approximates the change of strain; the stresses do the work
/// of the nodal forces on it.
///
/// The functions are templates on the number type S. Simulations use packs of four elements side by side (S = Pack,
/// conserving_pack.h). The stages of a step are compiled in separate units: set_points() (here), set_strains() and
/// set_forces() (conserving_terms.h), add_tangent() (conserving_tangent.h).

#include "elements/beam_point.h"
#include "elements/conserving_terms.h"
#include "math/cayley.h"
#include "math/so3.h"
#include "schemes/time_rule.h"

namespace flexarm::conserving {

/// Returns m hat(v).
template <typename S>
Matrix3T<S> times_hat(const Matrix3T<S>& m, const Vector3T<S>& v) {
  Matrix3T<S> product;
  product.col(0) = m.col(1) * v[2] - m.col(2) * v[1];
  product.col(1) = m.col(2) * v[0] - m.col(0) * v[2];
  product.col(2) = m.col(0) * v[1] - m.col(1) * v[0];
  return product;
}

/// Returns hat(v) m.
template <typename S>
Matrix3T<S> hat_times(const Vector3T<S>& v, const Matrix3T<S>& m) {
  Matrix3T<S> product;
  for (int j = 0; j < 3; ++j) product.col(j) = so3::cross(v, m.col(j));
  return product;
}

/// A stiffness point over a step.
template <int Nodes, typename S>
struct Point {
  GeneralisedShapeFunctions<Nodes, S> generalised;  // at the end
  Matrix3T<S> end_rotation, average_rotation;       // Lambda_{n+1}, (Lambda_n + Lambda_{n+1}) / 2
  Vector3T<S> end_tangent, arm;                     // r'_{n+1}, (r'_n + r'_{n+1}) / 2
  Vector3T<S> increment, increment_derivative;      // interpolated w and w'
  Vector3T<S> stretch;                              // x = Delta r' + arm x w
  PointStress<S> own, seen;                         // of the trial configuration; for the geometric part of the tangent
  Vector6T<S> half_defect_stress;                   // C (Delta Sigma - s) / 2
  // Set by set_forces() for add_tangent():
  Vector6T<S> seen_resultants;  // for the geometric part; weighted, including dampers
  S factor, damped_factor;      // the stress contains factor C s + damped_factor D C D s
};

/// All stiffness points of an element over a step, at the trial configuration.
template <int Nodes, typename S>
struct StepPoints {
  std::array<Point<Nodes, S>, Nodes - 1> points;
  ElementFunctions<Nodes, S> averages;    // for MidFunctions::Symmetric
  const ElementFunctions<Nodes, S>* mid;  // generalised shape functions for about the middle of the step

  StepPoints() = default;
  StepPoints(const StepPoints&) = delete;  // `mid` may point to its own
};

/// Sets the averages of begin and end, and the conjugate strain s, at the point k.
template <int Nodes, typename S>
void set_point_strains(const ConservingElement<Nodes, S>& element, int k, const BeamNodes<Nodes, S>& nodes,
                       const PointKinematicsT<S>& begin, const PointKinematicsT<S>& end, StepPoints<Nodes, S>& at) {
  const GeneralisedShapeFunctions<Nodes, S>& mid = (*at.mid)[k];
  Point<Nodes, S>& p = at.points[k];
  p.end_rotation = end.rotation;
  p.end_tangent = end.tangent;
  p.average_rotation = S(0.5) * (begin.rotation + end.rotation);
  p.arm = S(0.5) * (begin.tangent + end.tangent);
  p.increment = mid.values[0] * nodes.increment[0];
  p.increment_derivative = mid.derivatives[0] * nodes.increment[0];
  for (int i = 1; i < Nodes; ++i) {
    p.increment += mid.values[i] * nodes.increment[i];
    p.increment_derivative += mid.derivatives[i] * nodes.increment[i];
  }
  p.stretch = end.tangent - begin.tangent + so3::cross(p.arm, p.increment);
  Vector6T<S> conjugate;
  conjugate.template head<3>() = p.average_rotation.transpose() * p.stretch;
  conjugate.template tail<3>() = p.average_rotation.transpose() * p.increment_derivative;
  p.own = PointStress<S>(element.section(k), begin.strain, end.strain, conjugate);
}

/// A variation {dr', spin, spin', dw, dw'} of a point.
template <typename S>
struct PointVariation {
  Vector3T<S> position, spin, spin_derivative, increment, increment_derivative;
};

/// A linear form of a PointVariation: the coefficients of its components.
template <typename S>
struct PointForm {
  Vector3T<S> position, spin, spin_derivative, increment, increment_derivative;
};

template <typename S>
S value_of(const PointForm<S>& form, const PointVariation<S>& v) {
  return so3::dot(form.position, v.position) + so3::dot(form.spin, v.spin) +
         so3::dot(form.spin_derivative, v.spin_derivative) + so3::dot(form.increment, v.increment) +
         so3::dot(form.increment_derivative, v.increment_derivative);
}

/// The changes of the strain at the end and of the conjugate strain s by a variation.
template <typename S>
struct StrainSlopes {
  Vector6T<S> end, conjugate;
};

template <int Nodes, typename S>
StrainSlopes<S> strain_slopes(const Point<Nodes, S>& p, const PointVariation<S>& v) {
  const Matrix3T<S> end = p.end_rotation.transpose(), average = p.average_rotation.transpose();
  StrainSlopes<S> slopes;
  slopes.end.template head<3>() = end * Vector3T<S>(v.position + so3::cross(p.end_tangent, v.spin));
  slopes.end.template tail<3>() = end * v.spin_derivative;
  const Vector3T<S> stretch =
      v.position + S(0.5) * so3::cross(v.position, p.increment) + so3::cross(p.arm, v.increment);
  slopes.conjugate.template head<3>() = average * stretch + end * Vector3T<S>(S(0.5) * so3::cross(p.stretch, v.spin));
  slopes.conjugate.template tail<3>() =
      average * v.increment_derivative + end * Vector3T<S>(S(0.5) * so3::cross(p.increment_derivative, v.spin));
  return slopes;
}

/// Returns sum_i functions_i values_i.
template <int Nodes, typename S>
Vector3T<S> sum_of(const std::array<Matrix3T<S>, Nodes>& functions, const std::array<Vector3T<S>, Nodes>& values) {
  Vector3T<S> sum = functions[0] * values[0];
  for (int i = 1; i < Nodes; ++i) sum += functions[i] * values[i];
  return sum;
}

/// Returns the linear form `conjugate` . ds + `end` . d(strain at the end) (beyond.md 1.3).
template <int Nodes, typename S>
PointForm<S> strain_form(const Point<Nodes, S>& p, const Vector6T<S>& conjugate, const Vector6T<S>& end) {
  const Matrix3T<S>& average = p.average_rotation;
  const Matrix3T<S>& rotation = p.end_rotation;
  const Vector3T<S> force = average * conjugate.template head<3>(), moment = average * conjugate.template tail<3>();
  const Vector3T<S> half_force = S(0.5) * (rotation * conjugate.template head<3>()),
                    half_moment = S(0.5) * (rotation * conjugate.template tail<3>());
  const Vector3T<S> end_force = rotation * end.template head<3>();
  PointForm<S> form;
  form.position = end_force + force - S(0.5) * so3::cross(force, p.increment);
  form.spin = so3::cross(end_force, p.end_tangent) + so3::cross(half_force, p.stretch) +
              so3::cross(half_moment, p.increment_derivative);
  form.spin_derivative = rotation * end.template tail<3>();
  form.increment = so3::cross(force, p.arm);
  form.increment_derivative = moment;
  return form;
}

/// Adds {I^i' n, I_t^i' m - I_t^i (arm x n)} of the point k to the residual. The moment rows of the last node follow
/// from the others, since the test functions sum to I and their derivatives to 0. `resultants`: weighted {N, M}.
template <int Nodes, typename S, class Rows>
void add_resultants(const ConservingElement<Nodes, S>& element, int k, const StepPoints<Nodes, S>& at,
                    const Vector6T<S>& resultants, Rows& residual) {
  const NodalValues<Nodes, S>& derivative = element.points[k].derivative;
  const GeneralisedShapeFunctions<Nodes, S>& tests = (*at.mid)[k];
  const Point<Nodes, S>& p = at.points[k];
  const Vector3T<S> n = p.average_rotation * resultants.template head<3>(),
                    m = p.average_rotation * resultants.template tail<3>(), couple = so3::cross(p.arm, n);
  Vector3T<S> rest = -couple;
  for (int i = 0; i < Nodes; ++i) {
    residual[i].template head<3>() += derivative[i] * n;
    if (i == Nodes - 1) break;
    Vector3T<S> moment = tests.derivatives[i].transpose() * m;
    moment -= tests.values[i].transpose() * couple;
    residual[i].template tail<3>() += moment;
    rest -= moment;
  }
  residual[Nodes - 1].template tail<3>() += rest;
}

}  // namespace flexarm::conserving

namespace flexarm {

/// Returns the rotations at the stiffness points. An element of two nodes has one point, half-way between the nodes.
template <int Nodes, typename S>
std::array<InterpolatedRotation<S>, Nodes - 1> point_rotations(const ConservingElement<Nodes, S>& element,
                                                               const LocalRotations<Nodes, S>& local) {
  std::array<InterpolatedRotation<S>, Nodes - 1> rotations;
  if constexpr (Nodes == 2) {
    rotations[0] = evaluate_half_way(local, element.points[0].derivative[1]);
  } else {
    for (int k = 0; k < Nodes - 1; ++k)
      rotations[k] = local.evaluate(element.points[k].shape, element.points[k].derivative);
  }
  return rotations;
}
/// The same; also sets `functions(k)`, the generalised shape functions at the point k.
template <int Nodes, typename S, class Functions>
std::array<InterpolatedRotation<S>, Nodes - 1> point_rotations(const ConservingElement<Nodes, S>& element,
                                                               const LocalRotations<Nodes, S>& local,
                                                               const Functions& functions) {
  std::array<InterpolatedRotation<S>, Nodes - 1> rotations;
  if constexpr (Nodes == 2) {
    rotations[0] = evaluate_half_way(local, element.points[0].derivative[1], functions(0));
  } else {
    const LocalRotationVariation<Nodes, S> variation(local);
    for (int k = 0; k < Nodes - 1; ++k)
      rotations[k] = variation.evaluate(element.points[k].shape, element.points[k].derivative, functions(k));
  }
  return rotations;
}

/// Computes the generalised shape functions for the middle of a step: those of the configuration half-way between
/// `orientation` and the end that the predicted tangent-scaled increments `foreseen` lead to.
template <int Nodes, typename S>
void mid_functions(const ConservingElement<Nodes, S>& element, const std::array<QuaternionT<S>, Nodes>& orientation,
                   const std::array<Vector3T<S>, Nodes>& foreseen, ElementFunctions<Nodes, S>& functions) {
  std::array<QuaternionT<S>, Nodes> half_way;
  for (int i = 0; i < Nodes; ++i) half_way[i] = cayley::half_quaternion(foreseen[i]) * orientation[i];
  point_rotations(
      element, LocalRotations<Nodes, S>(half_way), [&](int k) -> auto& { return functions[k]; });
}

/// Improves the functions of mid_functions() for large rotations of the whole element. The mean of the `foreseen`
/// increments is a rotation by the angle theta about e, with the stretch P = I + (cos(theta/2) - 1) e e^T. Values
/// become P^-1 I_g P, derivatives P I_g' P. Then the conjugate strain is exact to first order in the deformation, for
/// any rotation of the element in the step, and the energy multiplier is small (beyond.md 1.3).
template <int Nodes, typename S>
void stretch_mid_functions(const std::array<Vector3T<S>, Nodes>& foreseen, ElementFunctions<Nodes, S>& functions) {
  const Vector3T<S> mean = mean_of<Nodes, S>(foreseen);
  const Matrix3T<S> stretch = cayley::axial_stretch(mean), inverse = cayley::inverse_axial_stretch(mean);
  for (int k = 0; k < Nodes - 1; ++k) {
    for (int i = 0; i < Nodes; ++i) {
      const Matrix3T<S> value = functions[k].values[i].lazyProduct(stretch),
                        derivative = functions[k].derivatives[i].lazyProduct(stretch);
      functions[k].values[i] = inverse.lazyProduct(value);
      functions[k].derivatives[i] = stretch.lazyProduct(derivative);
    }
  }
}

/// Computes the stiffness points for given nodal positions and rotations.
template <int Nodes, typename S>
void element_points(const ConservingElement<Nodes, S>& element, const std::array<Vector3T<S>, Nodes>& position,
                    const std::array<QuaternionT<S>, Nodes>& orientation, PointKinematicsT<S>* points) {
  const auto rotations = point_rotations(element, LocalRotations<Nodes, S>(orientation));
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    points[k] =
        point_kinematics(rotations[k], interpolate<Nodes>(constants.derivative, position), constants.reference_strain);
  }
}

namespace conserving {

/// Computes the stiffness points of a step. `end`: output, the points at t_{n+1}. Sets their generalised shape
/// functions if `with_variation`, or if the rule's mid functions need them. `functions` must outlive `at`.
template <int Nodes, typename S>
void set_points(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, const TimeRule& rule,
                const ElementFunctions<Nodes, S>& functions, bool with_variation, PointKinematicsT<S>* end,
                StepPoints<Nodes, S>& at) {
  constexpr int kPoints = Nodes - 1;
  at.mid = &functions;
  const bool is_symmetric = rule.mid_functions == MidFunctions::Symmetric;
  const LocalRotations<Nodes, S> local(nodes.orientation);
  const std::array<InterpolatedRotation<S>, kPoints> rotation =
      with_variation || is_symmetric ? point_rotations(
                                           element, local, [&](int k) -> auto& { return at.points[k].generalised; })
                                     : point_rotations(element, local);
  if (is_symmetric) {
    for (int k = 0; k < kPoints; ++k)
      for (int i = 0; i < Nodes; ++i) {
        at.averages[k].values[i] = S(0.5) * (functions[k].values[i] + at.points[k].generalised.values[i]);
        at.averages[k].derivatives[i] =
            S(0.5) * (functions[k].derivatives[i] + at.points[k].generalised.derivatives[i]);
      }
    at.mid = &at.averages;
  }
  for (int k = 0; k < kPoints; ++k) {
    const auto& constants = element.points[k];
    end[k] =
        point_kinematics(rotation[k], interpolate<Nodes>(constants.derivative, nodes.end), constants.reference_strain);
  }
}

/// The energy multiplier of an element, see MultiplierWork.
template <int Nodes, typename S>
struct EnergyMultiplier : MultiplierWork<Nodes, Vector3T<S>, Vector6T<S>> {
  using Base = MultiplierWork<Nodes, Vector3T<S>, Vector6T<S>>;
  using Base::relative, Base::seen_work;

  void add(const S& weight, const SectionStiffness<S>& stiffness, const PointKinematicsT<S>& begin,
           const PointKinematicsT<S>& end, Point<Nodes, S>& p) {
    // Tangent-scaled rotation vector w_point of Q = Lambda_{n+1} Lambda_n^T: 4 vee(Q) / (1 + tr Q).
    Vector3T<S> axial = so3::cross(begin.rotation.col(0), end.rotation.col(0));
    S trace = so3::dot(begin.rotation.col(0), end.rotation.col(0));
    for (int c = 1; c < 3; ++c) {
      axial += so3::cross(begin.rotation.col(c), end.rotation.col(c));
      trace += so3::dot(begin.rotation.col(c), end.rotation.col(c));
    }
    const Vector3T<S> turn = (S(2) / (S(1) + trace)) * axial;
    // Delta Gamma - s_Gamma = Lambda_bar^T (arm x (w_point - w)) has no cancellation.
    Vector6T<S> defect;  // Delta Sigma - s
    defect.template head<3>() = p.average_rotation.transpose() * so3::cross(p.arm, Vector3T<S>(turn - p.increment));
    defect.template tail<3>() =
        end.strain.template tail<3>() - begin.strain.template tail<3>() - p.own.conjugate_strain.template tail<3>();
    this->add_defect(weight, stiffness, defect, p);
  }

  /// Adds the tangent of add_moments(). `work_row`: derivative of the work with respect to {dr, spin} of the nodes;
  /// `inverse_tangent`: S(w)^{-1}.
  void add_tangent(const std::array<Vector6T<S>, Nodes>& work_row,
                   const std::array<Matrix3T<S>, Nodes>& inverse_tangent, BlockTangent<Nodes, S>& tangent) const {
    const S by_work = this->slope(), mu = seen_work * by_work;
    const S by_square = seen_work / this->guarded() - S(2) * mu * by_work;
    for (int j = 0; j < Nodes; ++j) {
      Vector6T<S> row = by_work * work_row[j];
      row.template tail<3>() += (S(2) * by_square) * (inverse_tangent[j].transpose() * relative[j]);
      for (int i = 0; i < Nodes; ++i) {
        Matrix6T<S>& block = tangent[i][j];
        block.template bottomRows<3>() += relative[i].lazyProduct(row.transpose());
        block.template bottomRightCorner<3, 3>() += (mu * S((i == j ? 1.0 : 0.0) - 1.0 / Nodes)) * inverse_tangent[j];
      }
    }
  }
};

/// Computes carried strains (see flexarm::carried_strains()) from set_strains()'s strains and an update {dr, spin}.
template <int Nodes, typename S>
void carry_strains(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes,
                   const StepPoints<Nodes, S>& at, const std::array<Vector6T<S>, Nodes>& update,
                   const PointKinematicsT<S>* end, CarriedStrains<Nodes, S>& carried) {
  std::array<Vector3T<S>, Nodes> displacement, spin, increment;
  for (int i = 0; i < Nodes; ++i) {
    displacement[i] = update[i].template head<3>();
    spin[i] = update[i].template tail<3>();
    increment[i] = cayley::inverse_tangent(nodes.increment[i]) * spin[i];
  }
  for (int k = 0; k < Nodes - 1; ++k) {
    const Point<Nodes, S>& p = at.points[k];
    PointVariation<S> variation;
    variation.position = interpolate<Nodes>(element.points[k].derivative, displacement);
    variation.spin = sum_of<Nodes, S>(p.generalised.values, spin);
    variation.spin_derivative = sum_of<Nodes, S>(p.generalised.derivatives, spin);
    variation.increment = sum_of<Nodes, S>((*at.mid)[k].values, increment);
    variation.increment_derivative = sum_of<Nodes, S>((*at.mid)[k].derivatives, increment);
    const StrainSlopes<S> slopes = strain_slopes<Nodes, S>(p, variation);
    carried.end[k] = end[k].strain + slopes.end;
    carried.conjugate[k] = p.own.conjugate_strain + slopes.conjugate;
  }
  carried.has_conjugate = true;
}

}  // namespace conserving
}  // namespace flexarm
