// Tests beams of the momentum-conserving schemes, with and without an energy correction.
#include "study_schemes/momentum_beam.h"

#include "elements/kernel_checks.h"
#include "elements/tested_step.h"
#include "schemes/scheme.h"
#include "study_schemes/average_rotary.h"

namespace flexarm {
namespace {

using namespace test;

template <class Count>
class MomentumBeam : public ::testing::Test {};
TYPED_TEST_SUITE(MomentumBeam, NodeCounts);

/// A scheme on a random step, with rotary inertia at the mass points.
template <int Nodes>
struct MomentumStep {
  Scheme scheme;
  RandomStep<Nodes> step;
  std::array<PointKinematics, Nodes - 1> end;
  std::array<Matrix3, Nodes> end_rotations;
  std::array<MassPointState, Nodes> end_states;

  MomentumStep(const char* name, RandomSource& random, double size, Interpolation interpolation = Interpolation::Local)
      : scheme(*find_scheme(name)), step(random, size) {
    if (interpolation != Interpolation::Local) scheme.interpolation = interpolation;
    step.set_interpolation(
        random, scheme.interpolation,
        scheme.cayley_interpolation ? RotationParameters::TangentScaled : RotationParameters::Unscaled);
  }
  ElementSystem<Nodes> evaluate(const ElementNodes<Nodes>& nodes, bool with_tangent) {
    AverageRotary<Nodes> rotary{step.element,     nodes, scheme.beam_rotation, step.begin_mass_rotations,
                                step.mass_points, kStep};
    ElementSystem<Nodes> system;
    const auto add = [&](bool with, ElementEnergy<Nodes>* energy, ElementSystem<Nodes>& sum) {
      rotary(with, energy, sum);
    };
    momentum_beam<Nodes>(step.element, nodes, scheme, step.begin_points.data(), kStep, add, with_tangent, end.data(),
                         system);
    end_rotations = rotary.end_rotations;
    end_states = rotary.end_states;
    return system;
  }
  ElementSystem<Nodes> evaluate() { return evaluate(step.nodes, false); }

  double energy_at_begin() const {
    return step.strain_energy(step.begin_points) + kinetic_energy<Nodes>(step.element, step.nodes.velocity) +
           rotary_energy(step.mass_points);
  }
  double energy_at_end() const {
    return step.strain_energy(end) + kinetic_energy<Nodes>(step.element, velocities()) + rotary_energy(end_states);
  }
  Vector6 momenta_at_begin() const {
    return all_momenta(step.nodes.begin, step.nodes.velocity, step.begin_mass_rotations, step.mass_points);
  }
  Vector6 momenta_at_end() const { return all_momenta(step.nodes.end, velocities(), end_rotations, end_states); }

 private:
  std::array<Vector3, Nodes> velocities() const {
    return end_velocities<Nodes>(step.nodes, kStep, scheme.backward_velocity ? 1 : 2);
  }
  double rotary_energy(const std::array<MassPointState, Nodes>& states) const {
    double sum = 0;
    for (int k = 0; k < Nodes; ++k) {
      const Vector3& W = states[k].angular_velocity;
      sum += 0.5 * step.element.mass_points[k].weight * W.dot(step.element.mass_points[k].inertia * W);
    }
    return sum;
  }
  Vector6 all_momenta(const std::array<Vector3, Nodes>& position, const std::array<Vector3, Nodes>& velocity,
                      const std::array<Matrix3, Nodes>& rotations,
                      const std::array<MassPointState, Nodes>& states) const {
    Vector6 sum = momenta<Nodes>(step.element, position, velocity);
    for (int k = 0; k < Nodes; ++k)
      sum.tail<3>() += step.element.mass_points[k].weight *
                       (rotations[k] * (step.element.mass_points[k].inertia * states[k].angular_velocity));
    return sum;
  }
};

constexpr const char* kUncorrected[] = {"m1", "m2", "std"};
constexpr const char* kCorrected[] = {"beta1", "beta2", "beta1_repaired", "beta2_repaired"};
constexpr const char* kAll[] = {"m1", "m2", "std", "beta1", "beta2", "beta1_repaired", "beta2_repaired"};

template <int Nodes>
void expect_tangent(MomentumStep<Nodes>& momentum, double size) {
  SCOPED_TRACE(std::string(momentum.scheme.name) + ", size " + std::to_string(size));
  expect_consistent_tangent<Nodes>(
      momentum.step, [&](const ElementNodes<Nodes>& nodes, bool with) { return momentum.evaluate(nodes, with); }, size);
}

TYPED_TEST(MomentumBeam, Tangents) {
  constexpr int N = TypeParam::value;
  RandomSource random(1);
  for (const char* name : kUncorrected)
    for (const double damping : {0.0, 0.2})
      for (const double size : {0.05, 0.5}) {
        MomentumStep<N> momentum(name, random, size);
        momentum.step.element.stiffness_damping = momentum.step.element.mass_damping = damping;
        expect_tangent<N>(momentum, 1);
      }
}

TYPED_TEST(MomentumBeam, TangentsWithUnevenDamping) {
  constexpr int N = TypeParam::value;
  RandomSource random(1);
  for (const char* name : kUncorrected) {
    MomentumStep<N> momentum(name, random, 0.5);
    momentum.step.damp_unevenly(0.2);
    expect_tangent<N>(momentum, 1);
  }
}

TYPED_TEST(MomentumBeam, TangentsWithEnergyCorrection) {
  constexpr int N = TypeParam::value;
  RandomSource random(2);
  for (const char* name : kCorrected)
    for (const double damping : {0.0, 0.2})
      for (const double size : {0.05, 0.5}) {
        MomentumStep<N> momentum(name, random, size);
        momentum.step.element.stiffness_damping = momentum.step.element.mass_damping = damping;
        expect_tangent<N>(momentum, 2 * size);  // beta is a quotient of quadratic forms in the increments
      }
}

TYPED_TEST(MomentumBeam, TangentsWithGlobalInterpolations) {
  constexpr int N = TypeParam::value;
  RandomSource random(3);
  for (const char* name : kAll)
    for (const Interpolation interpolation :
         {Interpolation::Total, Interpolation::Incremental, Interpolation::Iterative}) {
      if (std::string_view(name) == "std") continue;  // std has its own interpolation
      MomentumStep<N> momentum(name, random, 0.5, interpolation);
      SCOPED_TRACE(static_cast<int>(interpolation));
      expect_tangent<N>(momentum, 1);
    }
}

// Increment . residual equals the change of the element's total energy plus the dissipation.
template <int Nodes>
void expect_energy_balance(const char* name, double size, double damping, RandomSource& random,
                           Interpolation interpolation = Interpolation::Local) {
  SCOPED_TRACE(std::string(name) + ", size " + std::to_string(size));
  MomentumStep<Nodes> momentum(name, random, size, interpolation);
  RandomStep<Nodes>& step = momentum.step;
  step.element.stiffness_damping = step.element.mass_damping = damping;
  const ElementSystem<Nodes> system = momentum.evaluate();
  const double before = momentum.energy_at_begin(), after = momentum.energy_at_end();
  EXPECT_NEAR(step.work(system.residual), after - before + system.dissipated,
              kRoundOff * (before + after + largest(system.residual) * size * 6 * Nodes));
}

TYPED_TEST(MomentumBeam, EnergyBalanceIsExact) {
  RandomSource random(4);
  for (const char* name : {"std", "beta1", "beta2", "beta1_repaired", "beta2_repaired"})
    for (const double size : {1e-3, 0.1, 0.6})
      for (const double damping : {0.0, 0.2}) expect_energy_balance<TypeParam::value>(name, size, damping, random);
  for (const char* name : kCorrected)
    for (const Interpolation interpolation : {Interpolation::Total, Interpolation::Incremental})
      expect_energy_balance<TypeParam::value>(name, 0.3, 0.2, random, interpolation);
}

// Resultant force and moment are the rates of the momenta, with arms in the middle of the step, or at the beginning
// (M2).
TYPED_TEST(MomentumBeam, MomentaBalance) {
  constexpr int N = TypeParam::value;
  RandomSource random(5);
  for (const char* name : kAll)
    for (const Interpolation interpolation : {Interpolation::Local, Interpolation::Total}) {
      if (std::string_view(name) == "std" && interpolation != Interpolation::Local) continue;
      SCOPED_TRACE(name);
      MomentumStep<N> momentum(name, random, 0.5, interpolation);
      momentum.step.element.stiffness_damping = 0.2;
      const ElementSystem<N> system = momentum.evaluate();
      const Vector6 rate = (momentum.momenta_at_end() - momentum.momenta_at_begin()) / kStep;
      const double end_weight = std::string_view(name) == "m2" ? 0 : 0.5;
      EXPECT_LE((resultant<N>(momentum.step.nodes, system.residual, end_weight) - rate).norm(),
                kRoundOff * largest(system.residual));
    }
}

// The work of the damping force alone equals the counted dissipation.
TYPED_TEST(MomentumBeam, DampingDissipatesExactlyWhatIsCounted) {
  constexpr int N = TypeParam::value;
  RandomSource random(6);
  for (const char* name : kAll)
    for (const double stiffness_damping : {0.0, 0.2}) {
      SCOPED_TRACE(name);
      MomentumStep<N> momentum(name, random, 0.4);
      const ElementSystem<N> without = momentum.evaluate();
      EXPECT_EQ(without.dissipated, 0);
      momentum.step.element.stiffness_damping = stiffness_damping;
      momentum.step.element.mass_damping = 0.2 - stiffness_damping;
      const ElementSystem<N> with = momentum.evaluate();
      EXPECT_GT(with.dissipated, 0);
      EXPECT_NEAR(momentum.step.work(with.residual - without.residual), with.dissipated,
                  kRoundOff * (with.dissipated + largest(with.residual)));
    }
}

// Seen from a rotated frame, the forces rotate with the frame. This holds for the local interpolation.
TYPED_TEST(MomentumBeam, ForcesTurnWithTheObserver) {
  constexpr int N = TypeParam::value;
  RandomSource random(7);
  for (const char* name : kAll) {
    if (std::string_view(name) == "std") continue;
    SCOPED_TRACE(name);
    MomentumStep<N> momentum(name, random, 0.4);
    RandomStep<N>& step = momentum.step;
    step.element.stiffness_damping = 0.1;
    const ElementSystem<N> before = momentum.evaluate();
    const Quaternion turn = random.rotation(3);
    step.turn(turn);
    const ElementSystem<N> after = momentum.evaluate();
    for (int row = 0; row < 6 * N; row += 3)
      EXPECT_LE((after.residual.template segment<3>(row) - turn * before.residual.template segment<3>(row)).norm(),
                kRoundOff * largest(before.residual));
  }
}

// For an undeformed element at rest, the correction has no direction; this causes no division by zero.
TYPED_TEST(MomentumBeam, UndeformedElementAtRest) {
  constexpr int N = TypeParam::value;
  RandomSource random(8);
  for (const char* name : kAll) {
    MomentumStep<N> momentum(name, random, 0.1);
    RandomStep<N>& step = momentum.step;
    step.begin_orientation = step.undeformed_orientation;
    for (int i = 0; i < N; ++i) {
      step.nodes.begin[i] = step.nodes.end[i] = step.undeformed_position[i];
      step.nodes.velocity[i].setZero();
      step.nodes.orientation[i] = step.undeformed_orientation[i];
      step.mass_points[i] = MassPointState();
    }
    step.interpolation = Interpolation::Local;
    step.nodes.stiffness_reference = step.nodes.mass_reference = nullptr;
    for (int i = 0; i < N; ++i) step.set_orientation(i, step.undeformed_orientation[i]);
    step.set_begin_points();
    const ElementSystem<N> system = momentum.evaluate(step.nodes, true);
    EXPECT_LE(largest(system.residual), kRoundOff);
    EXPECT_TRUE(system.tangent.allFinite());
  }
}

}  // namespace
}  // namespace flexarm
