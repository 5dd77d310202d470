// Tests the internal forces of beams at one configuration.
#include "elements/static_beam.h"

#include "elements/kernel_checks.h"
#include "elements/tested_step.h"

namespace flexarm {
namespace {

using namespace test;

template <class Count>
class StaticBeam : public ::testing::Test {};
TYPED_TEST_SUITE(StaticBeam, NodeCounts);

template <int Nodes, class Form = SpinForm>
ElementSystem<Nodes> internal(const RandomStep<Nodes>& step, const ElementNodes<Nodes>& nodes, bool with_tangent,
                              std::array<PointKinematics, Nodes - 1>* points = nullptr) {
  std::array<PointKinematics, Nodes - 1> end;
  ElementSystem<Nodes> system;
  system.set_zero();
  static_beam<Nodes, Form>(step.element, nodes, with_tangent, end.data(), system);
  if (points) *points = end;
  return system;
}

TYPED_TEST(StaticBeam, TangentOfStatics) {
  constexpr int N = TypeParam::value;
  RandomSource random(1);
  const RandomStep<N> step(random, 0.5);
  expect_consistent_tangent<N>(step,
                               [&](const ElementNodes<N>& nodes, bool with) { return internal<N>(step, nodes, with); });
}

TYPED_TEST(StaticBeam, StressFreeWhereverTheUndeformedShapeIsPlaced) {
  constexpr int N = TypeParam::value;
  RandomSource random(4);
  RandomStep<N> step(random, 0.5);
  for (int k = 0; k < 5; ++k) {
    const Pose pose = random.pose(3, 3);
    for (int i = 0; i < N; ++i) {
      step.nodes.end[i] = pose * step.undeformed_position[i];
      step.set_orientation(i, pose.orientation * step.undeformed_orientation[i]);
    }
    EXPECT_LE(largest(internal<N>(step, step.nodes, false).residual), kRoundOff);
  }
}

TYPED_TEST(StaticBeam, StrainsUnchangedByRigidMotion) {
  constexpr int N = TypeParam::value;
  RandomSource random(5);
  RandomStep<N> step(random, 0.5);
  std::array<PointKinematics, N - 1> before, after;
  internal<N>(step, step.nodes, false, &before);
  const Pose pose = random.pose(3, 3);
  for (int i = 0; i < N; ++i) {
    step.nodes.end[i] = pose * step.nodes.end[i];
    step.set_orientation(i, pose.orientation * step.nodes.orientation[i]);
  }
  internal<N>(step, step.nodes, false, &after);
  for (int k = 0; k < N - 1; ++k) EXPECT_LE(largest(after[k].strain - before[k].strain), kRoundOff);
}

// Internal forces are in equilibrium: the resultant force and the moment about the origin vanish.
TYPED_TEST(StaticBeam, InternalForcesBalance) {
  constexpr int N = TypeParam::value;
  RandomSource random(6);
  const RandomStep<N> step(random, 0.5);
  const ElementSystem<N> system = internal<N>(step, step.nodes, false);
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
TYPED_TEST(StaticBeam, ForcesAreTheGradientOfTheStrainEnergy) {
  constexpr int N = TypeParam::value;
  RandomSource random(7);
  const RandomStep<N> step(random, 0.5);
  const ElementSystem<N> system = internal<N>(step, step.nodes, false);
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 3; ++k) {
      const double slope = scalar_difference([&](double h) {
        std::array<PointKinematics, N - 1> points;
        internal<N>(step, step.perturbed(6 * i + k, h), false, &points);
        return step.strain_energy(points);
      });
      EXPECT_NEAR(system.residual[6 * i + k], slope, difference_tolerance * largest(system.residual));
    }
}

// With the generalised shape functions as tests, all rows are that gradient.
TYPED_TEST(StaticBeam, VariationFormIsTheGradientOfTheStrainEnergy) {
  constexpr int N = TypeParam::value;
  RandomSource random(8);
  const RandomStep<N> step(random, 0.5);
  const ElementSystem<N> system = internal<N, VariationForm>(step, step.nodes, false);
  for (int column = 0; column < 6 * N; ++column) {
    const double slope = scalar_difference([&](double h) {
      std::array<PointKinematics, N - 1> points;
      internal<N>(step, step.perturbed(column, h), false, &points);
      return step.strain_energy(points);
    });
    EXPECT_NEAR(system.residual[column], slope, difference_tolerance * largest(system.residual));
  }
}

}  // namespace
}  // namespace flexarm
