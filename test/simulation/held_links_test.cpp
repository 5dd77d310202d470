// Tests joints with constant motions ("held" joints): they cost no more than fixed joints, because the links they carry
// become part of the master's body. The effort that drives them is still known.

#include "flexarm/scene/point_spring.h"
#include "flexarm/simulation/checkpoint.h"
#include "flexarm/simulation/linear_model.h"
#include "integrators/step_plane.h"
#include "math/pi.h"
#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

constexpr double kElbow = 0.4, kLift = 0.15, kWrist = -0.7;
constexpr double kStep = 1e-3, kSolved = 1e-12;
constexpr int kSteps = 60;
constexpr double kRemainder = 0.5 * kSteps * kSteps * kSolved;  // [m]

/// How joints keep their position: Fixed by fixed joints, Held by constant motions, Driven by functions of time that
/// have a single value. Driven joints need a node and a row each.
enum class Kept { Fixed, Held, Driven };

TimeFunction constant(double value, Kept kept) {
  return kept == Kept::Held ? TimeFunction(value) : TimeFunction::parse("0:" + std::to_string(value));
}

void keep(SceneBuilder& b, scene::JointDescription& joint, double value, Kept kept) {
  if (kept != Kept::Fixed) {
    b.scene.motions.push_back({joint.name, constant(value, kept), {}});
    return;
  }
  if (joint.kind == JointKind::Prismatic)
    joint.origin.position += joint.origin.orientation * (value * joint.axis);
  else
    joint.origin.orientation = joint.origin.orientation * Eigen::AngleAxisd(value, joint.axis);
  joint.kind = JointKind::Fixed;
}

const Matrix3 kInertia = Vector3(0.02, 0.03, 0.01).asDiagonal();

/// Six links that turn about two free joints. Three joints in a row are kept, the second of which is a slider. A fixed
/// link hangs on the last one.
SceneBuilder spatial_arm(Kept kept) {
  SceneBuilder b;
  for (const char* name : {"upper", "middle", "carriage", "wrist", "tool", "lower"})
    b.body(name, 1.5, {0.02, -0.03, 0.2}, kInertia);
  b.joint("first", JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  keep(b, b.joint("elbow", JointKind::Revolute, "upper", "middle", {0, 0, 0.4}, {0, 0.6, 0.8}), kElbow, kept);
  keep(b, b.joint("lift", JointKind::Prismatic, "middle", "carriage", {0, 0.1, 0.3}, {0, 0, 1}), kLift, kept);
  keep(b, b.joint("turn", JointKind::Continuous, "carriage", "wrist", {0, 0, 0.1}, {1, 0, 0}), kWrist, kept);
  b.joint("flange", JointKind::Fixed, "wrist", "tool", {0.1, 0, 0.1});
  b.joint("last", JointKind::Revolute, "wrist", "lower", {0, 0, 0.4}, {0, 0.8, 0.6});
  b.scene.initial_joints.push_back({"first", 0.3, 2, {}, true});
  b.scene.initial_joints.push_back({"last", -0.5, 1, {}, true});
  b.probe("tip", "lower", {0, 0, 0.4});
  b.probe("tool", "tool", {0.1, 0, 0});
  b.scene.gravity = {0, 0, -9.81};
  b.scene.integrator.tolerance = kSolved;
  return b;
}

/// An arm on a kept base. One beam hangs on a moving joint, another one on a kept joint.
SceneBuilder flexible_arm(Kept kept) {
  SceneBuilder b;
  const scene::DirectSection rod = section(2e5, 1e5, 40, 60, 0.5, 1e-4, 5e-5);
  b.body("base", 4, {0, 0.05, 0.1}, kInertia);
  b.body("shoulder", 1, {0.05, 0, 0.1}, kInertia);
  b.beam("boom", {{0.8, 0, 0}}, rod, 2, 2);
  b.body("elbow", 0.6, {0.05, 0.02, 0}, kInertia);
  b.beam("jib", {{0.5, 0, 0}}, rod, 2, 2);
  keep(b, b.joint("pan", JointKind::Revolute, "world", "base", {0, 0, 0}, {0, 0, 1}), kElbow, kept);
  b.joint("lift", JointKind::Revolute, "base", "shoulder", {0, 0, 0.3}, {0, 1, 0});
  keep(b, b.joint("roll", JointKind::Revolute, "shoulder", "boom", {0.1, 0, 0.1}, {1, 0, 0}), kWrist, kept);
  keep(b, b.joint("bend", JointKind::Revolute, "boom", "elbow", {0.8, 0, 0}, {0, 0, 1}), kElbow, kept);
  b.joint("swing", JointKind::Revolute, "elbow", "jib", {0.1, 0, 0}, {0, 1, 0});
  b.scene.initial_joints.push_back({"lift", -0.3, 0.5, {}, true});
  b.probe("tip", "jib", {0.5, 0, 0});
  b.probe("boom", "boom", {0.8, 0, 0});
  b.scene.gravity = {0, 0, -9.81};
  b.scene.integrator.tolerance = kSolved;
  return b;
}

Simulation simulated(SceneBuilder b, const std::string& scheme, double step = kStep) {
  b.scene.integrator.scheme = scheme;
  b.scene.integrator.step = step;
  return Simulation(b.scene);
}

void advance(Simulation& simulation, int steps) {
  for (int n = 0; n < steps; ++n) ASSERT_TRUE(simulation.step().converged);
}

const std::vector<std::string> kSchemes = {"em", "em4", "edmc2", "m1", "newmark", "hht2"};

TEST(HeldLinks, HaveNoNodesOfTheirOwn) {
  for (const auto& scene : {spatial_arm, flexible_arm}) {
    const Simulation held(scene(Kept::Held).scene), fixed(scene(Kept::Fixed).scene);
    EXPECT_EQ(model_of(held).held.size(), 3U);
    EXPECT_EQ(model_of(held).nodes.size(), model_of(fixed).nodes.size());
    EXPECT_EQ(model_of(held).joints.size(), model_of(fixed).joints.size());
    EXPECT_EQ(held.degrees_of_freedom(), fixed.degrees_of_freedom());
  }
}

// Bound kRemainder: the error of Newton's method in one step is a velocity in all later steps.
TEST(HeldLinks, MoveAsBehindFixedJoints) {
  for (const auto& scene : {spatial_arm, flexible_arm})
    for (const std::string& scheme : kSchemes) {
      Simulation held = simulated(scene(Kept::Held), scheme), fixed = simulated(scene(Kept::Fixed), scheme);
      advance(held, kSteps);
      advance(fixed, kSteps);
      for (const std::size_t probe : {0, 1})
        EXPECT_LT((held.probe(probe).pose.position - fixed.probe(probe).pose.position).norm(), kRemainder) << scheme;
      EXPECT_NEAR(held.momentum().norm(), fixed.momentum().norm(), kRemainder / kStep) << scheme;
    }
}

TEST(HeldLinks, StandAtTheirJointsPositions) {
  Simulation held = simulated(spatial_arm(Kept::Held), "em"), driven = simulated(spatial_arm(Kept::Driven), "em");
  advance(held, 10);
  const std::vector<double> positions = {kElbow, kLift, kWrist};
  for (const std::size_t k : {0, 1, 2}) {
    EXPECT_EQ(held.position(k + 1), positions[k]);
    EXPECT_EQ(held.velocity(k + 1), 0);
    EXPECT_FALSE(held.is_commandable(k + 1));
    EXPECT_THROW(held.set_joint_state({{k + 1, 0.1, {}}}), std::invalid_argument);
  }
  EXPECT_EQ(held.coordinate_names(), driven.coordinate_names());
  held.reset();
  for (std::size_t link = 0; link < held.link_names().size(); ++link) {
    EXPECT_LT((held.link_pose(link).position - driven.link_pose(link).position).norm(), 1e-15);
    EXPECT_LT(held.link_pose(link).orientation.angularDistance(driven.link_pose(link).orientation), 1e-15);
  }
  EXPECT_NO_THROW(held.set_joint_state({{0, 0.1, {}}}));
  EXPECT_EQ(held.position(0), 0.1);
}

// Two equal arms on the left and right of a pendulum that hangs at rest, and a crane on the world. Their exact efforts
// balance the weights.
TEST(HeldLinks, AreHeldAgainstTheirWeights) {
  for (const std::string& scheme : kSchemes) {
    SceneBuilder b;
    for (const char* name : {"pendulum", "left", "right", "crane", "load"}) b.body(name, 2, {0, 0, -0.25}, kInertia);
    b.joint("pivot", JointKind::Revolute, "world", "pendulum", {0, 0, 1}, {0, 1, 0});
    b.joint("l", JointKind::Revolute, "pendulum", "left", {0, 0, -0.5}, {0, 1, 0});
    b.joint("r", JointKind::Revolute, "pendulum", "right", {0, 0, -0.5}, {0, 1, 0});
    b.joint("jib", JointKind::Revolute, "world", "crane", {3, 0, 1}, {0, 1, 0});
    b.joint("hook", JointKind::Revolute, "crane", "load", {0, 0, -0.8}, {0, 1, 0});
    for (const auto& [joint, angle] : {std::pair{"l", 0.5}, {"r", -0.5}, {"jib", -1.1}})
      b.scene.motions.push_back({joint, TimeFunction(angle), {}});
    b.scene.initial_joints.push_back({"hook", 1.1, 0, {}, true});
    b.scene.gravity = {0, 0, -9.81};
    Simulation simulation = simulated(b, scheme);
    ASSERT_EQ(model_of(simulation).held.size(), 3U);
    advance(simulation, 5);
    const double arm = 2 * 9.81 * 0.25 * std::sin(0.5), jib = 2 * 9.81 * (0.25 + 0.8) * std::sin(1.1);
    EXPECT_NEAR(simulation.effort(1), arm, 1e-12) << scheme;
    EXPECT_NEAR(simulation.effort(2), -arm, 1e-12) << scheme;
    EXPECT_NEAR(simulation.effort(3), -jib, 1e-12) << scheme;
  }
}

/// Efforts that drive the joints at `time`.
std::vector<double> efforts(const SceneBuilder& b, const std::string& scheme, double step, double time) {
  Simulation simulation = simulated(b, scheme, step);
  advance(simulation, static_cast<int>(std::lround(time / step)));
  std::vector<double> out;
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i)
    if (!simulation.is_commandable(i)) out.push_back(simulation.effort(i));
  return out;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

// Both results approximate the efforts of the same motion with errors of second order. So the difference falls to a
// quarter when steps are halved.
TEST(HeldLinks, AreDrivenByTheSameEfforts) {
  SceneBuilder held = spatial_arm(Kept::Held), driven = spatial_arm(Kept::Driven);
  for (SceneBuilder* b : {&held, &driven}) {
    b->load("tool", {0, 0, 0.1}, {2, -1, 3}, {0.3, 0.2, -0.1}, "cos(3*t)");
    b->load("carriage", {0.1, 0, 0}, {-1, 1, 2}, {0, 0.2, 0}, "1+t", scene::LoadFrame::Follower);
  }
  for (const std::string scheme : {"em", "edmc2", "newmark", "hht1", "hht2", "hht3"}) {
    const auto distance_by = [&](double step) {
      return distance(efforts(held, scheme, step, 0.2), efforts(driven, scheme, step, 0.2));
    };
    const double slope = std::log2(distance_by(4e-3) / distance_by(2e-3));
    EXPECT_NEAR(slope, 2, 0.15) << scheme;
  }
}

// The effort is exact where a beam hangs on the joint itself, and where the links stand on the world. The elbow's share
// of the forces of its body has an error of second order, in steps that resolve 30 rad/s.
TEST(HeldLinks, CarryBeams) {
  const SceneBuilder held = flexible_arm(Kept::Held), driven = flexible_arm(Kept::Driven);
  for (const std::string scheme : {"em", "edmc2", "newmark", "hht2"}) {
    const double step = 4e-4;
    const std::vector<double> a = efforts(held, scheme, step, 0.04), b = efforts(driven, scheme, step, 0.04);
    EXPECT_GT(std::abs(b[1]), 0.01) << scheme;
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(a[i], b[i], std::pow(30 * step, 2) * 0.6 * 0.054 * 9.81) << scheme << " " << i;
  }
}

// A force on a held link counts in the effort that holds it, whether it is a load of the scene or a wrench.
TEST(HeldLinks, AreHeldAgainstWrenches) {
  SceneBuilder b = spatial_arm(Kept::Held);
  b.scene.gravity.setZero();
  b.scene.initial_joints.clear();
  b.scene.integrator.scheme = "em";
  const Simulation at_rest(b.scene);
  const std::size_t tool = 4;
  ASSERT_EQ(at_rest.link_names()[tool + 1], "tool");
  const Pose pose = at_rest.link_pose(tool + 1), turn = at_rest.link_pose(tool);
  const Vector3 axis = turn.orientation * Vector3::UnitX();
  // A pure moment about the axis of the last held joint: it needs no motion of the links inboard of it at the start.
  AppliedWrench wrench;
  wrench.link = tool + 1;
  wrench.wrench.moment = 2 * axis;
  Simulation pushed = at_rest.copy(), free = at_rest.copy();
  pushed.apply_wrenches({wrench});
  advance(pushed, 3);
  advance(free, 3);
  EXPECT_EQ(free.effort(3), 0);
  SceneBuilder loaded = b;
  loaded.load("tool", {0, 0, 0}, {0, 0, 0}, 2 * axis);
  Simulation same(loaded.scene);
  advance(same, 3);
  EXPECT_NEAR(pushed.effort(3), same.effort(3), 1e-12);
  EXPECT_LT(pushed.effort(3), -0.5);  // against the moment, less the share that accelerates the links
  EXPECT_LT((pose.position - at_rest.link_pose(tool + 1).position).norm(), 1e-15);

  SceneBuilder driven = b;
  for (scene::PrescribedMotion& motion : driven.scene.motions)
    motion.position = constant(motion.position(0), Kept::Driven);
  Simulation reference(driven.scene);
  reference.apply_wrenches({wrench});
  advance(reference, 3);
  // An error of second order of the motion, in three steps of 1e-3 s.
  EXPECT_NEAR(pushed.effort(3), reference.effort(3), 1e-4);
}

// A joint is driven instead of held if it needs a row of its own, or if something acts on it that is not known from the
// links.
TEST(HeldLinks, AreThoseOfPlainJointsAlone) {
  const auto held = [](const auto& change) {
    SceneBuilder b = spatial_arm(Kept::Held);
    change(b);
    const Simulation simulation(b.scene);
    std::vector<std::string> names;
    for (const HeldJoint& joint : model_of(simulation).held)
      names.push_back(simulation.coordinate_names()[joint.coordinate]);
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(held([](SceneBuilder&) {}), (Names{"elbow", "lift", "turn"}));
  EXPECT_EQ(held([](SceneBuilder& b) { b.scene.motions[0].position = TimeFunction::parse("0.2+0.2"); }),
            (Names{"elbow", "lift", "turn"}));
  EXPECT_EQ(held([](SceneBuilder& b) { b.scene.motions[0].position = TimeFunction::parse("0.4+0*t"); }),
            (Names{"lift", "turn"}));
  EXPECT_EQ(held([](SceneBuilder& b) { b.scene.springs.push_back({"lift", 100, 0, {}}); }), (Names{"elbow", "turn"}));
  EXPECT_EQ(held([](SceneBuilder& b) { b.sensor("s", scene::SensorKind::Wrench, "wrist"); }), (Names{"elbow", "lift"}));
  EXPECT_EQ(held([](SceneBuilder& b) { b.sensor("s", scene::SensorKind::Wrench, "tool"); }),
            (Names{"elbow", "lift", "turn"}));
  EXPECT_EQ(held([](SceneBuilder& b) { b.scene.joints[1].friction_law.coefficient = 0.1; }), (Names{"lift", "turn"}));
  // A link inboard of a driven joint cannot take over the links that hang on this joint.
  EXPECT_EQ(held([](SceneBuilder& b) {
              auto spring = std::make_shared<scene::PointSpring>();
              spring->from = "world";
              spring->to = "tool";
              spring->stiffness = 10;
              b.scene.force_elements.push_back(spring);
            }),
            (Names{"elbow", "lift"}));
}

// Linear models with the motion of a held joint as input or output are the same as with a driven joint.
TEST(HeldLinks, MoveInLinearModels) {
  Simulation held = simulated(spatial_arm(Kept::Held), "em"), driven = simulated(spatial_arm(Kept::Driven), "em");
  for (const LinearisedAbout about : {LinearisedAbout::Rest, LinearisedAbout::Instant}) {
    LinearRequest request;
    request.about = about;
    request.inputs = {"motion:elbow", "effort:first", "wrench:tool:fz"};
    request.outputs = {"position:tip:x", "effort:lift", "acceleration:tool:y"};
    const LinearModel a = linearise(held, request), b = linearise(driven, request);
    EXPECT_EQ(a.states, b.states);
    for (const auto& [x, y] : {std::pair{&a.a, &b.a}, {&a.b, &b.b}, {&a.c, &b.c}, {&a.d, &b.d}})
      EXPECT_LT((*x - *y).norm(), 1e-9 * (1 + y->norm()));
    request.inputs = {"effort:first"};
    request.outputs = {"position:tip:x", "position:elbow"};
    const LinearModel c = linearise(held, request), d = linearise(driven, request);
    EXPECT_EQ(c.states, d.states);
    EXPECT_LT((c.a - d.a).norm(), 1e-9 * (1 + d.a.norm()));
    EXPECT_LT((c.c - d.c).norm(), 1e-9 * (1 + d.c.norm()));
  }
}

// The same with a wrench on the carried links, and with a drive and a servo on another joint.
TEST(HeldLinks, MoveInLinearModelsWithWrenchesAndServos) {
  AppliedWrench wrench;
  wrench.link = 5;
  wrench.at = {0.1, 0.2, 0};
  wrench.wrench = {{20, -10, 30}, {1, 2, 3}};
  wrench.follows = true;
  const auto pushed = [&](Kept kept, bool is_servo_on) {
    SceneBuilder b = spatial_arm(kept);
    scene::DriveDescription drive;
    drive.coordinate = "first";
    drive.rotor_inertia = 0.1;
    drive.stiffness = 800;
    b.scene.drives.push_back(drive);
    scene::ServoDescription servo;
    servo.coordinate = "first";
    servo.kp = 50;
    b.scene.servos.push_back(servo);
    Simulation simulation = simulated(b, "em");
    simulation.apply_wrenches({wrench});
    simulation.switch_servo(0, is_servo_on);
    return simulation;
  };
  LinearRequest request;
  request.about = LinearisedAbout::Instant;
  request.inputs = {"wrench:tool:fz"};
  request.outputs = {"position:tip:x"};
  for (const bool is_servo_on : {true, false}) {
    const LinearModel held = linearise(pushed(Kept::Held, is_servo_on), request),
                      driven = linearise(pushed(Kept::Driven, is_servo_on), request);
    EXPECT_EQ(held.states, driven.states);
    EXPECT_LT((held.a - driven.a).norm(), 1e-9 * driven.a.norm()) << is_servo_on;
    EXPECT_LT((held.drift - driven.drift).norm(), 1e-9 * driven.drift.norm()) << is_servo_on;
  }
}

// A joint that is held about an axis in the plane of motion does not end the motion in the plane. Here it carries a
// hand that is symmetric to the plane.
TEST(HeldLinks, StayInThePlaneOfMotion) {
  const auto pendulum = [](Kept kept) {
    SceneBuilder b;
    b.body("rod", 2, {0.5, 0, 0}, kInertia);
    b.body("hand", 1, {0.3, 0, 0}, kInertia);
    b.joint("hinge", JointKind::Revolute, "world", "rod", {0, 0, 0}, {0, 1, 0});
    keep(b, b.joint("roll", JointKind::Revolute, "rod", "hand", {1, 0, 0}, {1, 0, 0}), 0.5 * kPi, kept);
    b.probe("tip", "hand", {1, 0, 0});
    b.scene.gravity = {0, 0, -9.81};
    b.scene.integrator.tolerance = kSolved;
    return b;
  };
  Simulation held = simulated(pendulum(Kept::Held), "em"), fixed = simulated(pendulum(Kept::Fixed), "em");
  EXPECT_TRUE(find_step_plane(model_of(held), *find_scheme("em")).plane);
  EXPECT_FALSE(find_step_plane(model_of(simulated(pendulum(Kept::Driven), "em")), *find_scheme("em")).plane);
  advance(held, kSteps);
  advance(fixed, kSteps);
  EXPECT_LT((held.probe(0).pose.position - fixed.probe(0).pose.position).norm(), kRemainder);
  EXPECT_NEAR(held.effort(1), 0, 1e-12);
}

// The link on which a wrench acts is part of a checkpoint.
TEST(HeldLinks, AreHeldTheSameAfterACheckpoint) {
  const SceneBuilder b = spatial_arm(Kept::Held);
  const SimulationOptions options = full_newton();
  Simulation simulation(b.scene, options), resumed(b.scene, options);
  AppliedWrench wrench;
  wrench.link = 5;
  wrench.wrench.force = {5, -3, 1};
  simulation.apply_wrenches({wrench});
  advance(simulation, 5);
  read_checkpoint_text(resumed, checkpoint_text(simulation), "text");
  advance(simulation, 5);
  advance(resumed, 5);
  for (const std::size_t k : {1, 2, 3}) EXPECT_EQ(resumed.effort(k), simulation.effort(k));
}

TEST(HeldLinks, AreWhereTheStateOfAnotherSceneMustHaveThem) {
  SceneBuilder other = spatial_arm(Kept::Held);
  other.scene.motions[0].position = TimeFunction(0.5);
  const Simulation from(other.scene);
  Simulation to(spatial_arm(Kept::Held).scene);
  EXPECT_THROW(to.take_over(from), std::invalid_argument);
}

}  // namespace
}  // namespace flexarm::test
