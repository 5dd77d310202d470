#pragma once
/// Planar beams over a step of the energy-momentum family. All rotations are about the normal of the plane. The terms
/// are those of conserving_beam.h and conserving_tangent.h that are not zero. Generalised shape functions equal
/// Lagrange functions, and rotations are like products of complex numbers. (docs/notes/planar.md)

#include "elements/conserving_terms.h"
#include "elements/planar_element.h"
#include "math/rotation_series.h"
#include "schemes/time_rule.h"

namespace flexarm::planar {

/// Returns n x v, with the normal n: v rotated by 90 degrees.
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

/// A rotation from the section's axes to those of the plane, or the mean of two such rotations.
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

/// Computes the stiffness points for given nodal positions and half angles. Angles are measured relative to the middle
/// node (or one of the two nodes next to the middle). The interpolated rotation does not depend on this choice.
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

/// All stiffness points of an element over a step, at the trial configuration.
template <int Nodes, typename S>
struct StepPoints {
  std::array<Point<S>, Nodes - 1> points;
  S slope;  // derivatives of the middle functions = slope * derivatives of the Lagrange functions
};

/// Sets the averages of begin and end, and the conjugate strain s, at the point k.
template <int Nodes, typename S>
void set_point_strains(const Element<Nodes, S>& element, int k, const Nodal<Nodes, S>& nodes,
                       const PointKinematics<S>& begin, const PointKinematics<S>& end, StepPoints<Nodes, S>& at) {
  const auto& constants = element.points[k];
  Point<S>& p = at.points[k];
  p.end = {end.cosine, end.sine};
  p.end_tangent = end.tangent;
  p.average = {S(0.5) * (begin.cosine + end.cosine), S(0.5) * (begin.sine + end.sine)};
  p.arm = S(0.5) * (begin.tangent + end.tangent);
  p.increment = sum_of<Nodes, S>(constants.shape, nodes.increment);
  p.stretch = end.tangent - begin.tangent - p.increment * quarter_turn<S>(p.arm);
  const Vector2T<S> strain = p.average.to_section(p.stretch);
  const Vector3T<S> conjugate(strain[0], strain[1], at.slope * sum_of<Nodes, S>(constants.derivative, nodes.increment));
  p.own = PointStress<S>(constants.section, begin.strain, end.strain, conjugate);
}

/// A variation {dr', spin, spin', dw, dw'} of a point.
template <typename S>
struct PointVariation {
  Vector2T<S> position;
  S spin, spin_derivative, increment, increment_derivative;
};
/// The changes of the strain at the end and of the conjugate strain s by a variation.
template <typename S>
struct StrainSlopes {
  Vector3T<S> end, conjugate;
};

/// Returns the change of the strain at one configuration by a variation. `turn`: rotation of the section; `tangent`:
/// r'.
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

/// A linear form of a variation: the coefficients of its components.
template <typename S>
struct PointForm {
  Vector2T<S> position;
  S spin, spin_derivative, increment, increment_derivative;
};

/// Returns the linear form `conjugate` . ds + `end` . d(strain at the end) (beyond.md 1.3).
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

/// Adds {I^i' n, slope I^i' m - I^i (arm x n)} of the point k to the residual. `resultants`: weighted {N, M}.
template <int Nodes, typename S, class Rows>
void add_resultants(const Element<Nodes, S>& element, int k, const StepPoints<Nodes, S>& at,
                    const Vector3T<S>& resultants, Rows& residual) {
  const auto& constants = element.points[k];
  const Point<S>& p = at.points[k];
  const Vector2T<S> n = p.average.to_plane(force_of<S>(resultants));
  const S couple = cross<S>(p.arm, n), m = at.slope * resultants[2];
  for (int i = 0; i < Nodes; ++i) {
    residual[i][0] += constants.derivative[i] * n[0];
    residual[i][1] += constants.derivative[i] * n[1];
    residual[i][2] += constants.derivative[i] * m - constants.shape[i] * couple;
  }
}

/// The element's energy multiplier, see conserving::EnergyMultiplier.
template <int Nodes, typename S>
struct EnergyMultiplier : conserving::MultiplierWork<Nodes, S, Vector3T<S>> {
  using Base = conserving::MultiplierWork<Nodes, S, Vector3T<S>>;
  using Base::relative, Base::seen_work;

  void add(const S& weight, const SectionStiffness<S>& stiffness, const PointKinematics<S>& begin,
           const PointKinematics<S>& end, Point<S>& p) {
    const S sine = begin.cosine * end.sine - begin.sine * end.cosine,
            cosine = begin.cosine * end.cosine + begin.sine * end.sine;
    const S turn = S(2) * sine / (S(1) + cosine);
    const Vector2T<S> strain = (p.increment - turn) * p.average.to_section(quarter_turn<S>(p.arm));
    const Vector3T<S> defect(strain[0], strain[1], end.strain[2] - begin.strain[2] - p.own.conjugate_strain[2]);
    this->add_defect(weight, stiffness, defect, p);
  }

  /// Adds the tangent of add_moments(). `work_row`: derivative of the work with respect to {dr, spin} of the nodes;
  /// `rate`: derivative of their increments with respect to the spins.
  void add_tangent(const std::array<Vector3T<S>, Nodes>& work_row, const std::array<S, Nodes>& rate,
                   BlockSystem<Nodes, S>& system) const {
    const S by_work = this->slope(), mu = seen_work * by_work;
    const S by_square = seen_work / this->guarded() - S(2) * mu * by_work;
    for (int j = 0; j < Nodes; ++j) {
      Vector3T<S> row = by_work * work_row[j];
      row[2] += (S(2) * by_square) * (rate[j] * relative[j]);
      for (int i = 0; i < Nodes; ++i) {
        auto& block = system.tangent[i][j];
        for (int c = 0; c < 3; ++c) block(2, c) += relative[i] * row[c];
        block(2, 2) += (mu * S((i == j ? 1.0 : 0.0) - 1.0 / Nodes)) * rate[j];
      }
    }
  }
};

/// Returns the change {dn, dm} of the weighted resultants if the strain at the end changes by `end` and s by
/// `conjugate`, at constant rotation.
template <int Nodes, typename S>
Vector3T<S> resultant_slope(const typename Element<Nodes, S>::Point& constants, bool is_uneven, const Point<S>& p,
                            const Vector3T<S>& end, const Vector3T<S>& conjugate) {
  Vector3T<S> stress = constants.section.stress(S(0.5) * end + p.factor * conjugate);
  if (is_uneven) stress += p.damped_factor * constants.damped.stress(conjugate);
  stress *= constants.weight;
  const Vector2T<S> force = p.average.to_plane(force_of<S>(stress));
  return {force[0], force[1], stress[2]};
}

/// Adds the tangent of add_resultants(). `position` and `turns` are {dn, dm} for unit dr' and for unit spins of the
/// nodes; `couple` is d(arm x n) for unit dr'.
template <int Nodes, typename S>
[[gnu::always_inline]] inline void add_point_tangent(const typename Element<Nodes, S>::Point& constants, const S& slope,
                                                     const Vector2T<S>& arm, const std::array<Vector3T<S>, 2>& position,
                                                     const std::array<S, 2>& couple,
                                                     const std::array<Vector3T<S>, Nodes>& turns,
                                                     BlockSystem<Nodes, S>& system) {
  std::array<S, Nodes> turned_couple;
  for (int j = 0; j < Nodes; ++j) turned_couple[j] = cross<S>(arm, force_of<S>(turns[j]));
  for (int i = 0; i < Nodes; ++i) {
    const S &shape = constants.shape[i], &derivative = constants.derivative[i], test = slope * derivative;
    for (int c = 0; c < 2; ++c) {
      const S moment = test * position[c][2] - shape * couple[c];
      const Vector2T<S> row = derivative * force_of<S>(position[c]);
      for (int j = 0; j < Nodes; ++j) {
        auto& block = system.tangent[i][j];
        block(0, c) += constants.derivative[j] * row[0];
        block(1, c) += constants.derivative[j] * row[1];
        block(2, c) += constants.derivative[j] * moment;
      }
    }
    for (int j = 0; j < Nodes; ++j) {
      auto& block = system.tangent[i][j];
      block(0, 2) += derivative * turns[j][0];
      block(1, 2) += derivative * turns[j][1];
      block(2, 2) += test * turns[j][2] - shape * turned_couple[j];
    }
  }
}

/// Adds the tangent of an element's internal forces, after set_forces().
template <int Nodes, typename S>
void add_tangent(const Element<Nodes, S>& element, const Nodal<Nodes, S>& nodes, const TimeRule& rule,
                 const StepPoints<Nodes, S>& at, const EnergyMultiplier<Nodes, S>& multiplier,
                 BlockSystem<Nodes, S>& system) {
  const bool is_corrected = rule.correction == EnergyCorrection::Multiplier;
  const bool is_uneven = element.has_stiffness_damping && !element.is_damped_evenly;
  const S zero(0), one(1), &slope = at.slope;
  std::array<S, Nodes> rate;  // dw = rate spin
  std::array<Vector3T<S>, Nodes> work_row;
  for (int i = 0; i < Nodes; ++i) {
    rate[i] = S(1) + S(0.25) * nodes.increment[i] * nodes.increment[i];
    work_row[i].setConstant(S(0));
  }
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    const Point<S>& p = at.points[k];
    const auto slope_of = [&](const PointVariation<S>& variation) -> Vector3T<S> {
      const StrainSlopes<S> strains = strain_slopes<S>(p, variation);
      return resultant_slope<Nodes, S>(constants, is_uneven, p, strains.end, strains.conjugate);
    };
    const Vector2T<S> none(zero, zero);
    const std::array<Vector3T<S>, 2> position = {slope_of({{one, zero}, zero, zero, zero, zero}),
                                                 slope_of({{zero, one}, zero, zero, zero, zero})};
    Vector3T<S> spin = slope_of({none, one, zero, zero, zero});
    const Vector3T<S> spin_derivative = slope_of({none, zero, one, zero, zero}),
                      increment = slope_of({none, zero, zero, one, zero}),
                      increment_derivative = slope * slope_of({none, zero, zero, zero, one});
    const Vector2T<S> force = force_of<S>(p.seen_resultants), n = p.average.to_plane(force),
                      turned = S(0.5) * quarter_turn<S>(p.end.to_plane(force));
    spin[0] += turned[0];
    spin[1] += turned[1];
    // d(arm x n), in which the arm varies by dr' / 2.
    const std::array<S, 2> couple = {cross<S>(p.arm, force_of<S>(position[0])) + S(0.5) * n[1],
                                     cross<S>(p.arm, force_of<S>(position[1])) - S(0.5) * n[0]};
    std::array<Vector3T<S>, Nodes> turns;
    for (int j = 0; j < Nodes; ++j)
      turns[j] = constants.shape[j] * Vector3T<S>(spin + rate[j] * increment) +
                 constants.derivative[j] * Vector3T<S>(spin_derivative + rate[j] * increment_derivative);
    add_point_tangent<Nodes, S>(constants, slope, p.arm, position, couple, turns, system);
    if (!is_corrected) continue;
    const PointForm<S> form = multiplier.form(constants.weight, p);
    for (int j = 0; j < Nodes; ++j) {
      const S &shape = constants.shape[j], &derivative = constants.derivative[j];
      work_row[j][0] += derivative * form.position[0];
      work_row[j][1] += derivative * form.position[1];
      work_row[j][2] += shape * (form.spin + rate[j] * form.increment) +
                        derivative * (form.spin_derivative + rate[j] * slope * form.increment_derivative);
    }
  }
  if (is_corrected) multiplier.add_tangent(work_row, rate, system);
}

/// Computes the forces of an element over a step, and the tangent if `with_tangent`. `slope`: see StepPoints. `end`:
/// output, the points at t_{n+1}. For the other parameters see conserving::set_forces().
template <int Nodes, typename S>
void beam(const Element<Nodes, S>& element, const S& slope, const Nodal<Nodes, S>& nodes, const TimeRule& rule,
          const PointKinematics<S>* begin, const StrainMemory<S>* memory, double step, bool with_tangent,
          const CarriedStrains<Nodes, S>* carried, PointKinematics<S>* end, StrainMemory<S>* end_memory,
          BlockSystem<Nodes, S>& system, const MaxwellBranches<S, 3>& branches = {}) {
  StepPoints<Nodes, S> at;
  EnergyMultiplier<Nodes, S> multiplier;
  at.slope = slope;
  set_points<Nodes, S>(element, nodes.end, nodes.cosine, nodes.sine, end);
  conserving::set_strains<Nodes>(element, nodes, begin, end, carried, at);
  conserving::set_forces<Nodes>(element, nodes, rule, begin, end, memory, step, with_tangent, carried != nullptr,
                                end_memory, branches, at, multiplier, system);
  if (with_tangent) add_tangent<Nodes, S>(element, nodes, rule, at, multiplier, system);
}

/// See conserving::carry_strains(). `update`: {dx, dy, spin} of the nodes.
template <int Nodes, typename S>
void carry_strains(const Element<Nodes, S>& element, const S& slope, const Nodal<Nodes, S>& nodes,
                   const PointKinematics<S>* begin, const std::array<Vector3T<S>, Nodes>& update,
                   PointKinematics<S>* end, CarriedStrains<Nodes, S>& carried) {
  std::array<Vector2T<S>, Nodes> displacement;
  std::array<S, Nodes> spin, increment;
  for (int i = 0; i < Nodes; ++i) {
    displacement[i] = {update[i][0], update[i][1]};
    spin[i] = update[i][2];
    increment[i] = (S(1) + S(0.25) * nodes.increment[i] * nodes.increment[i]) * spin[i];
  }
  StepPoints<Nodes, S> at;
  at.slope = slope;
  set_points<Nodes, S>(element, nodes.end, nodes.cosine, nodes.sine, end);
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    const Point<S>& p = at.points[k];
    set_point_strains(element, k, nodes, begin[k], end[k], at);
    const StrainSlopes<S> slopes = strain_slopes<S>(
        p, {sum_of<Nodes, S>(constants.derivative, displacement), sum_of<Nodes, S>(constants.shape, spin),
            sum_of<Nodes, S>(constants.derivative, spin), sum_of<Nodes, S>(constants.shape, increment),
            slope * sum_of<Nodes, S>(constants.derivative, increment)});
    carried.end[k] = end[k].strain + slopes.end;
    carried.conjugate[k] = p.own.conjugate_strain + slopes.conjugate;
  }
  carried.has_conjugate = true;
}

}  // namespace flexarm::planar
