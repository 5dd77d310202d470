// Tests natural modes of mechanisms with known frequencies, in closed form or by counting.
#include "analysis/modes.h"

#include <gtest/gtest.h>

#include "building/model_builder.h"
#include "math/pi.h"
#include "simulation/observables.h"
#include "support/scene_builder.h"
#include "support/scene_text.h"

namespace flexarm {
namespace {

using namespace test;

TEST(NaturalModes, PendulumAboutItsEquilibrium) {
  SceneBuilder builder;
  builder.scene.gravity = Vector3(0, 0, -9.81);
  builder.body("bob", 2.0, Vector3(0, 0, -0.5), 0.1 * Matrix3::Identity());
  builder.joint("hinge", scene::JointKind::Continuous, "world", "bob", Vector3::Zero(), Vector3::UnitY());
  const Model model = build_model(builder.scene);
  const std::vector<Mode> modes = natural_modes(model, initial_state(model), 1);
  ASSERT_EQ(modes.size(), 1u);
  EXPECT_NEAR(modes[0].frequency, std::sqrt(2.0 * 9.81 * 0.5 / (0.1 + 2.0 * 0.25)) / (2 * kPi), 1e-9);
}

TEST(NaturalModes, InvertedPendulumGrows) {
  SceneBuilder builder;
  builder.scene.gravity = Vector3(0, 0, -9.81);
  builder.body("bob", 2.0, Vector3(0, 0, 0.5), 0.1 * Matrix3::Identity());
  builder.joint("hinge", scene::JointKind::Continuous, "world", "bob", Vector3::Zero(), Vector3::UnitY());
  const Model model = build_model(builder.scene);
  const std::vector<Mode> modes = natural_modes(model, initial_state(model), 1);
  EXPECT_EQ(modes.size(), 1u);
  EXPECT_TRUE(modes.at(0).is_divergence());
  EXPECT_EQ(modes[0].frequency, 0);
  EXPECT_NEAR(modes[0].rate, std::sqrt(2.0 * 9.81 * 0.5 / (0.1 + 2.0 * 0.25)), 1e-9);
  EXPECT_LT(modes[0].damping_ratio(), 0);
}

// A body at rest in a stop vibrates on the stop's spring, which depends on the contact time.
TEST(NaturalModes, OnAStop) {
  SceneBuilder builder;
  builder.body("block", 2, Vector3::Zero(), Matrix3::Identity());
  builder.joint("rail", scene::JointKind::Prismatic, "world", "block").limits = scene::JointLimits{-1, 1};
  Model model = build_model(builder.scene);
  State state = initial_state(model);
  state.released[0].displacement[0] = 1 + 1e-6;  // so shallow that the stop is linear
  for (const double contact_time : {1e-2, 0.3}) {
    LimitStop& stop = *model.coordinates[0].limit;
    stop.contact_time = contact_time;
    stop.carry(stop.inertia);
    const std::vector<Mode> modes = natural_modes(model, state, 1);
    ASSERT_EQ(modes.size(), 1u);
    EXPECT_NEAR(std::hypot(2 * kPi * modes[0].frequency, modes[0].rate) * contact_time, kPi, 1e-9);
  }
}

// A free beam has six rigid motions, and every node takes part in them.
TEST(NaturalModes, FreeBeamHasSixRigidMotions) {
  SceneBuilder builder;
  builder.beam("beam", {Vector3(1, 0, 0)}, section(1e4, 4e3, 5, 8, 1, 1e-3, 5e-4), 4, 3);
  builder.joint("free", scene::JointKind::Floating, "world", "beam");
  const Model model = build_model(builder.scene);
  const std::vector<Mode> modes = natural_modes(model, initial_state(model), 8);
  ASSERT_EQ(modes.size(), 8u);
  for (int k = 0; k < 6; ++k) EXPECT_TRUE(modes[k].is_free()) << k;
  EXPECT_GT(modes[6].frequency, 1);
  for (const Mode& mode : modes) {
    double largest = 0;
    for (const ComplexVector6& motion : mode.node_motion) largest = std::max(largest, motion.cwiseAbs().maxCoeff());
    EXPECT_NEAR(largest, 1, 1e-12);
  }
}

// Free joints must be found although round-off of the stiffness of other links reaches them: a stiff folded arm with a
// freely rotating body.
TEST(NaturalModes, FreeJointsOfAStiffArm) {
  SceneBuilder builder;
  builder.beam("upper", {Vector3(7, 0, 0)}, section(1e8, 4e7, 1e6, 3e6, 40, 3, 1.5), 3, 2);
  builder.beam("lower", {Vector3(6, 1, 2)}, section(1e8, 4e7, 1e6, 3e6, 40, 3, 1.5), 3, 2);
  builder.body("payload", 1000, Vector3(0.7, 0.2, 0.1), Vector3(300, 900, 1100).asDiagonal());
  builder.joint("shoulder", scene::JointKind::Continuous, "world", "upper", Vector3::Zero(), {0.1, 0.3, 0.9});
  builder.joint("elbow", scene::JointKind::Universal, "upper", "lower", {7, 0, 0}, {0.3, 1, 0}).axis2 = {0.2, 0.1, 1};
  builder.joint("roll", scene::JointKind::Continuous, "lower", "payload", {6, 1, 2}, {6, 1, 2});
  builder.scene.initial_joints = {{"shoulder", 0.7, 0, {}}, {"elbow/1", -1.9, 0, {}}, {"roll", 0.4, 0, {}}};
  const Model model = build_model(builder.scene);
  const std::vector<Mode> modes = natural_modes(model, initial_state(model), 10);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(modes[k].is_free(), k < 4) << k;
  for (const Mode& mode : modes) EXPECT_LE(mode.rate, 0);
  // Each free motion moves at least one joint.
  for (int k = 0; k < 4; ++k) {
    double largest = 0;
    for (const std::complex<double>& motion : modes[k].coordinate_motion) largest = std::max(largest, std::abs(motion));
    EXPECT_GT(largest, 0.01);
  }
}

// ---------------------------------------------------------------- damping

SceneBuilder damped_pendulum(double damping) {
  SceneBuilder builder;
  builder.scene.gravity = Vector3(0, 0, -9.81);
  builder.body("bob", 2.0, Vector3(0, 0, -0.5), 0.1 * Matrix3::Identity());
  builder.joint("hinge", scene::JointKind::Continuous, "world", "bob", Vector3::Zero(), Vector3::UnitY()).damping =
      damping;
  return builder;
}

TEST(DampedModes, PendulumOnADampedHinge) {
  const double inertia = 0.1 + 2.0 * 0.25, stiffness = 2.0 * 9.81 * 0.5, critical = 2 * std::sqrt(stiffness * inertia);
  for (const double ratio : {1e-6, 0.1, 0.9}) {
    const Model model = build_model(damped_pendulum(ratio * critical).scene);
    const std::vector<Mode> modes = natural_modes(model, initial_state(model), 5);
    ASSERT_EQ(modes.size(), 1u);
    const double omega = std::sqrt(stiffness / inertia);
    EXPECT_NEAR(modes[0].damping_ratio(), ratio, 1e-11) << ratio;
    EXPECT_NEAR(modes[0].rate, -ratio * omega, 1e-10 * omega) << ratio;
    EXPECT_NEAR(modes[0].frequency, omega * std::sqrt(1 - ratio * ratio) / (2 * kPi), 1e-10 * omega) << ratio;
  }
  // An overdamped mode has two rates.
  const Model model = build_model(damped_pendulum(2 * critical).scene);
  const std::vector<Mode> modes = natural_modes(model, initial_state(model), 5);
  ASSERT_EQ(modes.size(), 2u);
  const double omega = std::sqrt(stiffness / inertia);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(modes[k].frequency, 0);
    EXPECT_NEAR(modes[k].rate, -omega * (2 + (k == 0 ? -1 : 1) * std::sqrt(3.0)), 1e-10 * omega);
    EXPECT_EQ(modes[k].damping_ratio(), 1);
  }
}

// A wheel on a damper alone may be at rest at any angle, and comes to rest at the rate d / I.
TEST(DampedModes, FreeWheelOnADamper) {
  SceneBuilder builder;
  builder.body("wheel", 2.0, Vector3::Zero(), 0.1 * Matrix3::Identity());
  builder.joint("hinge", scene::JointKind::Continuous, "world", "wheel").damping = 0.03;
  const Model model = build_model(builder.scene);
  const std::vector<Mode> modes = natural_modes(model, initial_state(model), 5);
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_TRUE(modes[0].is_free());
  EXPECT_NEAR(modes[1].rate, -0.3, 1e-12);
}

SceneBuilder damped_cantilever(double stiffness_proportional, double mass_proportional, int elements) {
  SceneBuilder builder;
  scene::BeamDescription& beam = builder.beam("beam", {Vector3(0.6, 0, 0), Vector3(0.9, 0.3, 0.1)},
                                              section(1e4, 4e3, 5, 8, 1, 1e-3, 5e-4), elements, 2);
  beam.stiffness_proportional_damping = stiffness_proportional;
  beam.mass_proportional_damping = mass_proportional;
  builder.joint("clamp", scene::JointKind::Fixed, "world", "beam");
  return builder;
}

// D = eta K + alpha M damps a mode of circular frequency w by eta w / 2 + alpha / (2 w). The small model is solved with
// dense matrices, the large one by iteration.
TEST(DampedModes, ProportionalDamping) {
  const double eta = 1e-3, alpha = 0.4;
  for (const int elements : {2, 30}) {
    const Model undamped = build_model(damped_cantilever(0, 0, elements).scene);
    const std::vector<Mode> expected = natural_modes(undamped, initial_state(undamped), 4);
    const Model model = build_model(damped_cantilever(eta, 0, elements).scene);
    const std::vector<Mode> modes = natural_modes(model, initial_state(model), 4);
    ASSERT_EQ(modes.size(), 4u);
    for (int k = 0; k < 4; ++k) {
      const double omega = 2 * kPi * expected[k].frequency, ratio = eta * omega / 2;
      EXPECT_NEAR(modes[k].damping_ratio(), ratio, 1e-9) << elements;
      EXPECT_NEAR(2 * kPi * modes[k].frequency, omega * std::sqrt(1 - ratio * ratio), 1e-9 * omega) << elements;
    }
    // Rotary inertia is damped at the nodes, but acts at the points between them. The first bending modes have less
    // than the fraction (k r)^2 of their energy in it, with r^2 = 1e-3 m^2, k < 3 / m.
    const Model viscous = build_model(damped_cantilever(0, alpha, elements).scene);
    const std::vector<Mode> slow = natural_modes(viscous, initial_state(viscous), 4);
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(slow[k].rate, -alpha / 2, 9e-3 * alpha / 2) << elements;
  }
}

// Above 2 / eta the beam is overdamped, and many eigenvalues are near -1 / eta. The slow ones must be found all the
// same.
TEST(DampedModes, StrongDampingOfALargeModel) {
  const double eta = 0.02;
  const Model undamped = build_model(damped_cantilever(0, 0, 40).scene);
  const std::vector<Mode> expected = natural_modes(undamped, initial_state(undamped), 2);
  const Model model = build_model(damped_cantilever(eta, 0, 40).scene);
  const std::vector<Mode> modes = natural_modes(model, initial_state(model), 2);
  ASSERT_EQ(modes.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    const double omega = 2 * kPi * expected[k].frequency;
    ASSERT_LT(omega, 1 / eta);
    EXPECT_NEAR(modes[k].rate, -eta * omega * omega / 2, 1e-8 * omega);
  }
}

// Undamped motions neither decay nor grow by round-off of the damped ones.
TEST(DampedModes, UndampedMotionsBesideDampedOnes) {
  SceneBuilder builder = damped_pendulum(0.5);
  builder.body("other", 2.0, Vector3(0, 0, -0.3), 0.1 * Matrix3::Identity());
  builder.joint("free", scene::JointKind::Continuous, "world", "other", {0, 1, 0}, Vector3::UnitY());
  builder.beam("beam", {Vector3(1, 0, 0)}, section(1e4, 4e3, 5, 8, 1, 1e-3, 5e-4), 30, 2);
  builder.joint("clamp", scene::JointKind::Fixed, "world", "beam");
  const Model model = build_model(builder.scene);
  int damped = 0;
  for (const Mode& mode : natural_modes(model, initial_state(model), 10)) {
    EXPECT_LE(mode.rate, 0);
    if (mode.rate < 0) ++damped;
  }
  EXPECT_EQ(damped, 1);
}

// A gimbal without stiffness: the inner axis leans by 0.5 rad to the outer one. An outer damper d feels the inertia
// that is left about its axis while the inner joint is free, I_r sin^2 0.5 with I_r about a diameter of the disc,
// whatever the disc's polar inertia.
TEST(DampedModes, CoupledInertiaWithoutStiffness) {
  struct Disc {
    double radial, polar, damping;
  };
  for (const Disc& disc : {Disc{1e-4, 2e-4, 0.1}, Disc{1, 1, 0.5}, Disc{1, 1e3, 1e-6}}) {
    SceneBuilder builder;
    const Vector3 axis(std::sin(0.5), 0, std::cos(0.5));
    builder.scene.links.emplace_back();
    builder.scene.links.back().name = "fork";
    builder.body("disc", 1, Vector3::Zero(),
                 disc.radial * Matrix3::Identity() + (disc.polar - disc.radial) * axis * axis.transpose());
    builder.joint("outer", scene::JointKind::Continuous, "world", "fork", Vector3::Zero(), Vector3::UnitZ()).damping =
        disc.damping;
    builder.joint("inner", scene::JointKind::Continuous, "fork", "disc", Vector3::Zero(), axis);
    const Model model = build_model(builder.scene);
    const std::vector<Mode> modes = natural_modes(model, initial_state(model), 6);
    ASSERT_EQ(modes.size(), 3u) << disc.damping;
    EXPECT_TRUE(modes[0].is_free());
    EXPECT_TRUE(modes[1].is_free());
    const double expected = -disc.damping / (disc.radial * std::pow(std::sin(0.5), 2));
    EXPECT_NEAR(modes[2].rate / expected, 1, 1e-9);
    EXPECT_EQ(modes[2].damping_ratio(), 1);
  }
}

// A falling body does not feel its weight, wherever the origin of its link is.
TEST(NaturalModes, FallingBodyHasSixFreeMotions) {
  for (const Vector3& center : {Vector3(0, 0, 0), Vector3(0.05, 0, 0.054), Vector3(-0.3, 2, 0.1)}) {
    SceneBuilder builder;
    builder.scene.gravity = Vector3(0, 0, -9.81);
    builder.body("drone", 1.325, center, Vector3(0.04, 0.03, 0.06).asDiagonal());
    builder.joint("free", scene::JointKind::Floating, "world", "drone");
    const Model model = build_model(builder.scene);
    const std::vector<Mode> modes = natural_modes(model, initial_state(model), 8);
    ASSERT_EQ(modes.size(), 6u);
    for (const Mode& mode : modes) EXPECT_TRUE(mode.is_free()) << center.transpose();
  }
}

// A pendulum whose pivot falls does not swing; one whose pivot a spring carries does.
TEST(NaturalModes, PendulumOnAFallingSlider) {
  SceneBuilder builder;
  builder.scene.gravity = Vector3(0, 0, -9.81);
  builder.body("slider", 3, Vector3::Zero(), 0.1 * Matrix3::Identity());
  builder.body("bob", 2, Vector3(0, 0, -0.5), 0.1 * Matrix3::Identity());
  builder.joint("rail", scene::JointKind::Prismatic, "world", "slider", Vector3::Zero(), Vector3::UnitZ());
  builder.joint("hinge", scene::JointKind::Continuous, "slider", "bob", Vector3::Zero(), Vector3::UnitY());
  const Model falling = build_model(builder.scene);
  const std::vector<Mode> modes = natural_modes(falling, initial_state(falling), 2);
  ASSERT_EQ(modes.size(), 2u);
  for (const Mode& mode : modes) EXPECT_TRUE(mode.is_free());
  builder.scene.efforts.push_back({"rail", TimeFunction(5 * 9.81), {}});  // carries both
  const Model carried = build_model(builder.scene);
  const std::vector<Mode> swinging = natural_modes(carried, initial_state(carried), 2);
  ASSERT_EQ(swinging.size(), 2u);
  EXPECT_TRUE(swinging[0].is_free());
  EXPECT_NEAR(2 * kPi * swinging[1].frequency, std::sqrt(2 * 9.81 * 0.5 / (0.1 + 2 * 0.25)), 1e-9);
}

TEST(NaturalModes, NothingMovesOrNothingAsked) {
  SceneBuilder builder;
  builder.body("block", 2.0, Vector3::Zero(), Matrix3::Identity());
  builder.joint("glue", scene::JointKind::Fixed, "world", "block");
  const Model fixed = build_model(builder.scene);
  EXPECT_TRUE(natural_modes(fixed, initial_state(fixed), 3).empty());
  SceneBuilder pendulum;
  pendulum.body("bob", 2.0, Vector3(0, 0, -0.5), 0.1 * Matrix3::Identity());
  pendulum.joint("hinge", scene::JointKind::Continuous, "world", "bob", Vector3::Zero(), Vector3::UnitY());
  const Model model = build_model(pendulum.scene);
  EXPECT_TRUE(natural_modes(model, initial_state(model), 0).empty());
  EXPECT_EQ(natural_modes(model, initial_state(model), 5).size(), 1u);  // there are no more modes
}

// A line without tension changes no mode. Most of its points share no piece, and have no block of the matrices
// together.
TEST(Modes, OfARodWithASlackLine) {
  const auto modes_of = [](const std::string& line) {
    const Model model = build_model(scene_of(R"(<robot name="rod"> <link name="world"/>
      <joint name="clamp" type="fixed"> <parent link="world"/> <child link="rod"/> </joint>
      <link name="rod"> <beam elements="12" order="2"> <centerline> <line to="0.3 0 0"/> </centerline>
        <section ea="2e4" ga2="1e4" ga3="1e4" gj="0.01" ei2="0.01" ei3="0.02" mass="0.05" j1="4e-6" j2="2e-6" j3="2e-6"/>
        <damping stiffness_proportional="2e-3"/> </beam> </link> )" +
                                             line + "<simulation> <gravity xyz=\"0 0 0\"/> </simulation> </robot>"));
    return natural_modes(model, initial_state(model), 6);
  };
  const std::vector<Mode> expected = modes_of(""), got = modes_of(R"(<tendon name="line" tension="0">
    <vias link="rod" from="0 0 0" to="0.3 0 0" count="13" radius="0.01"/> </tendon>)");
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_NEAR(got[i].frequency, expected[i].frequency, 1e-9 * expected[i].frequency);
    EXPECT_NEAR(got[i].rate, expected[i].rate, 1e-9 * std::abs(expected[i].rate));
  }
}

}  // namespace
}  // namespace flexarm
