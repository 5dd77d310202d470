// Tests beams whose forces act at the end of a step.
#include "study_schemes/newmark_beam.h"

#include "elements/kernel_checks.h"
#include "elements/tested_step.h"

namespace flexarm {
namespace {

using namespace test;

constexpr NewmarkRule kInterpolatedRule{0.3025, 0.6, kStep, -0.1};

template <class Count>
class NewmarkBeam : public ::testing::Test {};
TYPED_TEST_SUITE(NewmarkBeam, NodeCounts);

template <int Nodes>
ElementSystem<Nodes> internal(const RandomStep<Nodes>& step, const ElementNodes<Nodes>& nodes, const NewmarkRule* rule,
                              bool with_tangent, std::array<PointKinematics, Nodes - 1>* points = nullptr) {
  std::array<PointKinematics, Nodes - 1> end;
  std::array<Vector6, Nodes - 1> rates, new_rates;
  for (int k = 0; k < Nodes - 1; ++k) rates[k] = 0.1 * (k + 1) * Vector6::Ones();
  ElementSystem<Nodes> system;
  system.set_zero();
  endpoint_internal<Nodes>(step.element, nodes, rule, step.begin_points.data(), rates.data(), with_tangent, end.data(),
                           new_rates.data(), system);
  if (points) *points = end;
  return system;
}

TYPED_TEST(NewmarkBeam, TangentWithDamping) {
  constexpr int N = TypeParam::value;
  RandomSource random(2);
  RandomStep<N> step(random, 0.5);
  step.element.stiffness_damping = 0.2;
  expect_consistent_tangent<N>(
      step, [&](const ElementNodes<N>& nodes, bool with) { return internal<N>(step, nodes, &kNewmarkRule, with); });
}

TYPED_TEST(NewmarkBeam, TangentWithUnevenDamping) {
  constexpr int N = TypeParam::value;
  RandomSource random(2);
  RandomStep<N> step(random, 0.5);
  step.damp_unevenly(0.2);
  for (const NewmarkRule& rule : {kNewmarkRule, kInterpolatedRule})
    expect_consistent_tangent<N>(
        step, [&](const ElementNodes<N>& nodes, bool with) { return internal<N>(step, nodes, &rule, with); });
}

// At t_{n+1+alpha} the strain rate and the velocity of mass-proportional damping are interpolated.
TYPED_TEST(NewmarkBeam, TangentWithDampingOfInterpolatedKinematics) {
  constexpr int N = TypeParam::value;
  RandomSource random(10);
  RandomStep<N> step(random, 0.5);
  step.element.stiffness_damping = 0.2;
  step.element.mass_damping = 0.4;
  expect_consistent_tangent<N>(step, [&](const ElementNodes<N>& nodes, bool with) {
    ElementSystem<N> system = internal<N>(step, nodes, &kInterpolatedRule, with);
    newmark_mass_damping<N>(step.element, nodes, kInterpolatedRule, with, system);
    return system;
  });
}

TYPED_TEST(NewmarkBeam, TangentWithGlobalInterpolations) {
  constexpr int N = TypeParam::value;
  RandomSource random(11);
  for (const Interpolation interpolation :
       {Interpolation::Total, Interpolation::Incremental, Interpolation::Iterative}) {
    SCOPED_TRACE(static_cast<int>(interpolation));
    RandomStep<N> step(random, 0.5);
    step.set_interpolation(random, interpolation);
    step.element.stiffness_damping = 0.2;
    expect_consistent_tangent<N>(
        step, [&](const ElementNodes<N>& nodes, bool with) { return internal<N>(step, nodes, &kNewmarkRule, with); });
  }
}

TYPED_TEST(NewmarkBeam, TangentOfNewmarkTranslation) {
  constexpr int N = TypeParam::value;
  RandomSource random(3);
  for (const double damping : {0.0, 0.4}) {
    RandomStep<N> step(random, 0.5);
    step.element.mass_damping = damping;
    expect_consistent_tangent<N>(step, [&](const ElementNodes<N>& nodes, bool with) {
      ElementSystem<N> system;
      system.set_zero();
      newmark_translation<N>(step.element, nodes, kNewmarkRule, with, system);
      newmark_mass_damping<N>(step.element, nodes, kNewmarkRule, with, system);
      return system;
    });
  }
}

// Checks the formulas of Newmark's rule against their definition.
TEST(NewmarkRule, AgreesWithItsDefinition) {
  RandomSource random(8);
  const Vector3 v0 = random.vector(), a0 = random.vector(), a1 = random.vector();
  const double h = kNewmarkRule.step;
  const Vector3 increment = h * v0 + h * h * ((0.5 - kNewmarkRule.beta) * a0 + kNewmarkRule.beta * a1);
  EXPECT_LE((kNewmarkRule.acceleration(increment, v0, a0) - a1).norm(), 1e-13);
  EXPECT_LE(
      (kNewmarkRule.velocity(v0, a0, a1) - v0 - h * ((1 - kNewmarkRule.gamma) * a0 + kNewmarkRule.gamma * a1)).norm(),
      1e-15);
  const double slope = scalar_difference(
      [&](double d) { return kNewmarkRule.acceleration(increment + d * Vector3::UnitX(), v0, a0).x(); });
  EXPECT_NEAR(slope, kNewmarkRule.acceleration_slope(), 1e-9);
  EXPECT_NEAR(kNewmarkRule.velocity_slope(), kNewmarkRule.gamma * h * kNewmarkRule.acceleration_slope(), 1e-12);
}

TYPED_TEST(NewmarkBeam, StrainRateFollowsTheRule) {
  constexpr int N = TypeParam::value;
  RandomSource random(9);
  for (const NewmarkRule& rule : {kNewmarkRule, kInterpolatedRule}) {
    RandomStep<N> step(random, 0.3);
    step.element.stiffness_damping = 0.2;
    std::array<PointKinematics, N - 1> end;
    std::array<Vector6, N - 1> rates, new_rates;
    for (Vector6& rate : rates) rate = random.vector6();
    ElementSystem<N> system;
    system.set_zero();
    endpoint_internal<N>(step.element, step.nodes, &rule, step.begin_points.data(), rates.data(), false, end.data(),
                         new_rates.data(), system);
    double dissipated = 0;
    for (int k = 0; k < N - 1; ++k) {
      // Strains are those at t_{n+1+alpha}, where the rate is (1 + alpha) new - alpha old.
      const Vector6 increment = rule.step * ((1 - rule.gamma) * rates[k] + rule.gamma * new_rates[k]);
      const Vector6 change = end[k].strain - step.begin_points[k].strain;
      EXPECT_LE(largest(change - (1 + rule.alpha) * increment), kRoundOff);
      const Vector6 rate = (1 + rule.alpha) * new_rates[k] - rule.alpha * rates[k];
      dissipated += step.element.stiffness_points[k].weight * 0.2 *
                    increment.dot(step.element.stiffness_points[k].stiffness * rate);
    }
    EXPECT_NEAR(system.dissipated, dissipated, kRoundOff * largest(system.residual));
  }
}

// The force of mass-proportional damping is the mass matrix times the velocities at t_{n+1+alpha}. It dissipates its
// work.
TYPED_TEST(NewmarkBeam, MassDamping) {
  constexpr int N = TypeParam::value;
  RandomSource random(12);
  for (const NewmarkRule& rule : {kNewmarkRule, kInterpolatedRule}) {
    RandomStep<N> step(random, 0.3);
    step.element.mass_damping = 0.4;
    ElementSystem<N> system;
    system.set_zero();
    newmark_mass_damping<N>(step.element, step.nodes, rule, false, system);
    Eigen::Matrix<double, 6 * N, 1> expected = Eigen::Matrix<double, 6 * N, 1>::Zero();
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) {
        const Vector3 &v0 = step.nodes.velocity[j], &a0 = step.nodes.acceleration[j];
        const Vector3 a1 = rule.acceleration(step.nodes.end[j] - step.nodes.begin[j], v0, a0);
        const Vector3 v1 = rule.velocity(v0, a0, a1);
        expected.template segment<3>(6 * i) += 0.4 * step.element.mass(i, j) * (v1 + rule.alpha * (v1 - v0));
      }
    EXPECT_LE(largest(system.residual - expected), kRoundOff * largest(expected));
    EXPECT_NEAR(system.dissipated, step.work(system.residual), kRoundOff * largest(expected));
  }
}

}  // namespace
}  // namespace flexarm
