// Tests motions whose rate jumps against closed forms: the rest of the mechanism is struck, rates do not alternate
// afterwards, and dry friction loses nothing.
#include <fmt/format.h>

#include "reference/dynamics_runs.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

constexpr double kCart = 1.5, kBlock = 2.0, kRate = 0.6, kFriction = 3.0;
constexpr double kStep = 1e-3;

/// A cart on a rail along x follows `motion`.
SceneBuilder cart(const std::string& motion) {
  SceneBuilder b;
  b.body("cart", kCart, {0, 0, 0}, Matrix3::Identity());
  b.joint("rail", JointKind::Prismatic, "world", "cart", {0, 0, 0}, {1, 0, 0});
  b.scene.motions.push_back({"rail", TimeFunction::parse(motion), {}});
  return b;
}

/// A block slides on the cart along x, with dry friction.
SceneBuilder block_on_cart(const std::string& motion) {
  SceneBuilder b = cart(motion);
  b.scene.gravity.setZero();
  b.body("block", kBlock, {0, 0, 0}, Matrix3::Identity());
  scene::JointDescription& bed = b.joint("bed", JointKind::Prismatic, "cart", "block", {0, 0, 0}, {1, 0, 0});
  bed.friction = kFriction;
  bed.friction_law.law = scene::FrictionDescription::Law::Coulomb;
  return b;
}

/// `before`: the account at the start.
void expect_account(const Simulation& simulation, double before, double scale) {
  EXPECT_NEAR(energy_account(simulation), before, 1e-13 * scale);
}

class MotionKinks : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Schemes, MotionKinks,
                         testing::Values("em", "em0", "em_symmetric", "em4", "edmc1", "edmc2", "m1", "std"));
/// Those that have the law `coulomb`, which needs steps forwards.
class MotionKinksWithFriction : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Schemes, MotionKinksWithFriction,
                         testing::Values("em", "em0", "em_symmetric", "edmc1", "edmc2", "m1", "std"));

// The block stays behind at the rate v, and friction F stops it after the way v^2 m / 2F.
TEST_P(MotionKinksWithFriction, FrictionBehindAJumpOfTheRate) {
  const double way = kRate * kRate * kBlock / (2 * kFriction);
  for (const char* motion : {"0.6*max(0, t - 0.4)", "0:0 0.4:0 1.4:0.6"}) {
    Simulation simulation(block_on_cart(motion).scene, options(GetParam(), kStep));
    run(simulation, 1000);
    // The block comes to rest within a step, in which friction acts too long or too short.
    EXPECT_NEAR(simulation.position(1), -way, kFriction / kBlock * kStep * kStep) << motion;
    EXPECT_NEAR(simulation.velocity(1), 0, 1e-9);
    EXPECT_NEAR(simulation.energies().dissipated, kFriction * way, kFriction * kFriction / kBlock * kStep * kStep);
    expect_account(simulation, 0, kCart + kBlock);
  }
}

// A pendulum of a point mass hangs from the cart. At the jump the mass stays where it is, so that its angle has the
// rate of the cart over the length. Afterwards rates change by what forces do in a step, and not from step to step.
TEST_P(MotionKinks, StrikeWhatTheyCarry) {
  constexpr double kLength = 0.7;
  SceneBuilder b = cart("0:0 0.4:0 1.4:0.6");
  b.scene.gravity = {0, 0, -kGravity};
  b.body("bob", kBlock, {0, 0, -kLength}, Matrix3::Zero());
  b.joint("hinge", JointKind::Revolute, "cart", "bob", {0, 0, 0}, kAcross);
  Simulation simulation(b.scene, options(GetParam(), kStep));
  const double before = energy_account(simulation);
  run(simulation, 400);
  EXPECT_NEAR(simulation.velocity(1), 0, 1e-12);
  double last = kRate / kLength;  // about +y the bob goes to -x where the angle grows
  run(simulation, 100, [&] {
    const double now = state_of(simulation).nodes.back().angular_velocity.y();
    ASSERT_NEAR(now, last, 1.01 * kGravity / kLength * (simulation.time() - 0.4) * kRate / kLength * kStep + 1e-7);
    last = now;
  });
  expect_account(simulation, before, 20);
}

// Within a step the motion's rate is wrong until the step ends, so that the way is wrong by at most that of a step.
TEST_P(MotionKinksWithFriction, WithinAStep) {
  const double way = kRate * kRate * kBlock / (2 * kFriction);
  for (const char* start : {"0.40025", "0.4005", "0.4009"}) {
    Simulation simulation(block_on_cart(fmt::format("0.6*max(0, t - {})", start)).scene, options(GetParam(), kStep));
    run(simulation, 1000);
    EXPECT_NEAR(simulation.position(1), -way, kRate * kStep) << start;
    expect_account(simulation, 0, kCart + kBlock);
  }
}

// Points of a table on a smooth curve are kinks, too. A smooth function is never struck: its run has the bits of one
// that may have no corners.
TEST(MotionKink, NoneInSmoothMotion) {
  for (const char* motion : {"0.3*sin(3*t)", "0.05*t*t*t"}) {
    Simulation plain(block_on_cart(motion).scene, options("em", kStep));
    Simulation branched(block_on_cart(fmt::format("t < 9 ? {} : 0", motion)).scene, options("em", kStep));
    run(plain, 1000, [&] {
      ASSERT_TRUE(branched.step().converged);
      ASSERT_EQ(plain.position(1), branched.position(1)) << plain.time();
    });
  }
}

}  // namespace
}  // namespace flexarm::test
