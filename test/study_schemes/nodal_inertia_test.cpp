// Tests the inertia and mass-proportional damping of rigid bodies at nodes, for all schemes.
#include "study_schemes/nodal_inertia.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "elements/tested_step.h"
#include "schemes/scheme.h"
#include "support/node_poses.h"

namespace flexarm {
namespace {

using namespace test;

struct NodeSample {
  NodePose begin, end;
  NodeState state;
  Vector3 increment;
  Matrix3 inverse_tangent;
  Vector3 momentum_rate;

  NodeSample(RandomSource& random, double size) {
    begin = node_at(random.vector(), random.rotation(3));
    state = {begin.position, begin.orientation, random.vector(), random.vector(), random.vector(), random.vector()};
    set_end(begin.position + size * random.vector(),
            so3::exp_quaternion(Vector3(size * random.vector())) * begin.orientation);
    momentum_rate = random.vector();
  }
  void set_end(const Vector3& position, const Quaternion& orientation) {
    end = node_at(position, orientation.normalized());
    increment = cayley::increment(begin.orientation, end.orientation);
    inverse_tangent = cayley::inverse_tangent(increment);
  }
  NodeSample perturbed(int column, double h) const {
    NodeSample out = *this;
    if (column < 3)
      out.set_end(end.position + h * Vector3::Unit(column), end.orientation);
    else
      out.set_end(end.position, so3::exp_quaternion(Vector3(h * Vector3::Unit(column - 3))) * end.orientation);
    return out;
  }
  NodeStep step() const { return {begin, end, state, increment, inverse_tangent, kStep, momentum_rate}; }
  double work(const Vector6& wrench) const {
    return wrench.head<3>().dot(end.position - begin.position) + wrench.tail<3>().dot(increment);
  }
};

NodalInertia random_inertia(RandomSource& random, bool damped) {
  NodalInertia inertia;
  inertia.mass = 1.7;
  inertia.rotary = random.positive_definite<3>();
  inertia.beam_rotary = random.positive_definite<3>();
  if (damped) inertia.rotary_damping = 0.3 * random.positive_definite<3>();
  return inertia;
}

class NodalInertiaTest : public ::testing::TestWithParam<Scheme> {};
class ConservingNodalInertia : public NodalInertiaTest {};
class TangentScaledNodalInertia : public NodalInertiaTest {};
class NewmarkNodalInertia : public NodalInertiaTest {};

/// Compares the tangent of evaluate(step) -> NodalAction with differences of its residual.
template <class Evaluate>
void expect_tangent(const NodeSample& sample, const Evaluate& evaluate) {
  const NodalAction action = evaluate(sample.step());
  Matrix6 tangent = Matrix6::Zero();
  tangent.topLeftCorner<3, 3>().diagonal().setConstant(action.translational);
  tangent.bottomRightCorner<3, 3>() = action.rotational;
  for (int column = 0; column < 6; ++column) {
    const Vector6 expected = difference([&](double h) {
      const NodeSample moved = sample.perturbed(column, h);
      return evaluate(moved.step()).residual;
    });
    EXPECT_LE(largest(tangent.col(column) - expected), difference_tolerance * largest(tangent));
  }
}

TEST_P(NodalInertiaTest, Tangents) {
  RandomSource random(1);
  for (const double size : {0.01, 0.6}) {
    const NodalInertia inertia = random_inertia(random, true);
    const NodeSample sample(random, size);
    expect_tangent(sample, [&](const NodeStep& step) { return nodal_inertia_action(inertia, GetParam(), step); });
    expect_tangent(sample, [&](const NodeStep& step) { return nodal_damping_action(inertia, GetParam(), step); });
    const NodalAction with = nodal_inertia_action(inertia, GetParam(), sample.step());
    const NodalAction without = nodal_inertia_action(inertia, GetParam(), sample.step(), false);
    EXPECT_LE(largest(with.residual - without.residual), 1e-14 * largest(with.residual));
  }
}

/// The rotary inertia at a node in this scheme.
Matrix3 nodal_rotary(const NodalInertia& inertia, const Scheme& scheme) {
  return inertia.rotary + (scheme.nodal_rotary_inertia ? inertia.beam_rotary : Matrix3::Zero());
}

// The residual belongs to the velocities at the end of the step: it contains rates of momenta, or accelerations.
TEST_P(NodalInertiaTest, BalanceWithAdvancedState) {
  RandomSource random(2);
  const Scheme& scheme = GetParam();
  const NodalInertia inertia = random_inertia(random, false);
  const Matrix3 J = nodal_rotary(inertia, scheme);
  const NodeSample sample(random, 0.6);
  const NodeState after = advanced(scheme, sample.step());
  const Vector6 residual = nodal_inertia_action(inertia, scheme, sample.step()).residual;
  const Vector3& W = after.angular_velocity;
  const Vector3 change = sample.end.rotation * (J * W) - sample.begin.rotation * (J * sample.state.angular_velocity);
  Vector6 expected;
  if (scheme.is_incremental())
    expected << inertia.mass / kStep * (after.velocity - sample.state.velocity), change / kStep;
  else if (scheme.hht != HhtForm::None)  // momentum rates follow the rule of Newmark's velocities
    expected << inertia.mass * after.acceleration,
        (change / kStep - (1 - scheme.gamma) * sample.momentum_rate) / scheme.gamma;
  else
    expected << inertia.mass * after.acceleration,
        sample.end.rotation * (W.cross(J * W) + J * after.angular_acceleration);
  EXPECT_LE(largest(residual - expected), 1e-12 * largest(expected));
  EXPECT_EQ(after.position, sample.end.position);
  EXPECT_EQ(after.orientation.coeffs(), sample.end.orientation.coeffs());
}

// The rule: (v_0 + v_1)/2 = Delta r / h and (W_0 + W_1)/2 = Omega / h; M2 has v_1 = Delta r / h.
TEST_P(ConservingNodalInertia, VelocitiesFollowTheRule) {
  const Scheme& scheme = GetParam();
  RandomSource random(3);
  const NodeSample sample(random, 0.6);
  const NodeState after = advanced(scheme, sample.step());
  const double end_weight = scheme.name == "m2" ? 1 : 0.5;
  const Vector3 velocity = (1 - end_weight) * sample.state.velocity + end_weight * after.velocity;
  EXPECT_LE((kStep * velocity - (sample.end.position - sample.begin.position)).norm(), 1e-14);
  const Vector3 increment = scheme.body_rotation == RotationRule::TangentScaled
                                ? sample.increment
                                : so3::log(sample.end.orientation * sample.begin.orientation.conjugate());
  const Vector3 spin = 0.5 * (sample.state.angular_velocity + after.angular_velocity);
  EXPECT_LE((kStep * (sample.begin.rotation * spin) - increment).norm(), 1e-14);
}

// The rule: x_1 = x_0 + h v_0 + h^2 ((1/2 - beta) a_0 + beta a_1), v_1 = v_0 + h ((1 - gamma) a_0 + gamma a_1), and the
// same for rotations.
TEST_P(NewmarkNodalInertia, VelocitiesFollowTheRule) {
  const Scheme& scheme = GetParam();
  RandomSource random(3);
  const NodeSample sample(random, 0.6);
  const NodeState &before = sample.state, after = advanced(scheme, sample.step());
  const auto expect_rule = [&](const Vector3& increment, const Vector3& v0, const Vector3& a0, const Vector3& v1,
                               const Vector3& a1) {
    const Vector3 moved = kStep * v0 + kStep * kStep * ((0.5 - scheme.beta) * a0 + scheme.beta * a1);
    EXPECT_LE((moved - increment).norm(), 1e-14);
    EXPECT_LE((v0 + kStep * ((1 - scheme.gamma) * a0 + scheme.gamma * a1) - v1).norm(), 1e-13);
  };
  expect_rule(sample.end.position - sample.begin.position, before.velocity, before.acceleration, after.velocity,
              after.acceleration);
  const Vector3 rotation = so3::log(sample.begin.orientation.conjugate() * sample.end.orientation);
  expect_rule(rotation, before.angular_velocity, before.angular_acceleration, after.angular_velocity,
              after.angular_acceleration);
}

// Only schemes with tangent-scaled increments, which joints map, may claim to conserve the energy.
TEST_P(NodalInertiaTest, EnergyIsClaimedWithTangentScaledIncrementsOnly) {
  const Scheme& scheme = GetParam();
  EXPECT_TRUE(!scheme.conserves_energy ||
              (scheme.is_incremental() && scheme.body_rotation == RotationRule::TangentScaled));
}

// With these increments, the work on a body is exactly the change of its kinetic energy.
TEST_P(TangentScaledNodalInertia, WorkIsTheChangeOfKineticEnergy) {
  const Scheme& scheme = GetParam();
  RandomSource random(4);
  const NodalInertia inertia = random_inertia(random, false);
  const Matrix3 J = nodal_rotary(inertia, scheme);
  const NodeSample sample(random, 0.8);
  const NodeState after = advanced(scheme, sample.step());
  const auto energy = [&](const NodeState& state) {
    return 0.5 * (inertia.mass * state.velocity.squaredNorm() + state.angular_velocity.dot(J * state.angular_velocity));
  };
  EXPECT_NEAR(sample.work(nodal_inertia_action(inertia, scheme, sample.step()).residual),
              energy(after) - energy(sample.state), 1e-12 * (energy(after) + energy(sample.state)));
}

// M2 loses the kinetic energy of half the velocity change.
TEST(NodalInertia, BackwardVelocityDissipates) {
  RandomSource random(5);
  const Scheme scheme = *find_scheme("m2");
  NodalInertia inertia;
  inertia.mass = 1.7;
  const NodeSample sample(random, 0.8);
  const Vector3 before = sample.state.velocity, after = advanced(scheme, sample.step()).velocity;
  const double change = 0.5 * inertia.mass * (after.squaredNorm() - before.squaredNorm());
  EXPECT_NEAR(sample.work(nodal_inertia_action(inertia, scheme, sample.step()).residual),
              change + 0.5 * inertia.mass * (after - before).squaredNorm(), 1e-13);
}

TEST_P(NodalInertiaTest, DampingDissipatesExactlyWhatIsCounted) {
  const Scheme& scheme = GetParam();
  RandomSource random(6);
  NodalInertia inertia;
  inertia.rotary_damping = random.positive_definite<3>();
  EXPECT_FALSE(inertia.empty());
  const NodeSample sample(random, 0.8);
  const NodalAction action = nodal_damping_action(inertia, scheme, sample.step());
  EXPECT_EQ(largest(action.residual.head<3>()), 0);
  EXPECT_EQ(action.translational, 0);
  EXPECT_EQ(largest(nodal_inertia_action(inertia, scheme, sample.step()).residual), 0);
  if (scheme.is_incremental()) {
    EXPECT_GT(action.dissipated, 0);
    EXPECT_NEAR(sample.work(action.residual), action.dissipated, 1e-13 * action.dissipated);
    return;
  }
  // Here the damping moment acts at the end; with HHT3, it is interpolated between the moments D W at both ends.
  const auto moment = [&](const NodePose& pose, const NodeState& state) {
    return Vector3(pose.rotation * (inertia.rotary_damping * state.angular_velocity));
  };
  const double alpha = scheme.name == "hht3" ? scheme.alpha : 0;
  const Vector3 expected =
      (1 + alpha) * moment(sample.end, advanced(scheme, sample.step())) - alpha * moment(sample.begin, sample.state);
  EXPECT_LE((action.residual.tail<3>() - expected).norm(), 1e-12 * expected.norm());
  const Vector3 turn = so3::log(sample.end.orientation * sample.begin.orientation.conjugate());
  EXPECT_NEAR(action.dissipated, expected.dot(turn), 1e-12 * expected.norm());
}

TEST(NodalInertia, AlphaBelongsToTheInterpolatedConfigurationOnly) {
  for (const Scheme& scheme : schemes()) {
    const NewmarkRule rule = newmark_rule(scheme, kStep);
    EXPECT_EQ(rule.alpha, scheme.name == "hht3" ? scheme.alpha : 0) << scheme.name;
    EXPECT_EQ(rule.step, kStep);
  }
  EXPECT_LT(find_scheme("hht3")->alpha, 0);
}

std::string scheme_name(const ::testing::TestParamInfo<Scheme>& info) {
  return std::string(info.param.name);
}

template <class Predicate>
std::vector<Scheme> schemes_where(const Predicate& suits) {
  std::vector<Scheme> suitable;
  std::copy_if(schemes().begin(), schemes().end(), std::back_inserter(suitable), suits);
  return suitable;
}

INSTANTIATE_TEST_SUITE_P(AllSchemes, NodalInertiaTest, ::testing::ValuesIn(schemes()), scheme_name);
INSTANTIATE_TEST_SUITE_P(
    AllSchemes, ConservingNodalInertia,
    ::testing::ValuesIn(schemes_where([](const Scheme& scheme) { return scheme.is_incremental(); })), scheme_name);
INSTANTIATE_TEST_SUITE_P(AllSchemes, TangentScaledNodalInertia,
                         ::testing::ValuesIn(schemes_where([](const Scheme& scheme) {
                           return scheme.is_incremental() && scheme.body_rotation == RotationRule::TangentScaled;
                         })),
                         scheme_name);
INSTANTIATE_TEST_SUITE_P(AllSchemes, NewmarkNodalInertia, ::testing::ValuesIn(schemes_where([](const Scheme& scheme) {
                           return !scheme.is_incremental();
                         })),
                         scheme_name);

}  // namespace
}  // namespace flexarm
