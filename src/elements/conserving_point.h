#pragma once
/// A stiffness point in the energy-momentum family: strains over a step, and nodal forces of its stress resultants.
/// (beam.md 3.2, beyond.md 1.3)

#include "elements/beam_point.h"
#include "elements/conserving_element.h"
#include "math/so3.h"

namespace flexarm::conserving {

/// m hat(v).
template <typename S>
Matrix3T<S> times_hat(const Matrix3T<S>& m, const Vector3T<S>& v) {
  Matrix3T<S> product;
  product.col(0) = m.col(1) * v[2] - m.col(2) * v[1];
  product.col(1) = m.col(2) * v[0] - m.col(0) * v[2];
  product.col(2) = m.col(0) * v[1] - m.col(1) * v[0];
  return product;
}

/// hat(v) m.
template <typename S>
Matrix3T<S> hat_times(const Vector3T<S>& v, const Matrix3T<S>& m) {
  Matrix3T<S> product;
  for (int j = 0; j < 3; ++j) product.col(j) = so3::cross(v, m.col(j));
  return product;
}

/// Strains and elastic stresses of a stiffness point over a step.
template <typename S>
struct PointStress {
  Vector6T<S> strain, stress;                      // means of both ends
  Vector6T<S> conjugate_strain, conjugate_stress;  // s and C s

  PointStress() = default;
  PointStress(const SectionStiffness<S>& stiffness, const Vector6T<S>& begin, const Vector6T<S>& end,
              const Vector6T<S>& conjugate)
      : strain(S(0.5) * (begin + end)),
        stress(stiffness.stress(strain)),
        conjugate_strain(conjugate),
        conjugate_stress(stiffness.stress(conjugate)) {}
};

/// A stiffness point over a step.
template <int Nodes, typename S>
struct Point {
  GeneralisedShapeFunctions<Nodes, S> generalised;  // at the end
  Matrix3T<S> end_rotation, average_rotation;       // Lambda_{n+1}, (Lambda_n + Lambda_{n+1}) / 2
  Vector3T<S> end_tangent, arm;                     // r'_{n+1}, (r'_n + r'_{n+1}) / 2
  Vector3T<S> increment, increment_derivative;      // interpolated w and w'
  Vector3T<S> stretch;                              // x = Delta r' + arm x w
  PointStress<S> own, seen;                         // of the trial configuration, and of what is carried
  Vector6T<S> half_defect_stress;                   // C (Delta Sigma - s) / 2
  // What the forces leave for the tangent.
  Vector6T<S> seen_resultants;  // weighted, with dampers; by the geometric part
  S factor, damped_factor;      // of s in the stress: of C s, and of D C D s
};

/// The averages of begin and end, and the conjugate strain s. `mid`: generalised shape functions at about the middle.
template <int Nodes, typename S>
void set_strains(const GeneralisedShapeFunctions<Nodes, S>& mid, const SectionStiffness<S>& stiffness,
                 const BeamNodes<Nodes, S>& nodes, const PointKinematicsT<S>& begin, const PointKinematicsT<S>& end,
                 Point<Nodes, S>& p) {
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
  p.own = PointStress<S>(stiffness, begin.strain, end.strain, conjugate);
}

/// A variation {dr', spin, spin', dw, dw'} of a point.
template <typename S>
struct PointVariation {
  Vector3T<S> position, spin, spin_derivative, increment, increment_derivative;
};

/// A linear form of it.
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

/// What a variation makes of the strain at the end and of the conjugate strain s.
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

/// sum_i functions_i values_i.
template <int Nodes, typename S>
Vector3T<S> sum_of(const std::array<Matrix3T<S>, Nodes>& functions, const std::array<Vector3T<S>, Nodes>& values) {
  Vector3T<S> sum = functions[0] * values[0];
  for (int i = 1; i < Nodes; ++i) sum += functions[i] * values[i];
  return sum;
}

/// The form `conjugate`.ds + `end`.d(strain at the end) (beyond.md 1.3).
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

/// Adds {I^i' n, I_t^i' m - I_t^i (arm x n)} to the residual. The test functions sum to I, their derivatives to 0: the
/// last node takes what the others leave.
template <int Nodes, typename S>
void add_residual(const NodalValues<Nodes, S>& derivative, const GeneralisedShapeFunctions<Nodes, S>& tests,
                  const Vector3T<S>& n, const Vector3T<S>& m, const Vector3T<S>& arm,
                  std::array<Vector6T<S>, Nodes>& residual) {
  const Vector3T<S> couple = so3::cross(arm, n);
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

/// All stiffness points of an element over a step, at the trial configuration.
template <int Nodes, typename S>
struct StepPoints {
  std::array<Point<Nodes, S>, Nodes - 1> points;
  ElementFunctions<Nodes, S> averages;    // where the mid functions are symmetric
  const ElementFunctions<Nodes, S>* mid;  // of about the middle of the step

  StepPoints() = default;
  StepPoints(const StepPoints&) = delete;  // `mid` may point to its own
};

}  // namespace flexarm::conserving
