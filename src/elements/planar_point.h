#pragma once
/// A stiffness point of the energy-momentum family in the plane: conserving_points.h, where all rotations are about the
/// normal. Then generalised shape functions are Lagrange's, and rotations are products of complex numbers.
/// (docs/notes/planar.md)

#include "elements/conserving_terms.h"
#include "elements/planar_element.h"
#include "math/rotation_series.h"

namespace flexarm::planar {

/// n x v: a quarter turn.
template <typename S>
inline Vector2T<S> quarter_turn(const Vector2T<S>& v) {
  return {-v[1], v[0]};
}
template <typename S>
inline S cross(const Vector2T<S>& a, const Vector2T<S>& b) {
  return a[0] * b[1] - a[1] * b[0];
}
template <typename S>
inline S dot(const Vector2T<S>& a, const Vector2T<S>& b) {
  return a[0] * b[0] + a[1] * b[1];
}

/// A turn, or the mean of two, from the axes of the section to those of the plane.
template <typename S>
struct Turn {
  S cosine, sine;

  Vector2T<S> to_plane(const Vector2T<S>& v) const {
    return {cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1]};
  }
  Vector2T<S> to_section(const Vector2T<S>& v) const {
    return {cosine * v[0] + sine * v[1], cosine * v[1] - sine * v[0]};
  }
};

template <int Nodes, typename S>
inline S sum_of(const NodalValues<Nodes, S>& weights, const std::array<S, Nodes>& values) {
  S sum = weights[0] * values[0];
  for (int i = 1; i < Nodes; ++i) sum += weights[i] * values[i];
  return sum;
}
template <int Nodes, typename S>
inline Vector2T<S> sum_of(const NodalValues<Nodes, S>& weights, const std::array<Vector2T<S>, Nodes>& values) {
  Vector2T<S> sum = weights[0] * values[0];
  for (int i = 1; i < Nodes; ++i) sum += weights[i] * values[i];
  return sum;
}

template <typename S>
inline Vector2T<S> force_of(const Vector3T<S>& resultants) {
  return {resultants[0], resultants[1]};
}

/// The stiffness points for given nodal positions and half angles. Angles are measured from the middle node, or one
/// beside the middle; interpolated, they do not depend on which one it is.
template <int Nodes, typename S>
void set_points(const Element<Nodes, S>& element, const std::array<Vector2T<S>, Nodes>& position,
                const std::array<S, Nodes>& cosine, const std::array<S, Nodes>& sine, PointKinematics<S>* points) {
  constexpr int from = (Nodes - 1) / 2;
  std::array<S, Nodes> angle;
  for (int i = 0; i < Nodes; ++i) {
    if (i == from) {
      angle[i] = S(0);
      continue;
    }
    const S relative_cosine = cosine[i] * cosine[from] + sine[i] * sine[from],
            relative_sine = sine[i] * cosine[from] - cosine[i] * sine[from];
    angle[i] = so3::detail::angle_per_sine(relative_cosine, S(relative_sine * relative_sine)) * relative_sine;
  }
  const Turn<S> middle{cosine[from] * cosine[from] - sine[from] * sine[from], S(2) * cosine[from] * sine[from]};
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    const S turn = sum_of<Nodes, S>(constants.shape, angle), square = turn * turn;
    const std::array<S, 2> series = so3::series_coefficients<1>(square);
    const Vector2T<S> rotated = middle.to_plane({S(1) - square * series[1], turn * series[0]});
    PointKinematics<S>& p = points[k];
    p.cosine = rotated[0];
    p.sine = rotated[1];
    p.tangent = sum_of<Nodes, S>(constants.derivative, position);
    const Vector2T<S> strain = Turn<S>{p.cosine, p.sine}.to_section(p.tangent);
    const S curvature = sum_of<Nodes, S>(constants.derivative, angle);
    p.strain = Vector3T<S>(strain[0], strain[1], curvature) - constants.reference_strain;
  }
}

template <typename S>
using PointStress = conserving::PointStress<S, 3>;

/// A stiffness point over a step, see conserving::Point.
template <typename S>
struct Point {
  Turn<S> end, average;          // Lambda_{n+1}, (Lambda_n + Lambda_{n+1}) / 2
  Vector2T<S> end_tangent, arm;  // r'_{n+1}, (r'_n + r'_{n+1}) / 2
  S increment;                   // interpolated w
  Vector2T<S> stretch;           // x = Delta r' + arm x w
  PointStress<S> own, seen;
  Vector3T<S> half_defect_stress;
  Vector3T<S> seen_resultants;
  S factor, damped_factor;
};

/// The averages of begin and end, and the conjugate strain s. `slope`: of the derivatives of the middle functions,
/// which are so many times Lagrange's.
template <int Nodes, typename S>
void set_strains(const typename Element<Nodes, S>::Point& constants, const S& slope, const Nodal<Nodes, S>& nodes,
                 const PointKinematics<S>& begin, const PointKinematics<S>& end, Point<S>& p) {
  p.end = {end.cosine, end.sine};
  p.end_tangent = end.tangent;
  p.average = {S(0.5) * (begin.cosine + end.cosine), S(0.5) * (begin.sine + end.sine)};
  p.arm = S(0.5) * (begin.tangent + end.tangent);
  p.increment = sum_of<Nodes, S>(constants.shape, nodes.increment);
  p.stretch = end.tangent - begin.tangent - p.increment * quarter_turn<S>(p.arm);
  const Vector2T<S> strain = p.average.to_section(p.stretch);
  const Vector3T<S> conjugate(strain[0], strain[1], slope * sum_of<Nodes, S>(constants.derivative, nodes.increment));
  p.own = PointStress<S>(constants.section, begin.strain, end.strain, conjugate);
}

/// What a variation {dr', spin, spin', dw, dw'} of a point makes of the strain at the end and of s.
template <typename S>
struct PointVariation {
  Vector2T<S> position;
  S spin, spin_derivative, increment, increment_derivative;
};
template <typename S>
struct StrainSlopes {
  Vector3T<S> end, conjugate;
};

/// Of the strain at one configuration, in which the section has turned so, with the tangent r'.
template <typename S>
Vector3T<S> strain_slope(const Turn<S>& turn, const Vector2T<S>& tangent, const Vector2T<S>& position, const S& spin,
                         const S& spin_derivative) {
  const Vector2T<S> strain = turn.to_section(position - spin * quarter_turn<S>(tangent));
  return {strain[0], strain[1], spin_derivative};
}

template <typename S>
StrainSlopes<S> strain_slopes(const Point<S>& p, const PointVariation<S>& v) {
  const Vector2T<S> stretch =
      v.position - (S(0.5) * p.increment) * quarter_turn<S>(v.position) - v.increment * quarter_turn<S>(p.arm);
  const Vector2T<S> conjugate =
      p.average.to_section(stretch) - (S(0.5) * v.spin) * p.end.to_section(quarter_turn<S>(p.stretch));
  return {strain_slope<S>(p.end, p.end_tangent, v.position, v.spin, v.spin_derivative),
          {conjugate[0], conjugate[1], v.increment_derivative}};
}

/// A linear form of a variation.
template <typename S>
struct PointForm {
  Vector2T<S> position;
  S spin, spin_derivative, increment, increment_derivative;
};

/// The form `conjugate`.ds + `end`.d(strain at the end) (beyond.md 1.3).
template <typename S>
PointForm<S> strain_form(const Point<S>& p, const Vector3T<S>& conjugate, const Vector3T<S>& end) {
  const Vector2T<S> force = p.average.to_plane(force_of<S>(conjugate)),
                    half_force = S(0.5) * p.end.to_plane(force_of<S>(conjugate)),
                    end_force = p.end.to_plane(force_of<S>(end));
  PointForm<S> form;
  form.position = end_force + force + (S(0.5) * p.increment) * quarter_turn<S>(force);
  form.spin = cross<S>(end_force, p.end_tangent) + cross<S>(half_force, p.stretch);
  form.spin_derivative = end[2];
  form.increment = cross<S>(force, p.arm);
  form.increment_derivative = conjugate[2];
  return form;
}

/// All stiffness points of an element over a step, at the trial configuration.
template <int Nodes, typename S>
using StepPoints = std::array<Point<S>, Nodes - 1>;

}  // namespace flexarm::planar
