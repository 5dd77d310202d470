// Rigid bodies at nodes.
#include "flexarm/elements/nodal_inertia.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "flexarm/integrators/scheme.h"

namespace flexarm {
namespace {

using namespace test;

constexpr double kStep = 0.3;

struct NodeSample {
  NodePose begin, end;
  NodeState state;
  Vector3 increment;
  Matrix3 inverse_tangent;

  NodeSample(RandomSource& random, double size) {
    begin = pose(random.vector(), random.rotation(3));
    state = {begin.position, begin.orientation, random.vector(), random.vector(), random.vector(), random.vector()};
    set_end(begin.position + size * random.vector(),
            so3::exp_quaternion(Vector3(size * random.vector())) * begin.orientation);
  }
  static NodePose pose(const Vector3& position, const Quaternion& orientation) {
    return {position, orientation, orientation.toRotationMatrix()};
  }
  void set_end(const Vector3& position, const Quaternion& orientation) {
    end = pose(position, orientation.normalized());
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
  NodeStep step() const { return {begin, end, state, increment, inverse_tangent, kStep}; }
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

class NodalInertiaAction : public ::testing::TestWithParam<Scheme> {};

TEST_P(NodalInertiaAction, Tangent) {
  RandomSource random(1);
  for (const bool damped : {false, true})
    for (const double size : {0.01, 0.6}) {
      const NodalInertia inertia = random_inertia(random, damped);
      const NodeSample sample(random, size);
      const flexarm::NodalInertiaAction action = nodal_inertia_action(inertia, GetParam(), sample.step());
      Matrix6 tangent = Matrix6::Zero();
      tangent.topLeftCorner<3, 3>().diagonal().setConstant(action.translational);
      tangent.bottomRightCorner<3, 3>() = action.rotational;
      for (int column = 0; column < 6; ++column) {
        const Vector6 expected = difference([&](double h) {
          const NodeSample moved = sample.perturbed(column, h);
          return nodal_inertia_action(inertia, GetParam(), moved.step()).residual;
        });
        EXPECT_LE(largest(tangent.col(column) - expected), difference_tolerance * largest(tangent));
      }
    }
}

// The residual belongs to the velocities that the step ends with: momentum rates, or accelerations.
TEST_P(NodalInertiaAction, BalanceWithAdvancedState) {
  RandomSource random(2);
  const Scheme& scheme = GetParam();
  const NodalInertia inertia = random_inertia(random, false);
  const Matrix3 J = inertia.rotary + (scheme.nodal_rotary_inertia ? inertia.beam_rotary : Matrix3::Zero());
  const NodeSample sample(random, 0.6);
  const NodeState after = advanced(scheme, sample.step());
  const Vector6 residual = nodal_inertia_action(inertia, scheme, sample.step()).residual;
  Vector6 expected;
  if (scheme.is_incremental()) {
    expected << inertia.mass * (after.velocity - sample.state.velocity),
        sample.end.rotation * (J * after.angular_velocity) -
            sample.begin.rotation * (J * sample.state.angular_velocity);
    expected /= kStep;
  } else {
    const Vector3& W = after.angular_velocity;
    expected << inertia.mass * after.acceleration,
        sample.end.rotation * (W.cross(J * W) + J * after.angular_acceleration);
  }
  EXPECT_LE(largest(residual - expected), 1e-12 * largest(expected));
  EXPECT_EQ(after.position, sample.end.position);
}

// With tangent-scaled increments the work on a body is exactly the change of its kinetic energy.
TEST_P(NodalInertiaAction, EnergyBalanceOfTangentScaledSchemes) {
  const Scheme& scheme = GetParam();
  if (!scheme.is_incremental() || scheme.rotation != RotationRule::TangentScaled) return;
  RandomSource random(3);
  const NodalInertia inertia = random_inertia(random, false);
  const Matrix3 J = inertia.rotary + inertia.beam_rotary;
  const NodeSample sample(random, 0.8);
  const NodeState after = advanced(scheme, sample.step());
  const auto energy = [&](const NodeState& state) {
    return 0.5 * (inertia.mass * state.velocity.squaredNorm() + state.angular_velocity.dot(J * state.angular_velocity));
  };
  EXPECT_NEAR(sample.work(nodal_inertia_action(inertia, scheme, sample.step()).residual),
              energy(after) - energy(sample.state), 1e-12 * energy(after));
}

TEST_P(NodalInertiaAction, DampingDissipatesExactlyWhatIsCounted) {
  const Scheme& scheme = GetParam();
  RandomSource random(4);
  NodalInertia inertia;
  inertia.rotary_damping = random.positive_definite<3>();
  EXPECT_FALSE(inertia.empty());
  const NodeSample sample(random, 0.8);
  const flexarm::NodalInertiaAction action = nodal_inertia_action(inertia, scheme, sample.step());
  if (!scheme.is_incremental()) return;
  EXPECT_GT(action.dissipated, 0);
  EXPECT_NEAR(sample.work(action.residual), action.dissipated, 1e-13 * action.dissipated);
}

INSTANTIATE_TEST_SUITE_P(AllSchemes, NodalInertiaAction, ::testing::ValuesIn(schemes()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace flexarm
