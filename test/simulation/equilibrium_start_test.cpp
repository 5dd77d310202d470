// Tests starts in static equilibrium: nothing moves afterwards, and a scene without equilibrium is refused.
#include <gtest/gtest.h>

#include <limits>

#include "support/refusal.h"
#include "support/scene_builder.h"
#include "support/scheme_variants.h"

namespace flexarm {
namespace {

using namespace test;
using scene::JointKind;

constexpr double kBending = 100, kStretching = 1e5;  // EI [N m^2], EA [N] of the forearm
constexpr double kMass = 6.2;                        // of the whole arm [kg]

/// An arm under gravity. The rigid upper arm has a servo behind an elastic gear. The flexible forearm hangs on a joint
/// spring and is pushed by an effort. The hand has a sampled servo with delay and integral, and carries a load.
SceneBuilder held_arm() {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.body("upper", 4, {0.3, 0, 0}, Vector3(0.02, 0.1, 0.1).asDiagonal());
  b.beam("forearm", {{0.8, 0, 0}}, section(kStretching, 5e4, 80, kBending, 1.5, 1e-3, 5e-4), 3, 2);
  b.body("hand", 1, {0.1, 0, 0}, Vector3(0.01, 0.01, 0.01).asDiagonal());
  b.joint("shoulder", JointKind::Revolute, "world", "upper", {0, 0, 1}, {0, 1, 0});
  b.joint("elbow", JointKind::Revolute, "upper", "forearm", {0.6, 0, 0}, {0, 1, 0});
  b.joint("wrist", JointKind::Revolute, "forearm", "hand", {0.8, 0, 0}, {0, 0, 1});
  b.load("hand", {0.2, 0, 0}, {3, 5, 0});
  b.probe("tool", "hand", {0.2, 0, 0});
  b.scene.springs.push_back({"elbow", 300, 0.2, {}});
  b.scene.efforts.push_back({"elbow", TimeFunction(-4), {}});
  b.drive("shoulder", 100, 1e-4).stiffness = 5000;
  b.servo("shoulder", 2000, 40, 500).set_point = TimeFunction(-0.3);
  scene::ServoDescription& wrist = b.servo("wrist", 20, 0.1, 30);
  wrist.sample_time = 0.002;
  wrist.delay = 0.003;
  b.scene.integrator.step = 1e-3;
  b.scene.starts_in_equilibrium = true;
  return b;
}

class EquilibriumStart : public testing::TestWithParam<SchemeVariant> {};

TEST_P(EquilibriumStart, NothingMoves) {
  SceneBuilder b = held_arm();
  const IntegratorDescription& scheme = GetParam().integrator;
  b.scene.integrator = scheme;
  b.scene.integrator.step = 1e-3;
  if (GetParam().scheme.is_composition)  // composed schemes refuse sampled servos
    b.scene.servos.back().sample_time = b.scene.servos.back().delay = 0;
  Simulation simulation(b.scene);
  for (const scene::Diagnostic& warning : simulation.start_warnings())
    EXPECT_EQ(warning.element, "<integrator>") << "of the scheme, not of the start: " << warning.text();
  const Vector3 start = simulation.probe(0).pose.position;
  EXPECT_GT((start - Vector3(1.6, 0, 1)).norm(), 0.05) << "gravity and loads have bent it";
  constexpr int kSteps = 1000;
  double way = 0, kinetic = 0;
  for (int i = 0; i < kSteps; ++i) {
    ASSERT_TRUE(simulation.step().converged);
    way = std::max(way, (simulation.probe(0).pose.position - start).norm());
    kinetic = std::max(kinetic, simulation.energies().kinetic);
  }
  // Bound of the motion: strains have round-off, whose force EA eps moves the end by EA eps / (3 EI / L^3), in the
  // worst case once more in each step.
  const double eps = std::numeric_limits<double>::epsilon();
  const double bound = kSteps * eps * kStretching / (3 * kBending / std::pow(0.8, 3));
  EXPECT_LT(way, bound);
  EXPECT_LT(kinetic, kMass * bound * bound / (1e-3 * 1e-3)) << "at most that way in each step";
}

// The beta schemes are left out: their energy correction divides by the change of the axial strain, which is only
// round-off here.
INSTANTIATE_TEST_SUITE_P(Schemes, EquilibriumStart, testing::ValuesIn(scheme_variants_where([](const Scheme& scheme) {
                           return scheme.name.substr(0, 4) != "beta";
                         })),
                         [](const auto& info) { return info.param.name; });

// A servo with an integral holds the load without an error. A servo without one has the error at which kp holds the
// load.
// There are no unknowns, so Newton's method makes no update.
TEST(EquilibriumStarts, OfWhatCannotMove) {
  SceneBuilder b;
  b.body("post", 1, {0, 0, 1}, Matrix3::Identity());
  b.joint("foot", scene::JointKind::Fixed, "world", "post");
  b.scene.starts_in_equilibrium = true;
  EXPECT_TRUE(Simulation(b.scene).start_warnings().empty());
}

TEST(EquilibriumStarts, ServosStandWhereTheyWouldComeToRest) {
  SceneBuilder b = held_arm();
  Simulation integrating(b.scene);
  const std::size_t wrist = integrating.find_coordinate("wrist").value();
  EXPECT_NEAR(integrating.position(wrist), 0, 1e-14);
  b.scene.servos.back().ki = 0;
  Simulation proportional(b.scene);
  // The load of 5 N acts across the hand, 0.2 m from the joint.
  const double angle = proportional.position(wrist);
  EXPECT_GT(angle, 0.01);
  ASSERT_TRUE(proportional.step().converged);
  EXPECT_NEAR(proportional.effort(wrist), -20 * angle, 1e-9);
}

TEST(EquilibriumStarts, AreWhereResetLeads) {
  Simulation simulation(held_arm().scene);
  const Vector3 start = simulation.probe(0).pose.position;
  simulation.command_effort(simulation.find_coordinate("elbow").value(), 20);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(simulation.step().converged);
  EXPECT_GT((simulation.probe(0).pose.position - start).norm(), 1e-6);
  simulation.reset();
  EXPECT_EQ((simulation.probe(0).pose.position - start).norm(), 0);
}

void expect_refused(const scene::SceneDescription& scene, const std::string& text) {
  expect_contains(refusal_of(scene), text);
}

TEST(EquilibriumStarts, AreRefusedWhereNothingHoldsAJoint) {
  SceneBuilder b = held_arm();
  b.scene.servos.pop_back();
  b.scene.gravity = {0, 0, 0};
  b.scene.loads.clear();
  b.load("hand", {0.2, 0, 0}, {0, 0, 0}, {0, 0, 1}, "1", scene::LoadFrame::Follower);
  expect_refused(b.scene, "to start in its equilibrium: no equilibrium: nothing holds joint 'wrist'");
}

TEST(EquilibriumStarts, AreRefusedWithVelocities) {
  SceneBuilder b = held_arm();
  b.scene.initial_joints.push_back({"elbow", 0, 0.5, {"arm.urdf", 7}, true});
  expect_refused(b.scene, "arm.urdf:7: <initial> of joint 'elbow': a velocity is given");
  b.scene.initial_joints.back().velocity = 0;
  Simulation at_rest(b.scene);
  b.scene.initial_links.push_back({"upper", {0, 0, 0}, {0, 1, 0}, {"arm.urdf", 8}});
  expect_refused(b.scene, "arm.urdf:8: <initial> of link 'upper': a velocity is given");
}

TEST(EquilibriumStarts, TellWhatIsDoubtful) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.body("rod", 1, {0, 0, 0.5}, Vector3(0.1, 0.1, 0.01).asDiagonal());
  b.joint("hinge", JointKind::Continuous, "world", "rod", {0, 0, 0}, {0, 1, 0});
  b.probe("end", "rod", {0, 0, 1});
  b.scene.starts_in_equilibrium = true;
  Simulation fallen(b.scene);
  ASSERT_EQ(fallen.start_warnings().size(), 1u);
  EXPECT_NE(fallen.start_warnings()[0].text().find("is not stable: link 'rod' falls from it"), std::string::npos);
  EXPECT_NEAR(fallen.probe(0).pose.position.z(), -1, 1e-12) << "it hangs";
  b.scene.motions.push_back({"hinge", TimeFunction::parse("0.3*t"), {"rod.urdf", 9}});
  Simulation driven(b.scene);
  ASSERT_EQ(driven.start_warnings().size(), 1u);
  EXPECT_NE(driven.start_warnings()[0].text().find("rod.urdf:9: warning: <motion> of 'hinge': moves at t = 0"),
            std::string::npos);
  b.scene.motions.back().position = TimeFunction::parse("0.3*(1-cos(20*t))");
  EXPECT_TRUE(Simulation(b.scene).start_warnings().empty());
}

// Gravity has no moment about the vertical yaw axis, so any yaw angle is an equilibrium.
TEST(EquilibriumStarts, LeaveNeutralJointsWhereTheyAre) {
  for (const bool is_flexible : {false, true}) {
    SceneBuilder b;
    b.scene.gravity = {0, 0, -9.81};
    b.body("column", 0.7, {0, 0, 0.1}, 5e-4 * Matrix3::Identity());
    if (is_flexible)
      b.beam("upper", {{0.05, 0, 0.35}}, section(1e7, 4e6, 150, 200, 1, 1e-3, 5e-4), 3, 2);
    else
      b.body("upper", 0.7, {0.0136, 0, 0.23}, 2e-3 * Matrix3::Identity());
    b.body("fore", 0.43, {0.15, 0, 0.03}, 3e-4 * Matrix3::Identity());
    b.joint("yaw", JointKind::Continuous, "world", "column", {0, 0, 0}, {0, 0, 1});
    b.joint("shoulder", JointKind::Continuous, "column", "upper", {0, 0, 0.14}, {0, 1, 0});
    b.joint("elbow", JointKind::Continuous, "upper", "fore", {0.05, 0, 0.35}, {0, 1, 0});
    b.scene.initial_joints.push_back({"shoulder", 2.5, 0, {}});
    b.scene.starts_in_equilibrium = true;
    Simulation simulation(b.scene);
    EXPECT_NEAR(simulation.position(0), 0, 1e-9) << is_flexible;
    ASSERT_EQ(simulation.start_warnings().size(), 1u);
    EXPECT_NE(simulation.start_warnings()[0].text().find("nothing holds joint 'yaw'"), std::string::npos)
        << simulation.start_warnings()[0].text();
  }
}

}  // namespace
}  // namespace flexarm
