// Tests the linearised equations against differences of the nonlinear equations along the motion.
#include "analysis/linear_dynamics.h"

#include <array>
#include <cmath>

#include "building/model_builder.h"
#include "simulation/observables.h"
#include "support/dense_solution.h"
#include "support/loops.h"
#include "support/scene_builder.h"
#include "support/scene_text.h"

namespace flexarm {
namespace {

using namespace test;
using Eigen::VectorXd;

/// Velocities of all nodes and coordinates, from rates of the mechanism's coordinates.
KnownRates rates_by(const Model& model, const DegreesOfFreedom& dof, const MotionMaps& maps, const MechanismPose& pose,
                    const VectorXd& rates) {
  const VectorXd rows = maps.at(pose) * rates;
  KnownRates out;
  for (int i = 0; i < dof.node_count; ++i) {
    out.nodes.emplace_back(rows.segment<6>(dof.first[i]));
    out.nodes.back().tail<3>() = (pose.nodes[i].rotation * out.nodes.back().tail<3>()).eval();
  }
  for (const Coordinate& coordinate : model.coordinates) out.coordinates.push_back(rows[dof.scalar_of(coordinate)]);
  return out;
}

State placed(State state, const MechanismPose& pose) {
  const State at = state_at(pose);
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    state.nodes[i].position = at.nodes[i].position;
    state.nodes[i].orientation = at.nodes[i].orientation;
  }
  state.released = pose.released;
  return state;
}

/// Relative error of y''' about a bent state that moves in all coordinates. Two values are compared: the difference
/// quotient of y'' over `time` along the motion, and the solution of M y''' + C y'' + K y' = 0. They are equal, because
/// the linearised equations also hold for the motion shifted in time. The scheme has Lagrange test functions, since for
/// them the static tangent is the exact derivative.
double error_of_third_derivative(const Model& model, double time) {
  const Scheme scheme = *find_scheme("newmark");
  const DegreesOfFreedom dof(model);
  const MotionMaps maps(model, dof);
  State start = initial_state(model);
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    start.actuators[i].angle = 0.2 - 0.3 * static_cast<double>(i);
    start.actuators[i].rate = -0.4 + 0.7 * static_cast<double>(i);
  }
  VectorXd rates(maps.columns());
  for (Eigen::Index i = 0; i < rates.size(); ++i) rates[i] = 0.3 * std::sin(1.7 * static_cast<double>(i) + 1);
  const VectorXd none = VectorXd::Zero(rates.size());
  const auto at = [&](const MechanismPose& pose, const VectorXd& own, const std::vector<ActuatorState>& actuators) {
    State state = placed(start, pose);
    state.actuators = actuators;
    KnownRates known = rates_by(model, dof, maps, pose, own);
    for (const ActuatorState& actuator : actuators) known.rotors.push_back(actuator.rate);
    return LinearDynamics(model, state, scheme, Reference::Instant, known);
  };
  const MechanismPose straight = maps.moved(pose_of(start), {none, none}, 0);
  // Without loops, any pose is possible. With loops, only the independent coordinates move.
  const MechanismPose pose = model.closures.empty() ? maps.moved(straight, {rates, none}, 0.2) : straight;
  const LinearDynamics dynamics = at(pose, rates, start.actuators);
  const auto columns = [&](const VectorXd& own) {
    VectorXd all = VectorXd::Zero(rates.size());
    for (std::size_t i = 0; i < dynamics.scalars().size(); ++i)
      all[dof.equation[dynamics.scalars()[i]]] = own[static_cast<Eigen::Index>(i)];
    return all;
  };
  const CoordinateRates way = dynamics.rates_of_columns();
  const auto rotors_ahead = [&](double ahead) {
    std::vector<ActuatorState> actuators = start.actuators;
    const Eigen::Index count = static_cast<Eigen::Index>(dynamics.rotors().size());
    for (Eigen::Index r = 0; r < count; ++r) {
      ActuatorState& rotor = actuators[dynamics.rotors()[r]];
      const double acceleration = dynamics.accelerations().tail(count)[r];
      rotor.angle += ahead * (rotor.rate + 0.5 * ahead * acceleration);
      rotor.rate += ahead * acceleration;
    }
    return actuators;
  };
  std::array<VectorXd, 2> accelerations;
  for (const int side : {0, 1}) {
    const double ahead = side ? time : -time;
    accelerations[side] = at(maps.moved(pose, way, ahead), columns(dynamics.rates() + ahead * dynamics.accelerations()),
                             rotors_ahead(ahead))
                              .accelerations();
  }
  const VectorXd difference = (accelerations[1] - accelerations[0]) / (2 * time);
  const VectorXd third = solution(
      dynamics.mass(), -dynamics.stiffness() * dynamics.rates() - dynamics.damping() * dynamics.accelerations());
  return (difference - third).norm() / third.norm();
}

/// `time` must be short for the fastest motion; a tenth of it must be long for the round-off of differences.
void expect_second_order(const Model& model, double time) {
  const double large = error_of_third_derivative(model, time), small = error_of_third_derivative(model, 0.1 * time);
  EXPECT_NEAR(std::log10(large / small), 2, 0.02) << large << ", " << small;
}

const scene::DirectSection kSoft = section(1e3, 4e2, 8, 10, 1, 2e-2, 1e-2);
const Matrix3 kInertia = (Matrix3() << 0.1, 0.01, 0.02, 0.01, 0.2, -0.03, 0.02, -0.03, 0.25).finished();

TEST(LinearDynamics, OfAFlexibleArmInMotion) {
  SceneBuilder builder;
  builder.scene.gravity = Vector3(0, 0.5, -2);
  builder.beam("upper", {Vector3(1, 0, 0)}, kSoft, 2, 2);
  builder.beam("fore", {Vector3(1, 0, 0)}, kSoft, 1, 3);
  builder.body("load", 2, Vector3(0.1, 0.1, -0.05), kInertia);
  builder.joint("shoulder", scene::JointKind::Spherical, "world", "upper");
  builder.joint("elbow", scene::JointKind::Continuous, "upper", "fore", Vector3(1, 0, 0), Vector3::UnitY()).damping =
      0.3;
  builder.joint("grip", scene::JointKind::Prismatic, "fore", "load", Vector3(1, 0, 0), Vector3::UnitZ());
  expect_second_order(build_model(builder.scene), 3e-4);
}

/// A box that falls onto a floor at 1 m/s, 1 mm above it, with a swinging body on a damped line.
Model falling_box(const std::string& contact) {
  return build_model(scene_of(robot(
      "<ground name='floor'/>" +
      joint("guide", "prismatic", "world", "box", "<origin xyz='0 0 0.101'/><axis xyz='0 0 1'/>" + kFarLimits) +
      body("box", 1, Vector3::Constant(0.01), Vector3::Zero(), collision("<box size='0.2 0.2 0.2'/>")) +
      joint("hinge", "continuous", "box", "arm", "<origin xyz='0 0 1'/><axis xyz='0 1 0'/><dynamics damping='0.3'/>") +
      body("arm", 0.5, Vector3::Constant(0.01), {0.3, 0, 0}) +
      "<tendon name='line' ea='30' damping='4' rest_length='0.5'> <via link='world' at='0.5 0 2'/>"
      "<via link='arm' at='0.3 0 0'/> </tendon>" +
      contact)));
}

// The poses from which differences along the motion are taken are centimetres apart, and the box touches at some of
// them. Before it touches, a contact changes nothing.
TEST(LinearDynamics, OfWhatIsAboutToTouch) {
  const auto dynamics_of = [](const Model& model) {
    const DegreesOfFreedom dof(model);
    const MotionMaps maps(model, dof);
    const State state = initial_state(model);
    const VectorXd rates = Eigen::Vector2d(-1, 0.7);
    return LinearDynamics(model, state, *find_scheme("em"), Reference::Instant,
                          rates_by(model, dof, maps, pose_of(state), rates));
  };
  const Model touching = falling_box(R"(<contact first="box" second="floor"/>)"), free = falling_box("");
  const LinearDynamics expected = dynamics_of(free), got = dynamics_of(touching);
  ASSERT_EQ(got.size(), 2);
  EXPECT_EQ(got.stiffness(), expected.stiffness());
  EXPECT_EQ(got.damping(), expected.damping());
  EXPECT_EQ(got.residual(), expected.residual());
}

/// A drive with its motor on `coordinate` behind an elastic gear.
scene::DriveDescription drive(const std::string& coordinate, double inertia, double stiffness, double damping) {
  scene::DriveDescription out;
  out.coordinate = coordinate;
  out.gear = 1;
  out.rotor_inertia = inertia;
  out.stiffness = stiffness;
  out.damping = damping;
  return out;
}

scene::ServoDescription servo(const std::string& coordinate, double kp, double kd) {
  scene::ServoDescription out;
  out.coordinate = coordinate;
  out.kp = kp;
  out.kd = kd;
  return out;
}

/// A loop of rigid links with dampers in its joints.
SceneBuilder damped_four_bar() {
  SceneBuilder builder;
  builder.scene.gravity = Vector3(0, 0, -3);
  for (const char* name : {"crank", "rocker", "coupler"}) builder.body(name, 2, Vector3(0.1, 0.1, -0.05), kInertia);
  const Vector3 y = Vector3::UnitY();
  builder.joint("root", scene::JointKind::Continuous, "world", "crank", Vector3::Zero(), y);
  builder.joint("knee", scene::JointKind::Continuous, "crank", "coupler", Vector3(0, 0, -0.7), y);
  builder.joint("foot", scene::JointKind::Continuous, "world", "rocker", Vector3(1, 0, 0.2), y);
  close_loop(builder, "hip", scene::JointKind::Continuous, "coupler", "rocker", Vector3(0, 0, -0.9), y);
  for (scene::JointDescription& joint : builder.scene.joints) joint.damping = 0.4;
  return builder;
}

TEST(LinearDynamics, OfALoopInMotion) {
  SceneBuilder builder = damped_four_bar();
  for (scene::JointDescription& joint : builder.scene.joints) joint.damping = 0;
  const Model model = build_model(builder.scene);
  ASSERT_FALSE(model.closures.empty());
  expect_second_order(model, 3e-3);
}

// The directions of efforts on coordinates that the loop determines change with the other coordinates.
TEST(LinearDynamics, OfALoopWithDampersInMotion) {
  expect_second_order(build_model(damped_four_bar().scene), 3e-3);
}

TEST(LinearDynamics, OfRotorsBehindElasticGearsInMotion) {
  SceneBuilder builder;
  builder.scene.gravity = Vector3(0, 0.5, -2);
  builder.beam("upper", {Vector3(1, 0, 0)}, kSoft, 2, 2);
  builder.body("load", 2, Vector3(0.1, 0.1, -0.05), kInertia);
  builder.joint("shoulder", scene::JointKind::Continuous, "world", "upper", Vector3::Zero(), Vector3::UnitZ());
  builder.joint("wrist", scene::JointKind::Continuous, "upper", "load", Vector3(1, 0, 0), Vector3::UnitY());
  builder.scene.drives = {drive("shoulder", 0.4, 50, 0.7), drive("wrist", 0.1, 20, 0.3)};
  builder.scene.servos = {servo("shoulder", 30, 2), servo("wrist", 5, 0.4)};
  builder.scene.servos[1].side = scene::ServoDescription::Side::Link;
  expect_second_order(build_model(builder.scene), 3e-4);
}

TEST(LinearDynamics, OfAMotorOnALoopInMotion) {
  SceneBuilder builder = damped_four_bar();
  builder.scene.drives = {drive("root", 0.4, 50, 0.7), drive("foot", 0.1, 20, 0.3)};
  builder.scene.servos = {servo("root", 30, 2), servo("foot", 5, 0.4)};
  expect_second_order(build_model(builder.scene), 3e-3);
}

}  // namespace
}  // namespace flexarm
