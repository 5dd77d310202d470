// Tests beams at one configuration, for statics and the Newmark family.
#include "elements/endpoint_beam.h"

#include "elements/kernel_checks.h"
#include "elements/tested_step.h"

namespace flexarm {
namespace {

using namespace test;

constexpr NewmarkRule kInterpolatedRule{0.3025, 0.6, kStep, -0.1};

template <class Count>
class EndpointBeam : public ::testing::Test {};
TYPED_TEST_SUITE(EndpointBeam, NodeCounts);

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

TYPED_TEST(EndpointBeam, TangentOfStatics) {
  constexpr int N = TypeParam::value;
  RandomSource random(1);
  const RandomStep<N> step(random, 0.5);
  expect_consistent_tangent<N>(
      step, [&](const ElementNodes<N>& nodes, bool with) { return internal<N>(step, nodes, nullptr, with); });
}

TYPED_TEST(EndpointBeam, TangentWithDamping) {
  constexpr int N = TypeParam::value;
  RandomSource random(2);
  RandomStep<N> step(random, 0.5);
  step.element.stiffness_damping = 0.2;
  expect_consistent_tangent<N>(
      step, [&](const ElementNodes<N>& nodes, bool with) { return internal<N>(step, nodes, &kNewmarkRule, with); });
}

TYPED_TEST(EndpointBeam, TangentWithUnevenDamping) {
  constexpr int N = TypeParam::value;
  RandomSource random(2);
  RandomStep<N> step(random, 0.5);
  step.damp_unevenly(0.2);
  for (const NewmarkRule& rule : {kNewmarkRule, kInterpolatedRule})
    expect_consistent_tangent<N>(
        step, [&](const ElementNodes<N>& nodes, bool with) { return internal<N>(step, nodes, &rule, with); });
}

// At t_{n+1+alpha} the strain rate and the velocity of mass-proportional damping are interpolated.
TYPED_TEST(EndpointBeam, TangentWithDampingOfInterpolatedKinematics) {
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

TYPED_TEST(EndpointBeam, TangentWithGlobalInterpolations) {
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

TYPED_TEST(EndpointBeam, TangentOfNewmarkTranslation) {
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

TYPED_TEST(EndpointBeam, StressFreeWhereverTheUndeformedShapeIsPlaced) {
  constexpr int N = TypeParam::value;
  RandomSource random(4);
  RandomStep<N> step(random, 0.5);
  for (int k = 0; k < 5; ++k) {
    const Pose pose = random.pose(3, 3);
    for (int i = 0; i < N; ++i) {
      step.nodes.end[i] = pose * step.undeformed_position[i];
      step.set_orientation(i, pose.orientation * step.undeformed_orientation[i]);
    }
    EXPECT_LE(largest(internal<N>(step, step.nodes, nullptr, false).residual), kRoundOff);
  }
}

TYPED_TEST(EndpointBeam, StrainsUnchangedByRigidMotion) {
  constexpr int N = TypeParam::value;
  RandomSource random(5);
  RandomStep<N> step(random, 0.5);
  std::array<PointKinematics, N - 1> before, after;
  internal<N>(step, step.nodes, nullptr, false, &before);
  const Pose pose = random.pose(3, 3);
  for (int i = 0; i < N; ++i) {
    step.nodes.end[i] = pose * step.nodes.end[i];
    step.set_orientation(i, pose.orientation * step.nodes.orientation[i]);
  }
  internal<N>(step, step.nodes, nullptr, false, &after);
  for (int k = 0; k < N - 1; ++k) EXPECT_LE(largest(after[k].strain - before[k].strain), kRoundOff);
}

// Internal forces are in equilibrium: the resultant force and the moment about the origin vanish.
TYPED_TEST(EndpointBeam, InternalForcesBalance) {
  constexpr int N = TypeParam::value;
  RandomSource random(6);
  const RandomStep<N> step(random, 0.5);
  const ElementSystem<N> system = internal<N>(step, step.nodes, nullptr, false);
  Vector3 force = Vector3::Zero(), moment = force;
  for (int i = 0; i < N; ++i) {
    const Vector3 f = system.residual.template segment<3>(6 * i);
    force += f;
    moment += step.nodes.end[i].cross(f) + system.residual.template segment<3>(6 * i + 3);
  }
  EXPECT_LE(force.norm(), kRoundOff * largest(system.residual));
  EXPECT_LE(moment.norm(), kRoundOff * largest(system.residual));
}

// The static residual uses the generalised variation as test functions. It is the gradient of the strain energy where
// test and trial functions agree, here for translations: g_f = dV/dr.
TYPED_TEST(EndpointBeam, ForcesAreTheGradientOfTheStrainEnergy) {
  constexpr int N = TypeParam::value;
  RandomSource random(7);
  const RandomStep<N> step(random, 0.5);
  const ElementSystem<N> system = internal<N>(step, step.nodes, nullptr, false);
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 3; ++k) {
      const double slope = scalar_difference([&](double h) {
        std::array<PointKinematics, N - 1> points;
        internal<N>(step, step.perturbed(6 * i + k, h), nullptr, false, &points);
        return step.strain_energy(points);
      });
      EXPECT_NEAR(system.residual[6 * i + k], slope, difference_tolerance * largest(system.residual));
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

TYPED_TEST(EndpointBeam, StrainRateFollowsTheRule) {
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
TYPED_TEST(EndpointBeam, MassDamping) {
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
