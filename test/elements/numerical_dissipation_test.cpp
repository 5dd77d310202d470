// Tests dampers with memory in the energy-momentum family: numerical dissipation and structural damping.
#include "elements/conserving_kernel.h"
#include "elements/kernel_checks.h"
#include "elements/tested_step.h"
#include "schemes/scheme.h"

namespace flexarm {
namespace {

using namespace test;

template <class Count>
class DissipativeBeam : public ::testing::Test {};
TYPED_TEST_SUITE(DissipativeBeam, NodeCounts);

template <int Nodes>
using Memory = std::array<StrainMemory, Nodes - 1>;

/// A memory as a past motion could have left it. Only the second-order rule keeps an average.
template <int Nodes>
Memory<Nodes> random_memory(RandomSource& random, int order, double size) {
  Memory<Nodes> memory;
  for (StrainMemory& point : memory) {
    if (order == 2) point.average = size * random.vector6();
    point.rate = size / kStep * random.vector6();
    point.delayed_rate = size / kStep * random.vector6();
  }
  return memory;
}

/// A rule with numerical dissipation; order 0 is without.
TimeRule dissipative_rule(int order, double rho, double relaxation = 0) {
  TimeRule rule;
  if (order > 0) rule.dissipation = numerical_dissipation(order, rho, kStep);
  rule.damping_relaxation = relaxation;
  return rule;
}

/// Constants of structural damping, docs/schemes.md: delta = eta/4 min(eta/h_0, 1) [s], and delta h_0 [s^2].
double delayed_dashpot_of(double viscosity, double relaxation) {
  return relaxation > 0 ? 0.25 * viscosity * std::min(viscosity / relaxation, 1.0) : 0;
}
double inertance_of(double viscosity, double relaxation) {
  return relaxation * delayed_dashpot_of(viscosity, relaxation);
}

template <int Nodes>
struct Dissipative {
  const RandomStep<Nodes>& step;
  TimeRule rule;
  Memory<Nodes> memory, end_memory;
  ElementFunctions<Nodes> functions;
  std::array<PointKinematics, Nodes - 1> end;

  Dissipative(const RandomStep<Nodes>& step, const TimeRule& rule, const Memory<Nodes>& memory)
      : step(step), rule(rule), memory(memory) {
    functions = functions_at<Nodes>(step.element, step.begin_orientation);
  }
  ElementSystem<Nodes> evaluate(bool has_multiplier, const ElementNodes<Nodes>& nodes, bool with_tangent) {
    ElementSystem<Nodes> system;
    conserving_beam<Nodes>(has_multiplier, step.element, nodes, rule, functions, step.begin_points.data(),
                           memory.data(), kStep, with_tangent, end.data(), end_memory.data(), system);
    return system;
  }
};

TYPED_TEST(DissipativeBeam, Tangent) {
  constexpr int N = TypeParam::value;
  RandomSource random(1);
  for (const int order : {0, 1, 2})
    for (const double damping : {0.0, 0.2}) {
      const double size = 0.4;
      RandomStep<N> step(random, size);
      step.element.stiffness_damping = damping;
      Dissipative<N> dissipative(step, dissipative_rule(order, 0.5, 2 * kStep), random_memory<N>(random, order, size));
      expect_consistent_tangent<N>(
          step, [&](const ElementNodes<N>& nodes, bool with) { return dissipative.evaluate(true, nodes, with); },
          2 * size);
      expect_consistent_tangent<N>(
          step, [&](const ElementNodes<N>& nodes, bool with) { return dissipative.evaluate(false, nodes, with); });
    }
}

/// Energy stored in the memory of an element: (stiffness / forgetting y.Cy + inertance w.Cw) / 2, and inertance (w.Cw +
/// q.Cq) / 2 for structural damping.
template <int Nodes>
double stored(const RandomStep<Nodes>& step, const TimeRule& rule, const Memory<Nodes>& memory) {
  const NumericalDissipation& d = rule.dissipation;
  const double damper = inertance_of(step.element.stiffness_damping, rule.damping_relaxation);
  double energy = 0;
  for (int k = 0; k < Nodes - 1; ++k) {
    const Vector6 &y = memory[k].average, &w = memory[k].rate, &q = memory[k].delayed_rate;
    const Matrix6 stiffness = step.element.stiffness_points[k].weight * step.element.stiffness_points[k].stiffness;
    if (d.forgetting > 0) energy += 0.5 * d.stiffness / d.forgetting * y.dot(stiffness * y);
    energy += 0.5 * (d.inertance + damper) * w.dot(stiffness * w) + 0.5 * damper * q.dot(stiffness * q);
  }
  return energy;
}

template <int Nodes>
void expect_exact_budget(RandomSource& random, const TimeRule& rule, int order, double damping, double size) {
  RandomStep<Nodes> step(random, size);
  step.element.mass.setZero();
  step.element.stiffness_damping = damping;
  Dissipative<Nodes> dissipative(step, rule, random_memory<Nodes>(random, order, size));
  const ElementSystem<Nodes> system = dissipative.evaluate(true, step.nodes, false);
  const double before = step.strain_energy(step.begin_points) + stored(step, rule, dissipative.memory);
  const double after = step.strain_energy(dissipative.end) + stored(step, rule, dissipative.end_memory);
  EXPECT_GE(system.dissipated, 0);
  EXPECT_NEAR(step.work(system.residual), after - before + system.dissipated,
              kRoundOff * (before + after + largest(system.residual) * size * 6 * Nodes));
}

// Increment . internal forces = change of strain energy + change of the energy stored in the memory + dissipation.
TYPED_TEST(DissipativeBeam, BudgetIsExact) {
  RandomSource random(2);
  for (const int order : {1, 2})
    for (const double rho : {0.0, 0.5, 0.9})
      for (const double size : {1e-3, 0.1, 0.8})
        for (const MidFunctions mid : {MidFunctions::Explicit, MidFunctions::Symmetric}) {
          TimeRule rule = dissipative_rule(order, rho);
          rule.mid_functions = mid;
          expect_exact_budget<TypeParam::value>(random, rule, order, 0, size);
        }
}

// The same with structural damping from weak to strong, with steps of the relaxation time and of half of it, and
// without relaxation.
TYPED_TEST(DissipativeBeam, BudgetOfDampingIsExact) {
  RandomSource random(5);
  for (const int order : {0, 2})
    for (const double damping : {1e-3 * kStep, kStep, 1e3 * kStep})
      for (const double relaxation : {0.0, kStep, 8 * kStep})
        expect_exact_budget<TypeParam::value>(random, dissipative_rule(order, 0.5, relaxation), order, damping, 0.1);
}

TYPED_TEST(DissipativeBeam, MomentaBalance) {
  constexpr int N = TypeParam::value;
  RandomSource random(3);
  for (const int order : {1, 2}) {
    RandomStep<N> step(random, 0.5);
    step.element.mass.setZero();
    Dissipative<N> dissipative(step, dissipative_rule(order, 0.5), random_memory<N>(random, order, 0.5));
    const ElementSystem<N> system = dissipative.evaluate(true, step.nodes, false);
    EXPECT_LE(resultant<N>(step.nodes, system.residual, 0.5).norm(), kRoundOff * largest(system.residual));
  }
}

// Definition: y_1 = y_0 + forgetting (s - y_0), (w_0 + w_1)/2 = s/h, with the same strain increment s.
TYPED_TEST(DissipativeBeam, MemoryFollowsItsDefinition) {
  constexpr int N = TypeParam::value;
  RandomSource random(4);
  RandomStep<N> step(random, 0.4);
  Dissipative<N> dissipative(step, dissipative_rule(2, 0.5), random_memory<N>(random, 2, 0.4));
  dissipative.evaluate(true, step.nodes, false);
  for (int k = 0; k < N - 1; ++k) {
    const StrainMemory &begin = dissipative.memory[k], &end = dissipative.end_memory[k];
    const Vector6 s = 0.5 * kStep * (begin.rate + end.rate);
    const Vector6 expected = begin.average + dissipative.rule.dissipation.forgetting * (s - begin.average);
    EXPECT_LE(largest(end.average - expected), kRoundOff);
  }
}

// Definition: (q_0 + q_1)/2 + (h_0/h) (q_1 - q_0) = s/h = (w_0 + w_1)/2. The stress C [dashpot s/h + inertance (w_1 -
// w_0)/h + delayed q_mean] does the work of damping.
TYPED_TEST(DissipativeBeam, DampingFollowsItsDefinition) {
  constexpr int N = TypeParam::value;
  RandomSource random(6);
  const double relaxation = 2 * kStep;
  const Memory<N> memory = random_memory<N>(random, 0, 0.4);
  for (const double viscosity : {0.0, 0.3 * relaxation, 4 * relaxation}) {
    RandomStep<N> step(random, 0.4);
    Dissipative<N> undamped(step, dissipative_rule(0, 1, relaxation), memory);
    const auto elastic = undamped.evaluate(true, step.nodes, false).residual;
    step.element.stiffness_damping = viscosity;
    Dissipative<N> damped(step, dissipative_rule(0, 1, relaxation), memory);
    const auto whole = damped.evaluate(true, step.nodes, false).residual;
    if (viscosity == 0) {
      EXPECT_EQ(whole, elastic);
      continue;
    }
    const double delayed_dashpot = delayed_dashpot_of(viscosity, relaxation);
    double work = 0;
    for (int k = 0; k < N - 1; ++k) {
      const StrainMemory &begin = damped.memory[k], &end = damped.end_memory[k];
      const Vector6 rate = 0.5 * (begin.rate + end.rate), delayed = 0.5 * (begin.delayed_rate + end.delayed_rate);
      EXPECT_LE(largest(delayed + relaxation / kStep * (end.delayed_rate - begin.delayed_rate) - rate), kRoundOff);
      const Vector6 stress = step.element.stiffness_points[k].stiffness *
                             ((viscosity - delayed_dashpot) * rate + delayed_dashpot * delayed +
                              inertance_of(viscosity, relaxation) / kStep * (end.rate - begin.rate));
      work += step.element.stiffness_points[k].weight * kStep * rate.dot(stress);
    }
    EXPECT_NEAR(step.work(whole - elastic), work, kRoundOff * (largest(whole) + std::abs(work)));
  }
}

// A massless spring of unit stiffness is the limit of infinite frequency: (x_0 + x_1)/2 + stiffness (s - y_0) +
// inertance (w_1 - w_0)/h = 0. All eigenvalues of a step are -rho: the characteristic polynomial is (z + rho)^n.
TEST(NumericalDissipation, SpectralRadiusAtInfiniteFrequency) {
  for (const int order : {1, 2})
    for (const double rho : {0.0, 0.4, 0.8}) {
      const NumericalDissipation d = numerical_dissipation(order, rho, kStep);
      const double factor = 0.5 + d.stiffness + 2 * d.inertance / (kStep * kStep);
      const Vector3 s = -Vector3(1, -d.stiffness, -2 * d.inertance / kStep) / factor;  // times {x, y, w}
      Matrix3 map;
      map.row(0) = Vector3::UnitX() + s;
      map.row(1) = Vector3::UnitY() + d.forgetting * (s - Vector3::UnitY());
      map.row(2) = 2 / kStep * s - Vector3::UnitZ();
      if (order == 1) {  // order 1 keeps no average
        map.row(1).setZero();
        map.col(1).setZero();
      }
      const double trace = map.trace(), minors = 0.5 * (trace * trace - (map * map).trace());
      EXPECT_NEAR(trace, -(order + 1) * rho, 1e-13);
      EXPECT_NEAR(minors, (2 * order - 1) * rho * rho, 1e-13);
      EXPECT_NEAR(map.determinant(), order == 2 ? -rho * rho * rho : 0, 1e-13);
    }
}

}  // namespace
}  // namespace flexarm
