// Rotary inertia of beams at the mass points.
#include "flexarm/elements/rotary_inertia.h"

#include "elements/kernel_checks.h"

namespace flexarm {
namespace {

using namespace test;

constexpr double kStep = 0.3;
constexpr NewmarkRule kRule{0.3025, 0.6, kStep};

template <class Count>
class RotaryInertia : public ::testing::Test {};
TYPED_TEST_SUITE(RotaryInertia, NodeCounts);

template <int Nodes>
struct Motion {
  std::array<MassPointState, Nodes> states;
  explicit Motion(RandomSource& random) {
    for (MassPointState& state : states) state = {random.vector(), random.vector()};
  }
};

template <int Nodes, class Rate>
ElementSystem<Nodes> evaluate(const RandomStep<Nodes>& step, const ElementNodes<Nodes>& nodes, const Rate& rate,
                              bool with_tangent, std::array<Matrix3, Nodes>* rotations = nullptr) {
  ElementSystem<Nodes> system;
  system.set_zero();
  std::array<Matrix3, Nodes> end;
  add_rotary_inertia<Nodes>(step.element, nodes, step.begin_mass_rotations.data(), rate, with_tangent, end.data(),
                            system);
  if (rotations) *rotations = end;
  return system;
}

TYPED_TEST(RotaryInertia, TangentOfAverageRule) {
  constexpr int N = TypeParam::value;
  RandomSource random(1);
  const RandomStep<N> step(random, 0.5);
  const Motion<N> motion(random);
  for (const bool tangent_scaled : {false, true}) {
    const auto rate = [&](int k, const Matrix3& begin, const Matrix3& end) {
      const Matrix3 relative = end * begin.transpose();
      const Vector3 unscaled = so3::log(relative), scaled = cayley::increment(so3::quaternion_from_matrix(relative));
      return tangent_scaled ? average_rotary_rate(step.element.inertia, begin, end, scaled,
                                                  cayley::inverse_tangent(scaled), motion.states[k], kStep)
                            : average_rotary_rate(step.element.inertia, begin, end, unscaled,
                                                  so3::inverse_tangent(unscaled), motion.states[k], kStep);
    };
    expect_consistent_tangent<N>(
        step, [&](const ElementNodes<N>& nodes, bool with) { return evaluate<N>(step, nodes, rate, with); });
  }
}

TYPED_TEST(RotaryInertia, TangentOfNewmark) {
  constexpr int N = TypeParam::value;
  RandomSource random(2);
  const RandomStep<N> step(random, 0.5);
  const Motion<N> motion(random);
  const auto rate = [&](int k, const Matrix3& begin, const Matrix3& end) {
    return newmark_rotary_rate(step.element.inertia, begin, end, motion.states[k], kRule);
  };
  expect_consistent_tangent<N>(
      step, [&](const ElementNodes<N>& nodes, bool with) { return evaluate<N>(step, nodes, rate, with); });
}

TYPED_TEST(RotaryInertia, AngularMomentumBalance) {
  constexpr int N = TypeParam::value;
  RandomSource random(3);
  const RandomStep<N> step(random, 0.5);
  const Motion<N> motion(random);
  std::array<MassPointState, N> after;
  const auto rate = [&](int k, const Matrix3& begin, const Matrix3& end) {
    const Vector3 increment = so3::log(Matrix3(end * begin.transpose()));
    const RotaryRate r = average_rotary_rate(step.element.inertia, begin, end, increment,
                                             so3::inverse_tangent(increment), motion.states[k], kStep);
    after[k] = r.end;
    return r;
  };
  std::array<Matrix3, N> end;
  const ElementSystem<N> system = evaluate<N>(step, step.nodes, rate, false, &end);
  Vector3 moment = Vector3::Zero(), expected = moment;
  for (int i = 0; i < N; ++i) moment += system.residual.template segment<3>(6 * i + 3);
  for (int k = 0; k < N; ++k) {
    const Matrix3& begin = step.begin_mass_rotations[k];
    const Matrix3& J = step.element.inertia;
    expected += step.element.mass_points[k].weight / kStep *
                (end[k] * (J * after[k].angular_velocity) - begin * (J * motion.states[k].angular_velocity));
    // (W_0 + W_1) / 2 is the material increment over the step.
    const Vector3 mean = 0.5 * (after[k].angular_velocity + motion.states[k].angular_velocity);
    EXPECT_LE((kStep * mean - begin.transpose() * so3::log(Matrix3(end[k] * begin.transpose()))).norm(), 1e-13);
  }
  EXPECT_LE((moment - expected).norm(), 1e-12 * largest(system.residual));
}

// A steady spin about a principal axis needs no moment and stays what it is.
TEST(RotaryRate, SteadySpinAboutAPrincipalAxis) {
  const Matrix3 inertia = Vector3(1, 2, 3).asDiagonal();
  const double speed = 1.7;
  RandomSource random(4);
  const Matrix3 begin = random.rotation(3).toRotationMatrix();
  const Matrix3 end = begin * so3::exp_quaternion(Vector3(0, speed * kStep, 0)).toRotationMatrix();
  const MassPointState state{Vector3(0, speed, 0), Vector3::Zero()};
  const RotaryRate newmark = newmark_rotary_rate(inertia, begin, end, state, kRule);
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
