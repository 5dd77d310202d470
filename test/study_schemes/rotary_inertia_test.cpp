// Tests the rotary inertia of beams at the mass points.
#include "study_schemes/rotary_inertia.h"

#include "elements/kernel_checks.h"
#include "elements/tested_step.h"

namespace flexarm {
namespace {

using namespace test;

template <class Count>
class RotaryInertia : public ::testing::Test {};
TYPED_TEST_SUITE(RotaryInertia, NodeCounts);

/// System of an element. `rate(k, begin, end)`: rate of mass point k, from its rotations at the beginning and at the
/// end.
template <int Nodes, class Rate>
ElementSystem<Nodes> rotary_system(const RandomStep<Nodes>& step, const ElementNodes<Nodes>& nodes, const Rate& rate,
                                   bool with_tangent, std::array<Matrix3, Nodes>* rotations = nullptr) {
  ElementSystem<Nodes> system;
  system.set_zero();
  for_each_mass_point(
      step.element, nodes, with_tangent,
      [&](int k, const InterpolatedRotation<double>& point, const GeneralisedShapeFunctions<Nodes>& generalised) {
        add_rotary_rate(step.element, k, rate(k, step.begin_mass_rotations[k], point.rotation), generalised,
                        with_tangent, system);
        if (rotations) (*rotations)[k] = point.rotation;
      });
  return system;
}

RotaryRate average_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end, const MassPointState& state,
                        bool tangent_scaled, bool with_derivative = true) {
  const Quaternion relative = so3::quaternion_from_matrix(end * begin.transpose());
  const Vector3 unscaled = so3::log(relative), scaled = cayley::increment(relative);
  return tangent_scaled ? average_rotary_rate(inertia, begin, end, scaled, cayley::inverse_tangent(scaled), state,
                                              kStep, with_derivative)
                        : average_rotary_rate(inertia, begin, end, unscaled, so3::inverse_tangent(unscaled), state,
                                              kStep, with_derivative);
}

const InterpolationChoice kInterpolations[] = {
    {Interpolation::Local}, {Interpolation::Total}, {Interpolation::Incremental}};

TYPED_TEST(RotaryInertia, TangentOfAverageRule) {
  constexpr int N = TypeParam::value;
  for (const bool tangent_scaled : {false, true})
    for_each_interpolation<N>(1, kInterpolations, [&](const RandomStep<N>& step) {
      const auto rate = [&](int k, const Matrix3& begin, const Matrix3& end) {
        return average_rate(step.element.mass_points[k].inertia, begin, end, step.mass_points[k], tangent_scaled);
      };
      expect_consistent_tangent<N>(
          step, [&](const ElementNodes<N>& nodes, bool with) { return rotary_system<N>(step, nodes, rate, with); });
    });
}

TYPED_TEST(RotaryInertia, TangentOfNewmark) {
  constexpr int N = TypeParam::value;
  for_each_interpolation<N>(2, kInterpolations, [&](const RandomStep<N>& step) {
    const auto rate = [&](int k, const Matrix3& begin, const Matrix3& end) {
      return newmark_rotary_rate(step.element.mass_points[k].inertia, begin, end, step.mass_points[k], kNewmarkRule);
    };
    expect_consistent_tangent<N>(
        step, [&](const ElementNodes<N>& nodes, bool with) { return rotary_system<N>(step, nodes, rate, with); });
  });
}

TYPED_TEST(RotaryInertia, TangentOfMomentumRate) {
  constexpr int N = TypeParam::value;
  for_each_interpolation<N>(3, kInterpolations, [&](const RandomStep<N>& step) {
    const auto rate = [&](int k, const Matrix3& begin, const Matrix3& end) {
      const Vector3 begin_rate = (k + 1) * Vector3(0.3, -0.2, 0.5);
      return momentum_rotary_rate(step.element.mass_points[k].inertia, begin, end, step.mass_points[k], begin_rate,
                                  kNewmarkRule);
    };
    expect_consistent_tangent<N>(
        step, [&](const ElementNodes<N>& nodes, bool with) { return rotary_system<N>(step, nodes, rate, with); });
  });
}

TYPED_TEST(RotaryInertia, AngularMomentumBalance) {
  constexpr int N = TypeParam::value;
  RandomSource random(3);
  const RandomStep<N> step(random, 0.5);
  std::array<MassPointState, N> after;
  const auto rate = [&](int k, const Matrix3& begin, const Matrix3& end) {
    const RotaryRate r = average_rate(step.element.mass_points[k].inertia, begin, end, step.mass_points[k], false);
    after[k] = r.end;
    return r;
  };
  std::array<Matrix3, N> end;
  const ElementSystem<N> system = rotary_system<N>(step, step.nodes, rate, false, &end);
  Vector3 moment = Vector3::Zero(), expected = moment;
  for (int i = 0; i < N; ++i) moment += system.residual.template segment<3>(6 * i + 3);
  for (int k = 0; k < N; ++k) {
    const Matrix3& begin = step.begin_mass_rotations[k];
    const Matrix3& J = step.element.mass_points[k].inertia;
    expected += step.element.mass_points[k].weight / kStep *
                (end[k] * (J * after[k].angular_velocity) - begin * (J * step.mass_points[k].angular_velocity));
    // (W_0 + W_1) h / 2 is the material rotation increment over the step.
    const Vector3 mean = 0.5 * (after[k].angular_velocity + step.mass_points[k].angular_velocity);
    EXPECT_LE((kStep * mean - begin.transpose() * so3::log(Matrix3(end[k] * begin.transpose()))).norm(), 1e-13);
  }
  EXPECT_LE((moment - expected).norm(), 1e-12 * largest(system.residual));
}

/// A section with random inertia and motion over a step.
struct SectionStep {
  Matrix3 inertia, begin, end;
  MassPointState state;
  explicit SectionStep(RandomSource& random)
      : inertia(random.positive_definite<3>()),
        begin(random.rotation(3).toRotationMatrix()),
        end(so3::exp(Vector3(0.6 * random.vector())) * begin),
        state{random.vector(), random.vector()} {}
  Matrix3 turned_end(int axis, double h) const { return so3::exp(Vector3(h * Vector3::Unit(axis))) * end; }
};

TEST(RotaryRate, EnergyGradientOfAverageRule) {
  RandomSource random(5);
  const SectionStep s(random);
  for (const bool tangent_scaled : {false, true}) {
    const RotaryRate rate = average_rate(s.inertia, s.begin, s.end, s.state, tangent_scaled);
    const auto energy = [&](const Matrix3& end) {
      const Vector3 W = average_rate(s.inertia, s.begin, end, s.state, tangent_scaled, false).end.angular_velocity;
      return 0.5 * W.dot(s.inertia * W);
    };
    for (int axis = 0; axis < 3; ++axis) {
      const double slope = scalar_difference([&](double h) { return energy(s.turned_end(axis, h)); });
      EXPECT_NEAR(rate.energy_gradient[axis], slope,
                  difference_tolerance * std::max(energy(s.end), largest(rate.energy_gradient)));
    }
  }
}

// The work of the momentum rate over the tangent-scaled increment is exactly the change of energy.
TEST(RotaryRate, WorkOfTangentScaledIncrementIsTheChangeOfEnergy) {
  RandomSource random(6);
  const SectionStep s(random);
  const RotaryRate rate = average_rate(s.inertia, s.begin, s.end, s.state, true, false);
  const auto energy = [&](const Vector3& W) { return 0.5 * W.dot(s.inertia * W); };
  const double after = energy(rate.end.angular_velocity), before = energy(s.state.angular_velocity);
  const Vector3 increment = cayley::increment(so3::quaternion_from_matrix(s.end * s.begin.transpose()));
  EXPECT_NEAR(increment.dot(rate.moment), after - before, 1e-13 * (after + before));
}

// Meaning of the momentum-rate form: l_1 = l_0 + h ((1 - gamma) dl_0 + gamma dl_1), with Newmark's velocities.
TEST(RotaryRate, MomentumRateFollowsNewmarksRule) {
  RandomSource random(7);
  const SectionStep s(random);
  const Vector3 before = random.vector();
  const RotaryRate rate = momentum_rotary_rate(s.inertia, s.begin, s.end, s.state, before, kNewmarkRule);
  const RotaryRate newmark = newmark_rotary_rate(s.inertia, s.begin, s.end, s.state, kNewmarkRule);
  EXPECT_EQ(rate.end.angular_velocity, newmark.end.angular_velocity);
  EXPECT_EQ(rate.end.angular_acceleration, newmark.end.angular_acceleration);
  const Vector3 change =
      s.end * (s.inertia * rate.end.angular_velocity) - s.begin * (s.inertia * s.state.angular_velocity);
  EXPECT_LE((kStep * ((1 - kNewmarkRule.gamma) * before + kNewmarkRule.gamma * rate.moment) - change).norm(),
            1e-13 * change.norm());
}

// A steady spin about a principal axis needs no moment, and stays constant.
TEST(RotaryRate, SteadySpinAboutAPrincipalAxis) {
  const Matrix3 inertia = Vector3(1, 2, 3).asDiagonal();
  const double speed = 1.7;
  RandomSource random(4);
  const Matrix3 begin = random.rotation(3).toRotationMatrix();
  const Matrix3 end = begin * so3::exp_quaternion(Vector3(0, speed * kStep, 0)).toRotationMatrix();
  const MassPointState state{Vector3(0, speed, 0), Vector3::Zero()};
  const RotaryRate newmark = newmark_rotary_rate(inertia, begin, end, state, kNewmarkRule);
  EXPECT_LE(newmark.moment.norm(), 1e-12);
  EXPECT_LE((newmark.end.angular_velocity - state.angular_velocity).norm(), 1e-13);
  const Vector3 increment = so3::log(Matrix3(end * begin.transpose()));
  const RotaryRate average =
      average_rotary_rate(inertia, begin, end, increment, so3::inverse_tangent(increment), state, kStep);
  EXPECT_LE(average.moment.norm(), 1e-12);
  EXPECT_LE((average.end.angular_velocity - state.angular_velocity).norm(), 1e-13);
}

}  // namespace
}  // namespace flexarm
