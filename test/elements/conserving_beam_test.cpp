// Tests beams of the energy-momentum family over a step: tangents, momenta, energy, damping.
#include "elements/conserving_beam.h"

#include "elements/conserving_kernel.h"
#include "elements/kernel_checks.h"
#include "elements/tested_step.h"

namespace flexarm {
namespace {

using namespace test;

TimeRule conserving_rule(MidFunctions mid_functions = MidFunctions::Explicit) {
  TimeRule rule;
  rule.mid_functions = mid_functions;
  return rule;
}

/// Evaluates an element with or without the energy multiplier. The multiplier is no template parameter, so that tests
/// are compiled only once.
template <int Nodes>
ElementSystem<Nodes> evaluate(bool has_multiplier, const RandomStep<Nodes>& step, const ElementNodes<Nodes>& nodes,
                              bool with_tangent, std::array<PointKinematics, Nodes - 1>* points = nullptr,
                              const TimeRule& rule = conserving_rule()) {
  std::array<PointKinematics, Nodes - 1> end;
  ElementSystem<Nodes> system;
  const bool is_symmetric = rule.mid_functions == MidFunctions::Symmetric;
  const ElementFunctions<Nodes> functions =
      is_symmetric ? functions_at<Nodes>(step.element, step.begin_orientation)
                   : functions_half_way<Nodes>(step.element, step.begin_orientation, step.nodes.increment);
  conserving_beam<Nodes>(has_multiplier, step.element, nodes, rule, functions, step.begin_points.data(), nullptr, kStep,
                         with_tangent, end.data(), nullptr, system);
  if (points) *points = end;
  return system;
}

template <class Count>
class ConservingBeam : public ::testing::Test {};
TYPED_TEST_SUITE(ConservingBeam, NodeCounts);

template <int Nodes>
void expect_tangents(bool has_multiplier, unsigned seed, bool is_damped_evenly = true) {
  RandomSource random(seed);
  for (const double damping : {0.0, 0.2})
    for (const double size : {0.05, 0.5}) {
      RandomStep<Nodes> step(random, size);
      step.element.stiffness_damping = step.element.mass_damping = damping;
      if (!is_damped_evenly) step.damp_unevenly(damping);
      expect_consistent_tangent<Nodes>(
          step,
          [&](const ElementNodes<Nodes>& nodes, bool with_tangent) {
            return evaluate<Nodes>(has_multiplier, step, nodes, with_tangent);
          },
          2 * size);  // the multiplier is a quotient of quadratic forms in the increments
    }
}

TYPED_TEST(ConservingBeam, TangentWithoutMultiplier) {
  expect_tangents<TypeParam::value>(false, 1);
}
TYPED_TEST(ConservingBeam, TangentWithMultiplier) {
  expect_tangents<TypeParam::value>(true, 2);
}

TYPED_TEST(ConservingBeam, TangentWithUnevenDamping) {
  expect_tangents<TypeParam::value>(false, 1, false);
  expect_tangents<TypeParam::value>(true, 2, false);
}

// Resultant force and moment about the origin, with the mid-step arms, equal the rates of the translational momenta.
template <int Nodes>
void expect_momentum_balance(bool has_multiplier) {
  RandomSource random(4);
  RandomStep<Nodes> step(random, 0.5);
  step.element.stiffness_damping = 0.2;
  for (const MidFunctions mid : {MidFunctions::Explicit, MidFunctions::Symmetric}) {
    const ElementSystem<Nodes> system =
        evaluate<Nodes>(has_multiplier, step, step.nodes, false, nullptr, conserving_rule(mid));
    const Vector6 rate = (momenta<Nodes>(step.element, step.nodes.end, end_velocities<Nodes>(step.nodes, kStep)) -
                          momenta<Nodes>(step.element, step.nodes.begin, step.nodes.velocity)) /
                         kStep;
    EXPECT_LE((resultant<Nodes>(step.nodes, system.residual, 0.5) - rate).norm(), kRoundOff * largest(system.residual));
  }
}

TYPED_TEST(ConservingBeam, MomentaBalance) {
  expect_momentum_balance<TypeParam::value>(false);
  expect_momentum_balance<TypeParam::value>(true);
}

TYPED_TEST(ConservingBeam, EnergyBalanceWithMultiplierIsExact) {
  constexpr int N = TypeParam::value;
  RandomSource random(5);
  for (const MidFunctions mid : {MidFunctions::Explicit, MidFunctions::Symmetric})
    for (const double size : {1e-3, 0.1, 0.8})
      for (const double damping : {0.0, 0.2}) {
        RandomStep<N> step(random, size);
        step.element.stiffness_damping = step.element.mass_damping = damping;
        std::array<PointKinematics, N - 1> end;
        const ElementSystem<N> system = evaluate<N>(true, step, step.nodes, false, &end, conserving_rule(mid));
        const double strain_change = step.strain_energy(end) - step.strain_energy(step.begin_points);
        const double kinetic_change = kinetic_energy<N>(step.element, end_velocities<N>(step.nodes, kStep)) -
                                      kinetic_energy<N>(step.element, step.nodes.velocity);
        const double scale =
            step.strain_energy(end) + step.strain_energy(step.begin_points) + largest(system.residual) * size * 6 * N;
        EXPECT_NEAR(step.work(system.residual), strain_change + kinetic_change + system.dissipated, kRoundOff * scale);
        if (damping > 0)
          EXPECT_GT(system.dissipated, 0);
        else
          EXPECT_EQ(system.dissipated, 0);
      }
}

// The energy defect of EM0 is of third order in the increments, because its test functions belong to the middle of the
// step. (Lagrange functions would give a defect of first order on a deformed element.)
TYPED_TEST(ConservingBeam, EnergyDefectWithoutMultiplierIsOfThirdOrder) {
  constexpr int N = TypeParam::value;
  // Root mean square over random steps, since the leading coefficient of a single step may happen to be small.
  const auto defect = [](double size, MidFunctions mid) {
    double sum = 0;
    for (unsigned seed = 0; seed < 30; ++seed) {
      RandomSource random(seed);  // the same increments at every size
      RandomStep<N> step(random, 0.1);
      step.element.mass.setZero();
      for (int i = 0; i < N; ++i) {
        const Vector3 turn = size * random.vector();
        step.set_orientation(i, so3::exp_quaternion(turn) * step.begin_orientation[i]);
        step.nodes.end[i] = step.nodes.begin[i] + size * random.vector();
      }
      step.set_begin_points();
      std::array<PointKinematics, N - 1> end;
      const ElementSystem<N> system = evaluate<N>(false, step, step.nodes, false, &end, conserving_rule(mid));
      sum += std::pow(step.work(system.residual) - step.strain_energy(end) + step.strain_energy(step.begin_points), 2);
    }
    return std::sqrt(sum);
  };
  for (const MidFunctions mid : {MidFunctions::Explicit, MidFunctions::Symmetric})
    EXPECT_NEAR(defect(0.02, mid) / defect(0.01, mid), 8,
                8 * 0.1);  // the next order is smaller by the factor of the increments' size
}

// Near a step that rotates the whole element by any angle, the defect of EM0 is of second order in the remaining
// motion. So the multiplier that compensates the defect has a limit as the remaining motion vanishes.
TYPED_TEST(ConservingBeam, EnergyDefectAboutARigidTurnIsOfSecondOrder) {
  constexpr int N = TypeParam::value;
  for (const double angle : {0.1, 1.0, 2.5}) {
    const auto defect = [angle](double size) {
      double sum = 0;
      for (unsigned seed = 0; seed < 30; ++seed) {
        RandomSource random(seed);
        RandomStep<N> step(random, 0.1);
        step.element.mass.setZero();
        const Quaternion turn = so3::exp_quaternion(Vector3(angle * random.vector().normalized()));
        for (int i = 0; i < N; ++i) {
          const Vector3 spin = size * random.vector();
          step.set_orientation(i, so3::exp_quaternion(spin) * turn * step.begin_orientation[i]);
          step.nodes.end[i] = turn * step.nodes.begin[i] + size * random.vector();
        }
        step.set_begin_points();
        std::array<PointKinematics, N - 1> end;
        const ElementSystem<N> system = evaluate<N>(false, step, step.nodes, false, &end);
        sum +=
            std::pow(step.work(system.residual) - step.strain_energy(end) + step.strain_energy(step.begin_points), 2);
      }
      return std::sqrt(sum);
    };
    const double rest = defect(0);
    EXPECT_LT(rest, kRoundOff * 30);
    EXPECT_NEAR(defect(2e-4) / defect(1e-4), 4, 0.1) << "turned by " << angle;
  }
}

// The work of the damping force alone equals the counted dissipation.
template <int Nodes>
void expect_exact_dissipation(bool has_multiplier, double stiffness_damping, double mass_damping, bool is_even = true) {
  RandomSource random(7);
  RandomStep<Nodes> step(random, 0.4);
  const ElementSystem<Nodes> without = evaluate<Nodes>(has_multiplier, step, step.nodes, false);
  step.element.stiffness_damping = stiffness_damping;
  step.element.mass_damping = mass_damping;
  if (!is_even) step.damp_unevenly(stiffness_damping);
  const ElementSystem<Nodes> with = evaluate<Nodes>(has_multiplier, step, step.nodes, false);
  EXPECT_GT(with.dissipated, 0);
  EXPECT_NEAR(step.work(with.residual - without.residual), with.dissipated,
              kRoundOff * (with.dissipated + largest(with.residual)));
}

TYPED_TEST(ConservingBeam, DampingDissipatesExactlyWhatIsCounted) {
  constexpr int N = TypeParam::value;
  expect_exact_dissipation<N>(false, 0.2, 0);
  expect_exact_dissipation<N>(false, 0, 0.2);
  expect_exact_dissipation<N>(true, 0.2, 0.1);
  expect_exact_dissipation<N>(true, 0.2, 0.1, false);
}

// A step of rigid motion gives no strain, needs no multiplier and dissipates nothing.
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
  const ElementSystem<N> system = evaluate<N>(true, step, step.nodes, true, &end);
  for (int k = 0; k < N - 1; ++k) EXPECT_LE(largest(end[k].strain - step.begin_points[k].strain), kRoundOff);
  EXPECT_LE(std::abs(system.dissipated), 1e-20);
  EXPECT_TRUE(system.tangent.allFinite());
  const ElementSystem<N> base = evaluate<N>(false, step, step.nodes, false);
  EXPECT_LE(largest(system.residual - base.residual), kRoundOff * largest(base.residual));
}

// If the step is seen from a rotated frame, the forces rotate with the frame.
template <int Nodes>
void expect_objective(bool has_multiplier) {
  RandomSource random(9);
  RandomStep<Nodes> step(random, 0.4);
  step.element.stiffness_damping = 0.1;
  const ElementSystem<Nodes> before = evaluate<Nodes>(has_multiplier, step, step.nodes, false);
  const Quaternion turn = random.rotation(3);
  step.turn(turn);
  const ElementSystem<Nodes> after = evaluate<Nodes>(has_multiplier, step, step.nodes, false);
  for (int row = 0; row < 6 * Nodes; row += 3)
    EXPECT_LE((after.residual.template segment<3>(row) - turn * before.residual.template segment<3>(row)).norm(),
              kRoundOff * largest(before.residual));
}

TYPED_TEST(ConservingBeam, ForcesTurnWithTheObserver) {
  expect_objective<TypeParam::value>(false);
  expect_objective<TypeParam::value>(true);
}

// An undeformed element at rest causes no division by zero.
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
  const ElementSystem<N> system = evaluate<N>(true, step, step.nodes, true);
  EXPECT_LE(largest(system.residual), kRoundOff);
  EXPECT_TRUE(system.tangent.allFinite());
}

// The tangent neglects the variation of symmetric middle functions. So it equals the tangent with the same functions
// given as constants.
template <int Nodes>
void expect_average_functions(bool has_multiplier) {
  RandomSource random(11);
  RandomStep<Nodes> step(random, 0.4);
  step.element.stiffness_damping = 0.1;
  ElementFunctions<Nodes> average = functions_at<Nodes>(step.element, step.begin_orientation);
  const ElementFunctions<Nodes> after = functions_at<Nodes>(step.element, step.nodes.orientation);
  for (int k = 0; k < Nodes - 1; ++k)
    for (int i = 0; i < Nodes; ++i) {
      average[k].values[i] = 0.5 * (average[k].values[i] + after[k].values[i]);
      average[k].derivatives[i] = 0.5 * (average[k].derivatives[i] + after[k].derivatives[i]);
    }
  std::array<PointKinematics, Nodes - 1> end;
  ElementSystem<Nodes> given;
  conserving_beam<Nodes>(has_multiplier, step.element, step.nodes, conserving_rule(), average, step.begin_points.data(),
                         nullptr, kStep, true, end.data(), nullptr, given);
  for (const bool with_tangent : {false, true}) {
    const ElementSystem<Nodes> symmetric = evaluate<Nodes>(has_multiplier, step, step.nodes, with_tangent, nullptr,
                                                           conserving_rule(MidFunctions::Symmetric));
    EXPECT_LE(largest(symmetric.residual - given.residual), kRoundOff * largest(given.residual));
    if (with_tangent) {
      EXPECT_LE(largest(symmetric.tangent - given.tangent), kRoundOff * largest(given.tangent));
    }
  }
}

TYPED_TEST(ConservingBeam, SymmetricFunctionsAreThoseOfBothEnds) {
  expect_average_functions<TypeParam::value>(false);
  expect_average_functions<TypeParam::value>(true);
}

// A step back from the end with the velocities at the end is the same step, and has the same forces.
template <int Nodes>
void expect_time_reversible(bool has_multiplier) {
  RandomSource random(12);
  RandomStep<Nodes> step(random, 0.5);
  const TimeRule rule = conserving_rule(MidFunctions::Symmetric);
  std::array<PointKinematics, Nodes - 1> end, begin;
  const ElementSystem<Nodes> forward = evaluate<Nodes>(has_multiplier, step, step.nodes, false, &end, rule);

  ElementNodes<Nodes> nodes = step.nodes;
  std::swap(nodes.begin, nodes.end);
  nodes.velocity = end_velocities<Nodes>(step.nodes, kStep);
  nodes.orientation = step.begin_orientation;
  for (int i = 0; i < Nodes; ++i) {
    nodes.increment[i] = cayley::increment(step.nodes.orientation[i], step.begin_orientation[i]);
    nodes.increment_inverse_tangent[i] = cayley::inverse_tangent(nodes.increment[i]);
  }
  const ElementFunctions<Nodes> functions = functions_at<Nodes>(step.element, step.nodes.orientation);
  ElementSystem<Nodes> backward;
  conserving_beam<Nodes>(has_multiplier, step.element, nodes, rule, functions, end.data(), nullptr, -kStep, false,
                         begin.data(), nullptr, backward);
  EXPECT_LE(largest(backward.residual - forward.residual), kRoundOff * largest(forward.residual));
  for (int k = 0; k < Nodes - 1; ++k) EXPECT_LE(largest(begin[k].strain - step.begin_points[k].strain), kRoundOff);
}

TYPED_TEST(ConservingBeam, SymmetricFunctionsMakeStepsReversible) {
  expect_time_reversible<TypeParam::value>(false);
  expect_time_reversible<TypeParam::value>(true);
}

}  // namespace
}  // namespace flexarm
