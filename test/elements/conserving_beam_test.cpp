// Beams over a step in the conserving family: tangents, momenta, energy, damping.
#include "flexarm/elements/conserving_beam.h"

#include "elements/kernel_checks.h"

namespace flexarm {
namespace {

using namespace test;

constexpr double kStep = 0.3;
/// Sums of some hundred terms of order one to a hundred: round-off.
constexpr double kRoundOff = 1e-12;

/// Generalised shape functions half-way through the step, as the mechanism foresees them.
template <int Nodes>
ElementFunctions<Nodes> mid_functions(const RandomStep<Nodes>& step) {
  std::array<Quaternion, Nodes> orientation;
  for (int i = 0; i < Nodes; ++i) {
    const Vector3 half = 0.5 * cayley::to_rotation_vector(step.nodes.increment[i]);
    orientation[i] = so3::exp_quaternion(half) * step.begin_orientation[i];
  }
  ElementFunctions<Nodes> functions;
  element_functions<Nodes>(step.element, orientation, functions);
  return functions;
}

template <class Stress, int Nodes>
ElementSystem<Nodes> evaluate(const RandomStep<Nodes>& step, const ElementNodes<Nodes>& nodes, bool with_tangent,
                              std::array<PointKinematics, Nodes - 1>* points = nullptr) {
  std::array<PointKinematics, Nodes - 1> end;
  ElementSystem<Nodes> system;
  conserving_beam<Stress, Nodes>(step.element, nodes, mid_functions(step), step.begin_points.data(), kStep,
                                 with_tangent, end.data(), system);
  if (points) *points = end;
  return system;
}

template <class Count>
class ConservingBeam : public ::testing::Test {};
TYPED_TEST_SUITE(ConservingBeam, NodeCounts);

template <class Stress, int Nodes>
void expect_tangents(unsigned seed) {
  RandomSource random(seed);
  for (const double damping : {0.0, 0.2})
    for (const double size : {0.05, 0.5}) {
      RandomStep<Nodes> step(random, size);
      step.element.stiffness_damping = step.element.mass_damping = damping;
      expect_consistent_tangent<Nodes>(
          step,
          [&](const ElementNodes<Nodes>& nodes, bool with_tangent) {
            return evaluate<Stress, Nodes>(step, nodes, with_tangent);
          },
          2 * size);  // the multiplier is a quotient of quadratic forms in the increments
    }
}

TYPED_TEST(ConservingBeam, TangentOfAverageStress) {
  expect_tangents<AverageStress, TypeParam::value>(1);
}
TYPED_TEST(ConservingBeam, TangentOfDiscreteGradientStress) {
  expect_tangents<DiscreteGradientStress, TypeParam::value>(2);
}
TYPED_TEST(ConservingBeam, TangentOfExponentialMoment) {
  expect_tangents<ExponentialMoment, TypeParam::value>(3);
}

// Resultant force and moment about the origin, with the mid-step arm, are the rates of the momenta of the translation.
template <class Stress, int Nodes>
void expect_momentum_balance() {
  RandomSource random(4);
  RandomStep<Nodes> step(random, 0.5);
  step.element.stiffness_damping = 0.2;
  const ElementSystem<Nodes> system = evaluate<Stress, Nodes>(step, step.nodes, false);
  Vector3 force = Vector3::Zero(), moment = force, momentum_rate = force, angular_rate = force;
  for (int i = 0; i < Nodes; ++i) {
    const Vector3 f = system.residual.template segment<3>(6 * i);
    force += f;
    moment += 0.5 * (step.nodes.begin[i] + step.nodes.end[i]).cross(f) + system.residual.template segment<3>(6 * i + 3);
    for (int j = 0; j < Nodes; ++j) {
      const Vector3 v0 = step.nodes.velocity[j], v1 = 2 / kStep * (step.nodes.end[j] - step.nodes.begin[j]) - v0;
      momentum_rate += step.element.mass(i, j) / kStep * (v1 - v0);
      angular_rate += step.element.mass(i, j) / kStep * (step.nodes.end[i].cross(v1) - step.nodes.begin[i].cross(v0));
    }
  }
  const double scale = largest(system.residual);
  EXPECT_LE((force - momentum_rate).norm(), kRoundOff * scale);
  EXPECT_LE((moment - angular_rate).norm(), kRoundOff * scale);
}

TYPED_TEST(ConservingBeam, MomentaBalance) {
  expect_momentum_balance<AverageStress, TypeParam::value>();
  expect_momentum_balance<DiscreteGradientStress, TypeParam::value>();
  expect_momentum_balance<ExponentialMoment, TypeParam::value>();
}

template <int Nodes>
double kinetic_energy_change(const RandomStep<Nodes>& step) {
  double change = 0;
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j) {
      const auto after = [&](int k) {
        return Vector3(2 / kStep * (step.nodes.end[k] - step.nodes.begin[k]) - step.nodes.velocity[k]);
      };
      change +=
          0.5 * step.element.mass(i, j) * (after(i).dot(after(j)) - step.nodes.velocity[i].dot(step.nodes.velocity[j]));
    }
  return change;
}

TYPED_TEST(ConservingBeam, EnergyBalanceOfDiscreteGradientIsExact) {
  constexpr int N = TypeParam::value;
  RandomSource random(5);
  for (const double size : {1e-3, 0.1, 0.8})
    for (const double damping : {0.0, 0.2}) {
      RandomStep<N> step(random, size);
      step.element.stiffness_damping = step.element.mass_damping = damping;
      std::array<PointKinematics, N - 1> end;
      const ElementSystem<N> system = evaluate<DiscreteGradientStress, N>(step, step.nodes, false, &end);
      const double strain_change = step.strain_energy(end) - step.strain_energy(step.begin_points);
      const double scale =
          step.strain_energy(end) + step.strain_energy(step.begin_points) + largest(system.residual) * size * 6 * N;
      EXPECT_NEAR(step.work(system.residual), strain_change + kinetic_energy_change(step) + system.dissipated,
                  kRoundOff * scale);
      if (damping > 0)
        EXPECT_GT(system.dissipated, 0);
      else
        EXPECT_EQ(system.dissipated, 0);
    }
}

// EM0 misses the balance by a third power of the increments: its test functions are those of the middle of the step.
// (With Lagrange functions the defect would be of first order on a deformed element.)
TYPED_TEST(ConservingBeam, EnergyDefectOfAverageStressIsOfThirdOrder) {
  constexpr int N = TypeParam::value;
  // Root mean square over random steps: in a single one the leading coefficient may happen to be small.
  const auto defect = [](double size) {
    double sum = 0;
    for (unsigned seed = 0; seed < 30; ++seed) {
      RandomSource random(seed);  // the same increments, scaled
      RandomStep<N> step(random, 0.1);
      step.element.mass.setZero();
      for (int i = 0; i < N; ++i) {
        const Vector3 turn = size * random.vector();
        step.set_orientation(i, so3::exp_quaternion(turn) * step.begin_orientation[i]);
        step.nodes.end[i] = step.nodes.begin[i] + size * random.vector();
      }
      step.set_begin_points();
      std::array<PointKinematics, N - 1> end;
      const ElementSystem<N> system = evaluate<AverageStress, N>(step, step.nodes, false, &end);
      sum += std::pow(step.work(system.residual) - step.strain_energy(end) + step.strain_energy(step.begin_points), 2);
    }
    return std::sqrt(sum);
  };
  EXPECT_NEAR(defect(0.02) / defect(0.01), 8, 8 * 0.1);  // the next order is smaller by the increment's size
}

// The damping force alone does exactly the work that is counted as dissipated.
template <class Stress, int Nodes>
void expect_exact_dissipation(double stiffness_damping, double mass_damping) {
  RandomSource random(7);
  RandomStep<Nodes> step(random, 0.4);
  const ElementSystem<Nodes> without = evaluate<Stress, Nodes>(step, step.nodes, false);
  step.element.stiffness_damping = stiffness_damping;
  step.element.mass_damping = mass_damping;
  const ElementSystem<Nodes> with = evaluate<Stress, Nodes>(step, step.nodes, false);
  EXPECT_GT(with.dissipated, 0);
  EXPECT_NEAR(step.work(with.residual - without.residual), with.dissipated,
              kRoundOff * (with.dissipated + largest(with.residual)));
}

TYPED_TEST(ConservingBeam, DampingDissipatesExactlyWhatIsCounted) {
  constexpr int N = TypeParam::value;
  expect_exact_dissipation<AverageStress, N>(0.2, 0);
  expect_exact_dissipation<AverageStress, N>(0, 0.2);
  expect_exact_dissipation<DiscreteGradientStress, N>(0.2, 0.1);
  expect_exact_dissipation<ExponentialMoment, N>(0, 0.2);
}

// A step that turns and moves the element rigidly strains nothing, needs no multiplier and dissipates nothing.
TYPED_TEST(ConservingBeam, RigidStepKeepsStrains) {
  constexpr int N = TypeParam::value;
  RandomSource random(8);
  RandomStep<N> step(random, 0.1);
  step.element.stiffness_damping = 0.3;
  const Quaternion turn = random.rotation(1.5);
  const Vector3 shift = random.vector();
  for (int i = 0; i < N; ++i) {
    step.nodes.end[i] = turn * step.nodes.begin[i] + shift;
    step.set_orientation(i, turn * step.begin_orientation[i]);
  }
  std::array<PointKinematics, N - 1> end;
  const ElementSystem<N> system = evaluate<DiscreteGradientStress, N>(step, step.nodes, true, &end);
  for (int k = 0; k < N - 1; ++k) EXPECT_LE(largest(end[k].strain - step.begin_points[k].strain), kRoundOff);
  EXPECT_LE(std::abs(system.dissipated), 1e-20);
  EXPECT_TRUE(system.tangent.allFinite());
  const ElementSystem<N> base = evaluate<AverageStress, N>(step, step.nodes, false);
  EXPECT_LE(largest(system.residual - base.residual), kRoundOff * largest(base.residual));
}

// Begin and end seen from a turned frame: the forces turn with it.
template <class Stress, int Nodes>
void expect_objective() {
  RandomSource random(9);
  RandomStep<Nodes> step(random, 0.4);
  step.element.stiffness_damping = 0.1;
  const ElementSystem<Nodes> before = evaluate<Stress, Nodes>(step, step.nodes, false);
  const Quaternion turn = random.rotation(3);
  for (int i = 0; i < Nodes; ++i) {
    step.nodes.begin[i] = turn * step.nodes.begin[i];
    step.nodes.end[i] = turn * step.nodes.end[i];
    step.nodes.velocity[i] = turn * step.nodes.velocity[i];
    step.begin_orientation[i] = turn * step.begin_orientation[i];
    step.set_orientation(i, turn * step.nodes.orientation[i]);
  }
  step.set_begin_points();
  const ElementSystem<Nodes> after = evaluate<Stress, Nodes>(step, step.nodes, false);
  for (int row = 0; row < 6 * Nodes; row += 3)
    EXPECT_LE((after.residual.template segment<3>(row) - turn * before.residual.template segment<3>(row)).norm(),
              kRoundOff * largest(before.residual));
}

TYPED_TEST(ConservingBeam, ForcesTurnWithTheObserver) {
  expect_objective<AverageStress, TypeParam::value>();
  expect_objective<DiscreteGradientStress, TypeParam::value>();
  expect_objective<ExponentialMoment, TypeParam::value>();
}

// At rest and undeformed nothing divides by zero.
TYPED_TEST(ConservingBeam, UndeformedElementAtRest) {
  constexpr int N = TypeParam::value;
  RandomSource random(10);
  RandomStep<N> step(random, 0.1);
  for (int i = 0; i < N; ++i) {
    step.nodes.begin[i] = step.nodes.end[i] = step.undeformed_position[i];
    step.nodes.velocity[i].setZero();
    step.begin_orientation[i] = step.undeformed_orientation[i];
    step.set_orientation(i, step.undeformed_orientation[i]);
  }
  step.set_begin_points();
  const ElementSystem<N> system = evaluate<DiscreteGradientStress, N>(step, step.nodes, true);
  EXPECT_LE(largest(system.residual), kRoundOff);
  EXPECT_TRUE(system.tangent.allFinite());
}

}  // namespace
}  // namespace flexarm
