// Tests what joints transmit under explicit schemes: sensors of reactions, and the efforts that hold held joints.
#include <cmath>

#include "reference/explicit_runs.h"
#include "support/loops.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

class ExplicitSensors : public ExplicitRuns {};

Vector6 sensed(const Simulation& s, std::size_t sensor) {
  const ActingWrench acting = s.sensed_wrench(sensor);
  Vector6 out;
  out << acting.wrench.force, acting.wrench.moment;
  return out;
}

/// Expects all sensors and one effort to be those of em with short steps, whose outputs have errors of second order.
/// `of_effort`: index of a coordinate, or -1.
void expect_limit_of_em(const SceneBuilder& b, const Simulation& s, int steps, int of_effort) {
  for (std::size_t i = 0; i < b.scene.sensors.size() + (of_effort < 0 ? 0 : 1); ++i) {
    double errors[2], scale = 0;
    for (const int k : {0, 1}) {
      Simulation reference(b.scene, options("em", s.time() / (steps << k), 1e-13));
      run(reference, steps << k);
      if (i < b.scene.sensors.size()) {
        errors[k] = (sensed(reference, i) - sensed(s, i)).norm();
        scale = sensed(s, i).norm();
      } else {
        errors[k] = std::abs(reference.effort(of_effort) - s.effort(of_effort));
        scale = std::abs(s.effort(of_effort));
      }
    }
    EXPECT_NEAR(observed_order(errors[0], errors[1]), 2, 0.3) << i << ": " << errors[0] << " " << errors[1];
    EXPECT_GT(scale, 100 * errors[1]);
  }
}

// The pivot of a pendulum transmits m g cos(angle) + m l w^2 along the rod, and m (l w' - g sin) across.
TEST_P(ExplicitSensors, HoldAPendulum) {
  const double mass = 2, length = 0.5, inertia = 0.03;
  SceneBuilder b;
  b.scene.gravity = {0, 0, -kGravity};
  b.body("bob", mass, {0, 0, -length}, Vector3(inertia, inertia, 0.01).asDiagonal());
  b.joint("hinge", JointKind::Continuous, "world", "bob", {0, 0, 0}, {0, 1, 0});
  b.sensor("pivot", scene::SensorKind::Reaction, "bob");
  initial_joint(b, "hinge", 1.2, 0.7);
  Simulation s(b.scene, options(GetParam().name, 0.05, 1e-12));
  for (int n = 0; n < 20; ++n) {
    run(s, 1);
    const double angle = s.position(0), rate = s.velocity(0);
    const double change = -mass * kGravity * length * std::sin(angle) / (inertia + mass * length * length);
    const Vector3 along(std::sin(angle), 0, std::cos(angle)), across(-std::cos(angle), 0, std::sin(angle));
    const Vector3 force = mass * (length * rate * rate + kGravity * std::cos(angle)) * along +
                          mass * (length * change + kGravity * std::sin(angle)) * across;
    const Vector6 wrench = sensed(s, 0);
    EXPECT_LT((wrench.head<3>() - force).norm(), 1e-12 * mass * kGravity);
    EXPECT_LT(wrench.tail<3>().norm(), 1e-12 * mass * kGravity * length) << "the hinge turns freely";
  }
}

/// A tree with a rotor, a spring, a load, a ball joint, a weld and a follower.
SceneBuilder branched_tree() {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -kGravity};
  const Matrix3 inertia = Vector3(0.02, 0.03, 0.04).asDiagonal();
  for (const char* name : {"upper", "fore", "ball", "tool", "wheel"}) b.body(name, 1.2, {0.1, 0.05, 0.2}, inertia);
  b.joint("shoulder", JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  b.joint("elbow", JointKind::Prismatic, "upper", "fore", {0, 0.1, 0.4}, {0.6, 0, 0.8});
  b.joint("socket", JointKind::Spherical, "upper", "ball", {0.2, 0, 0.1});
  b.joint("weld", JointKind::Fixed, "fore", "tool", {0, 0, 0.3});
  b.joint("axle", JointKind::Revolute, "fore", "wheel", {0.1, 0, 0}, {0, 0, 1});
  initial_joint(b, "shoulder", 0.3, 2);
  initial_joint(b, "elbow", 0.1, -0.5);
  initial_joint(b, "axle", 0, 3);
  scene::DriveDescription& drive = b.drive("shoulder", 5, 2e-3);
  drive.stiffness = 60, drive.damping = 1;
  b.drive("axle", 10, 1e-4);
  b.load("tool", {0.1, 0, 0.2}, {3, -1, 2}, {0.1, 0.2, 0.3}, "1+t", scene::LoadFrame::Follower);
  for (const char* name : {"upper", "fore", "ball", "tool", "wheel"})
    b.sensor(std::string("at_") + name, scene::SensorKind::Reaction, name, {0.02, 0, 0});
  return b;
}

TEST_P(ExplicitSensors, AreThoseOfEmInATree) {
  const SceneBuilder b = branched_tree();
  expect_limit_of_em(b, after(b, 0.3, 100), 1000, -1);
}

TEST_P(ExplicitSensors, AreThoseOfEmWhereCoordinatesDepend) {
  SceneBuilder b = branched_tree();
  b.scene.motions.push_back({"elbow", TimeFunction::parse("0.1*cos(5*t)"), {}});
  b.scene.initial_joints.erase(b.scene.initial_joints.begin() + 1);
  expect_limit_of_em(b, after(b, 0.3, 100), 1000, static_cast<int>(*Simulation(b.scene).find_coordinate("elbow")));
}

// The sensor does not change the motion.
TEST_P(ExplicitSensors, ChangeNothing) {
  SceneBuilder with = branched_tree();
  with.scene.sensors.erase(with.scene.sensors.begin() + 3);  // a weld with a sensor is a joint
  SceneBuilder without = with;
  without.scene.sensors.clear();
  const Simulation s = after(with, 0.3, 30), t = after(without, 0.3, 30);
  EXPECT_EQ(s.link_pose(2).position, t.link_pose(2).position);
  EXPECT_EQ(s.energies().total(), t.energies().total());
}

/// A four-bar linkage whose hip a loop joint closes.
SceneBuilder swinging_four_bar() {
  SceneBuilder b;
  b.scene.gravity = {3, 0, -kGravity};
  b.body("crank", 0.4, {0, 0, 0.1}, 1e-3 * Matrix3::Identity());
  b.joint("crank", JointKind::Revolute, "world", "crank", {0, 0, 0}, kAcross);
  b.body("coupler", 0.5, {0.25, 0.02, 0.1}, 4e-3 * Matrix3::Identity());
  b.joint("knee", JointKind::Revolute, "crank", "coupler", {0, 0, 0.2}, kAcross);
  b.body("rocker", 0.6, {0, 0.03, 0.2}, 5e-3 * Matrix3::Identity());
  b.joint("foot", JointKind::Revolute, "world", "rocker", {0.6, 0, 0}, kAcross);
  close_loop(b, "hip", JointKind::Revolute, "rocker", "coupler", {0.6, 0, 0.2}, kAcross);
  for (const char* name : {"crank", "coupler", "rocker"}) b.sensor(name, scene::SensorKind::Reaction, name);
  for (const char* name : {"coupler", "rocker"}) {
    b.sensor(std::string("hip_on_") + name, scene::SensorKind::Reaction, name);
    b.scene.sensors.back().joint = "hip";
  }
  return b;
}

TEST_P(ExplicitSensors, AreThoseOfEmInALoop) {
  for (const bool is_driven : {false, true}) {
    SceneBuilder b = swinging_four_bar();
    if (is_driven) b.scene.motions.push_back({"crank", TimeFunction::parse("0.3*sin(6*t)"), {}});
    expect_limit_of_em(b, after(b, 0.3, 100), 1000, is_driven ? 0 : -1);
  }
}

// Forces and moments on the coupler are the rate of its momentum; what the hip transmits is opposite on both links.
TEST_P(ExplicitSensors, BalanceTheLinksOfALoop) {
  SceneBuilder b = swinging_four_bar();
  for (scene::Sensor& sensor : b.scene.sensors)
    if (sensor.link == "coupler") sensor.at = {0.25, 0.02, 0.1};  // the centre of mass
  Simulation s(b.scene, options(GetParam().name, 2e-3, 1e-12));
  const auto coupler = [&] {
    for (std::size_t i = 0; i < model_of(s).nodes.size(); ++i)
      if (model_of(s).inertias[i].total_mass == 0.5) return i;
    return std::size_t{0};
  }();
  for (int n = 0; n < 100; ++n) {
    run(s, 1);
    const NodeState& node = state_of(s).nodes[coupler];
    Vector6 rate;  // of momentum; the inertia is isotropic
    rate << 0.5 * (node.acceleration - b.scene.gravity), 4e-3 * (node.orientation * node.angular_acceleration);
    const Vector6 sum = sensed(s, 1) + sensed(s, 3);
    EXPECT_LT((sum - rate).norm(), 1e-10 * sensed(s, 3).norm());
    EXPECT_LT((sensed(s, 3) + sensed(s, 4)).head<3>().norm(), 1e-12 * sensed(s, 3).norm());
  }
}

/// Two links of which a motion holds the second one at an angle.
SceneBuilder bent_pendulum(const std::string& motion) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -kGravity};
  b.body("upper", 1.5, {0.2, 0, 0}, Vector3(0.01, 0.02, 0.02).asDiagonal());
  b.joint("hinge", JointKind::Revolute, "world", "upper", {0, 0, 0}, kAcross);
  b.body("lower", 0.8, {0.3, 0, 0}, Vector3(0.005, 0.03, 0.03).asDiagonal());
  b.joint("elbow", JointKind::Revolute, "upper", "lower", {0.5, 0, 0}, kAcross);
  initial_joint(b, "hinge", 0.3, 2);
  b.scene.motions.push_back({"elbow", TimeFunction::parse(motion), {}});
  return b;
}

// The effort of the elbow is the moment that turns the lower link: J w' + (arm x m (a - g)) along the axis.
TEST_P(ExplicitSensors, HoldAJoint) {
  const double bend = 0.7;
  Simulation s(bent_pendulum("0.7").scene, options(GetParam().name, 0.02, 1e-12));
  ASSERT_EQ(model_of(s).held.size(), 1u);
  const double start = s.energies().total();
  for (int n = 0; n < 30; ++n) {
    run(s, 1);
    const auto along = [](double angle) { return Vector3(std::cos(angle), 0, -std::sin(angle)); };
    const double angle = s.position(0), rate = s.velocity(0);
    const Vector3 gravity(0, 0, -kGravity), elbow = 0.5 * along(angle), arm = 0.3 * along(angle + bend);
    const Vector3 upper = 0.2 * along(angle), lower = elbow + arm;
    const double inertia = 0.02 + 1.5 * upper.squaredNorm() + 0.03 + 0.8 * lower.squaredNorm();
    const double change = (upper.cross(1.5 * gravity) + lower.cross(0.8 * gravity))[1] / inertia;
    const Vector3 acceleration = change * kAcross.cross(lower) - rate * rate * lower;
    EXPECT_NEAR(s.effort(1), 0.03 * change + arm.cross(0.8 * (acceleration - gravity))[1], 1e-12);
    EXPECT_EQ(s.position(1), bend);
  }
  EXPECT_EQ(s.energies().work, 0);
  EXPECT_NEAR(s.energies().total(), start, GetParam().order == 4 ? 1e-4 : 1e-9);
}

/// An arm with a joint that is held at 0.4 rad, and another held one on it, between joints that move.
SceneBuilder arm_with_held_joints(const std::string& motion) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -kGravity};
  const Matrix3 inertia = Vector3(0.02, 0.03, 0.01).asDiagonal();
  for (const char* name : {"upper", "middle", "stage", "lower"}) b.body(name, 1.5, {0, 0.05, 0.2}, inertia);
  b.joint("first", JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  b.joint("elbow", JointKind::Revolute, "upper", "middle", {0, 0, 0.4}, {0, 0.8, 0.6});
  b.joint("rail", JointKind::Prismatic, "middle", "stage", {0, 0.1, 0.4}, {0.6, 0, 0.8});
  b.joint("last", JointKind::Revolute, "stage", "lower", {0, 0, 0.4}, {0, 0.8, 0.6});
  b.scene.initial_joints.push_back({"first", 0.3, 2, {}, true});
  b.scene.initial_joints.push_back({"last", -0.5, 1, {}, true});
  b.scene.motions.push_back({"elbow", TimeFunction::parse(motion), {}});
  b.scene.motions.push_back({"rail", TimeFunction::parse(motion), {}});
  b.load("middle", {0.1, 0, 0.2}, {3, -1, 2}, {0.1, 0.2, 0.3}, "1+t", scene::LoadFrame::Follower);
  b.load("lower", {0, 0, 0.2}, {1, 2, -3});
  return b;
}

// Efforts that hold joints are those of motions that only nearly stand still, up to round-off of 1e-13/h^2 in the
// accelerations of these.
TEST_P(ExplicitSensors, HoldJointsAsMotionsDo) {
  const Simulation s = after(arm_with_held_joints("0.4"), 0.4, 40),
                   driven = after(arm_with_held_joints("0.4+1e-12*sin(t)"), 0.4, 40);
  ASSERT_EQ(model_of(s).held.size(), 2u);
  ASSERT_TRUE(model_of(driven).held.empty());
  for (const char* joint : {"elbow", "rail"}) {
    const std::size_t i = *s.find_coordinate(joint);
    EXPECT_NEAR(s.effort(i), driven.effort(i), 1e-8 * std::abs(s.effort(i)));
  }
}

// With a sensor, a joint with a constant motion is not held but driven. In short steps, too, it does not accelerate:
// what is left is the round-off of velocities over the step, not that of positions over its square.
TEST_P(ExplicitSensors, DriveWhatIsHeldWithoutThem) {
  const SceneBuilder held = arm_with_held_joints("0.4");
  SceneBuilder driven = held;
  driven.sensor("at_elbow", scene::SensorKind::Reaction, "middle");
  constexpr double kEnd = 1e-4, kRoundOff = 1e-15;
  constexpr int kSteps = 20;
  const Simulation s = after(held, kEnd, kSteps), other = after(driven, kEnd, kSteps);
  ASSERT_LT(model_of(other).held.size(), model_of(s).held.size());
  for (const char* joint : {"elbow", "rail"}) {
    const std::size_t i = *s.find_coordinate(joint), j = *other.find_coordinate(joint);
    EXPECT_NEAR(s.effort(i), other.effort(j), kRoundOff * kSteps / kEnd * std::abs(s.effort(i)));
  }
}

TEST_P(ExplicitSensors, HoldJointsAsEmDoes) {
  const SceneBuilder b = arm_with_held_joints("0.4");
  const Simulation s = after(b, 0.4, 200);
  for (const char* joint : {"elbow", "rail"})
    expect_limit_of_em(b, s, 1000, static_cast<int>(*s.find_coordinate(joint)));
}

INSTANTIATE_TEST_SUITE_P(Methods, ExplicitSensors, kExplicitMethods, method_name);

}  // namespace
}  // namespace flexarm::test
