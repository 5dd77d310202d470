// Tests Maxwell branches of a beam's material in the energy-momentum family.
#include "elements/maxwell.h"

#include <cmath>

#include "elements/conserving_kernel.h"
#include "elements/kernel_checks.h"
#include "elements/tested_step.h"

namespace flexarm {
namespace {

using namespace test;

template <class Count>
class MaxwellBeam : public ::testing::Test {};
TYPED_TEST_SUITE(MaxwellBeam, NodeCounts);

/// From branches that hardly relax over a step to those that do at once.
const std::vector<MaxwellBranch> kBranches = {{0.4, 1e4 * kStep}, {0.7, 2 * kStep}, {0.2, 1e-3 * kStep}};

/// Strains of the springs per stiffness point and branch.
using Strains = std::vector<Vector6>;

/// A random step of an element with Maxwell branches, which have relaxed in part from a motion before it.
template <int Nodes>
struct Relaxing {
  const RandomStep<Nodes>& step;
  Strains begin, end;
  ElementFunctions<Nodes> functions;
  std::array<PointKinematics, Nodes - 1> points;

  Relaxing(const RandomStep<Nodes>& step, RandomSource& random, double size)
      : step(step), functions(functions_at<Nodes>(step.element, step.begin_orientation)) {
    for (std::size_t i = 0; i < (Nodes - 1) * kBranches.size(); ++i) begin.push_back(size * random.vector6());
    end.resize(begin.size());
  }

  ElementSystem<Nodes> evaluate(const ElementNodes<Nodes>& nodes, bool with_tangent,
                                MidFunctions mid = MidFunctions::Explicit) {
    TimeRule rule;
    rule.correction = EnergyCorrection::Multiplier;
    rule.mid_functions = mid;
    KernelData<Nodes> data({step.element, nodes, functions, step.begin_points.data(), nullptr});
    std::vector<MaxwellCoefficients<Pack>> coefficients(kBranches.size());
    std::vector<Vector6T<Pack>> from(begin.size()), to(begin.size());
    for (int lane = 0; lane < Pack::kLanes; ++lane) {
      for (std::size_t b = 0; b < kBranches.size(); ++b)
        set_lane(coefficients[b], lane, maxwell_coefficients(kBranches[b], kStep));
      for (std::size_t i = 0; i < begin.size(); ++i) set_lane(from[i], lane, begin[i]);
    }
    packs::conserving_beam<Nodes>(data.element, data.nodes, rule, data.functions, data.begin.data(), nullptr, kStep,
                                  with_tangent, nullptr, data.end.data(), nullptr, data.system,
                                  {static_cast<int>(kBranches.size()), coefficients.data(), from.data(), to.data()});
    ElementSystem<Nodes> system;
    data.get(0, with_tangent, system);
    data.get_end(0, points.data(), nullptr);
    for (std::size_t i = 0; i < end.size(); ++i) end[i] = get_lane(to[i], 0);
    return system;
  }
  double stored(const Strains& strains) const {
    double energy = 0;
    for (std::size_t i = 0; i < strains.size(); ++i) {
      const auto& point = step.element.stiffness_points[i / kBranches.size()];
      energy += 0.5 * kBranches[i % kBranches.size()].modulus_ratio * point.weight *
                strains[i].dot(point.stiffness * strains[i]);
    }
    return energy;
  }
};

TYPED_TEST(MaxwellBeam, Tangent) {
  constexpr int N = TypeParam::value;
  RandomSource random(1);
  const RandomStep<N> step(random, 0.4);
  Relaxing<N> relaxing(step, random, 0.4);
  expect_consistent_tangent<N>(
      step, [&](const ElementNodes<N>& nodes, bool with) { return relaxing.evaluate(nodes, with); }, 0.8);
}

// Increment . internal forces = change of the strain energy and of that of the springs + dissipation, which is >= 0.
TYPED_TEST(MaxwellBeam, BudgetIsExact) {
  constexpr int N = TypeParam::value;
  RandomSource random(2);
  for (const MidFunctions mid : {MidFunctions::Explicit, MidFunctions::Symmetric})
    for (const double size : {1e-3, 0.1, 0.8}) {
      RandomStep<N> step(random, size);
      step.element.mass.setZero();
      Relaxing<N> relaxing(step, random, size);
      const ElementSystem<N> system = relaxing.evaluate(step.nodes, false, mid);
      const double before = step.strain_energy(step.begin_points) + relaxing.stored(relaxing.begin);
      const double after = step.strain_energy(relaxing.points) + relaxing.stored(relaxing.end);
      EXPECT_GE(system.dissipated, 0);
      EXPECT_NEAR(step.work(system.residual), after - before + system.dissipated,
                  kRoundOff * (before + after + largest(system.residual) * size * 6 * N));
    }
}

TYPED_TEST(MaxwellBeam, MomentaBalance) {
  constexpr int N = TypeParam::value;
  RandomSource random(3);
  RandomStep<N> step(random, 0.5);
  step.element.mass.setZero();
  Relaxing<N> relaxing(step, random, 0.5);
  const ElementSystem<N> system = relaxing.evaluate(step.nodes, false);
  EXPECT_LE(resultant<N>(step.nodes, system.residual, 0.5).norm(), kRoundOff * largest(system.residual));
}

// If a strained element turns as a rigid body, the springs only relax: e_1 = exp(-h / tau) e_0.
TYPED_TEST(MaxwellBeam, SpringsIgnoreRigidRotations) {
  constexpr int N = TypeParam::value;
  RandomSource random(4);
  RandomStep<N> step(random, 0.5);
  const Vector3 turn(0.3, -0.8, 0.5), travel(1, 2, -3);
  ElementNodes<N> nodes = step.nodes;
  for (int i = 0; i < N; ++i) {
    nodes.increment[i] = turn;
    const Quaternion rotation = cayley::quaternion(turn);
    nodes.orientation[i] = rotation * step.begin_orientation[i];
    nodes.end[i] = rotation * nodes.begin[i] + travel;
  }
  Relaxing<N> relaxing(step, random, 0.4);
  relaxing.evaluate(nodes, false);
  for (std::size_t i = 0; i < relaxing.end.size(); ++i) {
    const double left = std::exp(-kStep / kBranches[i % kBranches.size()].relaxation_time);
    EXPECT_LE(largest(relaxing.end[i] - left * relaxing.begin[i]), kRoundOff);
  }
}

// With s = r e_mean + e_1 - e_0 for a constant rate of strain, where r = h / tau:
// e(t) = e_0 exp(-t/tau) + (s/r) (1 - exp(-t/tau)), whose mean over the step is e_mean.
TEST(MaxwellCoefficients, SolveTheRampExactly) {
  for (const double tau : {1e-6, 0.03, 0.2, 1.0, 40.0, 1e9}) {
    const double h = 0.1;
    const long double r = h / static_cast<long double>(tau), gains = -std::expm1(-r) / r;
    const MaxwellCoefficients<double> c = maxwell_coefficients({0.5, tau}, h);
    EXPECT_EQ(c.modulus_ratio, 0.5);
    EXPECT_NEAR(c.keeps, static_cast<double>(std::exp(-r)), 1e-15);
    EXPECT_NEAR(c.gains / static_cast<double>(gains), 1, 1e-15);
    // s = r e_mean + e_1 - e_0, for s = 1 and e_0 = 0, and for s = 0 and e_0 = 1.
    EXPECT_NEAR(c.flow * c.yields + c.gains, 1, 1e-15);
    EXPECT_NEAR(c.flow * c.gains + c.keeps, 1, 1e-15);
    // The mean of a ramp, by its series where the closed form has no digits.
    const long double series = 0.5L - r / 6 + r * r / 24 - r * r * r / 120;
    EXPECT_NEAR(c.yields / static_cast<double>(r < 1e-3L ? series : (1 - gains) / r), 1, 1e-13);
    EXPECT_GE(c.excess, 0);
    EXPECT_LE(c.excess, 0.5);
  }
}

// A step back undoes a step: the rule is symmetric in time.
TEST(MaxwellCoefficients, BackwardStepsUndoSteps) {
  const MaxwellBranch branch{0.5, 0.2};
  const MaxwellCoefficients<double> on = maxwell_coefficients(branch, 0.1), back = maxwell_coefficients(branch, -0.1);
  EXPECT_NEAR(on.keeps * back.keeps, 1, 1e-15);
  EXPECT_NEAR(back.keeps * on.gains, back.gains, 1e-15);
  EXPECT_NEAR(back.gains * on.gains - back.yields, on.yields, 1e-15);  // the same mean
  EXPECT_NEAR(back.excess, -on.excess, 1e-15);
}

}  // namespace
}  // namespace flexarm
