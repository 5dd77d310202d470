#pragma once
/// Beam residual and tangent over a step of the energy-momentum family in the plane: conserving_beam.h and
/// conserving_tangent.h term by term, where they are not zero. (docs/notes/planar.md)

#include <cassert>

#include "elements/conserving_terms.h"
#include "elements/planar_point.h"
#include "schemes/time_rule.h"

namespace flexarm::planar {

/// See translational_forces(). Sets the system.
template <int Nodes, typename S>
void set_translation(const Element<Nodes, S>& element, const Nodal<Nodes, S>& nodes, double factor, double step,
                     bool with_tangent, BlockSystem<Nodes, S>& system) {
  const auto translation = translational_forces<Vector2T<S>, Nodes>(element, nodes, factor, step);
  system.dissipated = translation.dissipated;
  for (int i = 0; i < Nodes; ++i) {
    const Vector2T<S>& force = translation.forces[i];
    system.residual[i] << force[0], force[1], S(0), S(0);
    for (int j = 0; j < Nodes && with_tangent; ++j) {
      system.tangent[i][j].setConstant(S(0));
      system.tangent[i][j](0, 0) = system.tangent[i][j](1, 1) = translation.slope * element.mass(i, j);
    }
  }
}

/// The element's energy multiplier, see conserving::EnergyMultiplier.
template <int Nodes, typename S>
struct EnergyMultiplier {
  static constexpr double kRest = 1e-7;  ///< [rad]

  std::array<S, Nodes> relative;
  S square = S(0), work = S(0), seen_work = S(0);

  void set_relative(const std::array<S, Nodes>& increments) {
    S mean = increments[0];
    for (int i = 1; i < Nodes; ++i) mean += increments[i];
    mean *= S(1.0 / Nodes);
    for (int i = 0; i < Nodes; ++i) {
      relative[i] = increments[i] - mean;
      square += relative[i] * relative[i];
    }
  }

  void add(const typename Element<Nodes, S>::Point& constants, const PointKinematics<S>& begin,
           const PointKinematics<S>& end, Point<S>& p) {
    const S sine = begin.cosine * end.sine - begin.sine * end.cosine,
            cosine = begin.cosine * end.cosine + begin.sine * end.sine;
    const S turn = S(2) * sine / (S(1) + cosine);
    const Vector2T<S> strain = (p.increment - turn) * p.average.to_section(quarter_turn<S>(p.arm));
    const Vector3T<S> defect(strain[0], strain[1], end.strain[2] - begin.strain[2] - p.own.conjugate_strain[2]);
    work += constants.weight * so3::dot(p.own.stress, defect);
    seen_work += constants.weight * so3::dot(p.seen.stress, defect);
    p.half_defect_stress = S(0.5) * constants.section.stress(defect);
  }

  S slope() const { return square / guarded(); }
  PointForm<S> form(const S& weight, const Point<S>& p) const {
    return strain_form<S>(p, -weight * p.seen.stress, weight * Vector3T<S>(p.half_defect_stress + p.seen.stress));
  }

  void add_moments(BlockSystem<Nodes, S>& system, bool has_carried) const {
    const S mu = work * slope(), rest = seen_work * slope() - mu;
    for (int i = 0; i < Nodes; ++i) system.residual[i][2] += mu * relative[i];
    for (int i = 0; i < Nodes && has_carried; ++i) system.carried[i][2] += rest * relative[i];
  }
  /// `work_row`: d(work) for {dr, spin} of the nodes; `rate`: of their increments per spin.
  void add_tangent(const std::array<Vector3T<S>, Nodes>& work_row, const std::array<S, Nodes>& rate,
                   BlockSystem<Nodes, S>& system) const {
    const S by_work = slope(), mu = seen_work * by_work, by_square = seen_work / guarded() - S(2) * mu * by_work;
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

 private:
  S guarded() const { return square * square + S(kRest * kRest * kRest * kRest); }
};

/// Adds {I^i' n, slope I^i' m - I^i (arm x n)}.
template <int Nodes, typename S>
void add_residual(const typename Element<Nodes, S>::Point& constants, const S& slope, const Point<S>& p,
                  const Vector3T<S>& resultants, std::array<Eigen::Matrix<S, 4, 1>, Nodes>& residual) {
  const Vector2T<S> n = p.average.to_plane(force_of<S>(resultants));
  const S couple = cross<S>(p.arm, n), m = slope * resultants[2];
  for (int i = 0; i < Nodes; ++i) {
    residual[i][0] += constants.derivative[i] * n[0];
    residual[i][1] += constants.derivative[i] * n[1];
    residual[i][2] += constants.derivative[i] * m - constants.shape[i] * couple;
  }
}

/// Strains and elastic stresses at the points; `carried` may be null.
template <int Nodes, typename S>
void set_strains(const Element<Nodes, S>& element, const S& slope, const Nodal<Nodes, S>& nodes,
                 const PointKinematics<S>* begin, const PointKinematics<S>* end,
                 const CarriedStrains<Nodes, S>* carried, StepPoints<Nodes, S>& at) {
  for (int k = 0; k < Nodes - 1; ++k) {
    Point<S>& p = at[k];
    set_strains<Nodes, S>(element.points[k], slope, nodes, begin[k], end[k], p);
    p.seen = p.own;
    if (carried)
      p.seen = PointStress<S>(element.points[k].section, begin[k].strain, carried->end[k],
                              carried->has_conjugate ? carried->conjugate[k] : p.own.conjugate_strain);
  }
}

/// See conserving::set_forces.
template <int Nodes, typename S>
void set_forces(const Element<Nodes, S>& element, const S& slope, const Nodal<Nodes, S>& nodes, const TimeRule& rule,
                const PointKinematics<S>* begin, const PointKinematics<S>* end, const StrainMemory<S>* memory,
                double step, bool with_tangent, bool has_carried, StrainMemory<S>* end_memory, StepPoints<Nodes, S>& at,
                EnergyMultiplier<Nodes, S>& multiplier, BlockSystem<Nodes, S>& system) {
  const bool is_corrected = rule.correction == EnergyCorrection::Multiplier;
  const bool has_memory = rule.dissipation.any() || element.has_stiffness_damping;
  const bool is_uneven = element.has_stiffness_damping && !element.is_damped_evenly;
  set_translation<Nodes, S>(element, nodes, rule.velocity_factor(), step, with_tangent, system);
  if (is_corrected) {
    multiplier.set_relative(nodes.increment);
    for (int k = 0; k < Nodes - 1; ++k) multiplier.add(element.points[k], begin[k], end[k], at[k]);
  }
  const conserving::DamperParts<S> damper_parts(element.stiffness_damping, rule.damping_relaxation);
  for (int i = 0; i < Nodes && has_carried; ++i) system.carried[i].setConstant(S(0));
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    Point<S>& p = at[k];
    p.factor = p.damped_factor = S(0);
    Vector3T<S> stress = p.own.stress, seen = p.seen.stress;
    const auto forget = [&](const Vector3T<S>& remembered) {
      stress -= remembered;
      seen -= remembered;
    };
    if (rule.dissipation.any()) {
      const conserving::NumericalDamper<S, 3> damper(rule.dissipation, memory[k], p.own.conjugate_strain,
                                                     constants.section, step);
      p.factor += damper.factor;
      forget(damper.remembered);
      system.dissipated += constants.weight * damper.dissipated;
      end_memory[k].average = damper.average;
    }
    if (element.has_stiffness_damping) {
      const SectionStiffness<S>& damped = is_uneven ? constants.damped : constants.section;
      const Vector3T<S> damped_stress = damped.stress(p.own.conjugate_strain);
      const conserving::StructuralDamper<S, 3> damper(damper_parts, rule.damping_relaxation, memory[k],
                                                      p.own.conjugate_strain, damped_stress, damped, step);
      if (is_uneven) {
        p.damped_factor = damper.factor;
        stress += p.damped_factor * damped_stress;
        seen += p.damped_factor * damped.stress(p.seen.conjugate_strain);
      } else {
        p.factor += damper.factor;
      }
      forget(damper.remembered);
      system.dissipated += constants.weight * damper.dissipated;
      end_memory[k].delayed_rate = damper.delayed_rate;
    }
    if (has_memory) end_memory[k].rate = conserving::end_rate(memory[k], p.own.conjugate_strain, step);
    const Vector3T<S> weighted = constants.weight * Vector3T<S>(stress + p.factor * p.own.conjugate_stress);
    add_residual<Nodes, S>(constants, slope, p, weighted, system.residual);
    if (!with_tangent) continue;
    p.seen_resultants = constants.weight * Vector3T<S>(seen + p.factor * p.seen.conjugate_stress);
    if (has_carried)
      add_residual<Nodes, S>(constants, slope, p, Vector3T<S>(p.seen_resultants - weighted), system.carried);
  }
  if (is_corrected) multiplier.add_moments(system, has_carried);
}

/// {dn, dm} of a variation of the strain at the end by `end` and of s by `conjugate`; n is not turned.
template <int Nodes, typename S>
Vector3T<S> resultant_slope(const typename Element<Nodes, S>::Point& constants, bool is_uneven, const Point<S>& p,
                            const Vector3T<S>& end, const Vector3T<S>& conjugate) {
  Vector3T<S> stress = constants.section.stress(S(0.5) * end + p.factor * conjugate);
  if (is_uneven) stress += p.damped_factor * constants.damped.stress(conjugate);
  stress *= constants.weight;
  const Vector2T<S> force = p.average.to_plane(force_of<S>(stress));
  return {force[0], force[1], stress[2]};
}

/// Adds the tangent of add_residual(): `position`, `turns` are {dn, dm} of variations of dr' and of the nodes' spins,
/// `couple` d(arm x n) of dr'.
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
void add_tangent(const Element<Nodes, S>& element, const S& slope, const Nodal<Nodes, S>& nodes, const TimeRule& rule,
                 const StepPoints<Nodes, S>& at, const EnergyMultiplier<Nodes, S>& multiplier,
                 BlockSystem<Nodes, S>& system) {
  const bool is_corrected = rule.correction == EnergyCorrection::Multiplier;
  const bool is_uneven = element.has_stiffness_damping && !element.is_damped_evenly;
  const S zero(0), one(1);
  std::array<S, Nodes> rate;  // dw = rate spin
  std::array<Vector3T<S>, Nodes> work_row;
  for (int i = 0; i < Nodes; ++i) {
    rate[i] = S(1) + S(0.25) * nodes.increment[i] * nodes.increment[i];
    work_row[i].setConstant(S(0));
  }
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    const Point<S>& p = at[k];
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
    // d(arm x n), of which the arm varies by half of dr'.
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

/// Forces of an element over a step, with the tangent where it is asked for; `end` receives the points at t_{n+1}. See
/// conserving_beam.h for the others.
template <int Nodes, typename S>
void beam(const Element<Nodes, S>& element, const S& slope, const Nodal<Nodes, S>& nodes, const TimeRule& rule,
          const PointKinematics<S>* begin, const StrainMemory<S>* memory, double step, bool with_tangent,
          const CarriedStrains<Nodes, S>* carried, PointKinematics<S>* end, StrainMemory<S>* end_memory,
          BlockSystem<Nodes, S>& system) {
  StepPoints<Nodes, S> at;
  EnergyMultiplier<Nodes, S> multiplier;
  assert(step != 0 && begin && end);
  assert(!(rule.dissipation.any() || element.has_stiffness_damping) || (memory && end_memory));
  set_points<Nodes, S>(element, nodes.end, nodes.cosine, nodes.sine, end);
  set_strains<Nodes, S>(element, slope, nodes, begin, end, carried, at);
  set_forces<Nodes, S>(element, slope, nodes, rule, begin, end, memory, step, with_tangent, carried != nullptr,
                       end_memory, at, multiplier, system);
  if (with_tangent) add_tangent<Nodes, S>(element, slope, nodes, rule, at, multiplier, system);
}

/// See conserving::carry_strains. `update`: {dx, dy, spin} of the nodes.
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
  set_points<Nodes, S>(element, nodes.end, nodes.cosine, nodes.sine, end);
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    Point<S> p;
    set_strains<Nodes, S>(constants, slope, nodes, begin[k], end[k], p);
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
