// Tests explicit schemes: orders against closed forms, the account of energies, and what they refuse.
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "flexarm/model/model_error.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#include "math/pi.h"

namespace flexarm::test {
namespace {

Simulation simulation_of(const std::string& text, const std::string& scheme, double step) {
  const scene::ReadResult read = scene::read_scene_text(text, "explicit.urdf");
  if (!read.scene) throw std::runtime_error(scene::to_text(read.diagnostics));
  SimulationOptions options;
  options.scheme = scheme;
  options.step = step;
  return Simulation(*read.scene, options);
}

std::string link(const std::string& name, const std::string& centre, const std::string& inertias = "0.02 0.03 0.04") {
  std::istringstream numbers(inertias);
  double x, y, z;
  numbers >> x >> y >> z;
  return "<link name=\"" + name + "\"><inertial><origin xyz=\"" + centre + "\"/><mass value=\"2\"/><inertia ixx=\"" +
         std::to_string(x) + "\" iyy=\"" + std::to_string(y) + "\" izz=\"" + std::to_string(z) +
         "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>";
}

struct Method {
  const char* name;
  int order;
  double coarse;  ///< steps whose error is far above round-off, and its half
};

class ExplicitSchemes : public ::testing::TestWithParam<Method> {};

/// The slope of errors at steps that are halved.
double order_between(double coarse, double fine) {
  return std::log2(coarse / fine);
}

// A pendulum released from the horizontal comes to the other side, at rest, after half its period
// 4 K(1/2) / sqrt(m g l / J).
TEST_P(ExplicitSchemes, SwingAPendulum) {
  constexpr double kFirstKind = 1.8540746773013719184;  // K(m = 1/2)
  const double rate = std::sqrt(2 * 9.81 * 0.5 / (0.03 + 2 * 0.25)), half = 2 * kFirstKind / rate;
  const std::string text = "<robot name=\"pendulum\"><link name=\"world\"/>" + link("bob", "0.5 0 0") +
                           R"(<joint name="hinge" type="continuous"><parent link="world"/><child link="bob"/>
      <axis xyz="0 1 0"/></joint><simulation><gravity xyz="0 0 -9.81"/></simulation></robot>)";
  const auto error = [&](int steps) {
    Simulation s = simulation_of(text, GetParam().name, half / steps);
    for (int n = 0; n < steps; ++n) EXPECT_TRUE(s.step().converged);
    return std::hypot(s.position(0) - kPi, s.velocity(0) / rate);
  };
  const int steps = static_cast<int>(std::lround(half / GetParam().coarse));
  const double coarse = error(steps), fine = error(2 * steps);
  EXPECT_GT(fine, 1e-13);
  EXPECT_NEAR(order_between(coarse, fine), GetParam().order, 0.4) << coarse << " " << fine;
}

// Velocities and accelerations of output are those of the equations at the end of the step, whatever its length.
TEST_P(ExplicitSchemes, PublishVelocitiesAndAccelerations) {
  constexpr double kInertia = 0.03 + 2 * 0.25;
  const std::string text = "<robot name=\"pendulum\"><link name=\"world\"/>" + link("bob", "0.5 0 0") +
                           R"(<joint name="hinge" type="continuous"><parent link="world"/><child link="bob"/>
      <axis xyz="0 1 0"/></joint><simulation><gravity xyz="0 0 -9.81"/> <probe name="tip" link="bob" at="1 0 0"/>
      </simulation></robot>)";
  Simulation s = simulation_of(text, GetParam().name, 0.05);
  for (int n = 0; n < 12; ++n) {
    ASSERT_TRUE(s.step().converged);
    const double angle = s.position(0), rate = s.velocity(0), change = 2 * 9.81 * 0.5 * std::cos(angle) / kInertia;
    const Vector3 along(std::cos(angle), 0, -std::sin(angle)), across(-std::sin(angle), 0, -std::cos(angle));
    const ProbeAcceleration acceleration = s.probe_acceleration(0);
    EXPECT_LT((s.probe(0).velocity - rate * across).norm(), 1e-13);
    EXPECT_LT((acceleration.linear - change * across + rate * rate * along).norm(), 1e-12);
    EXPECT_LT((acceleration.angular - Vector3(0, change, 0)).norm(), 1e-12);
  }
}

// A symmetric top without loads: its axis turns about the angular momentum L with |L| / A, and it spins about the axis
// with w (A - C) / A; A, C: moments of inertia across and along the axis, w: the angular velocity along it.
TEST_P(ExplicitSchemes, SpinATop) {
  const std::string text = "<robot name=\"top\"><link name=\"world\"/>" + link("top", "0 0 0", "0.3 0.3 0.5") +
                           R"(<joint name="free" type="floating"><parent link="world"/><child link="top"/></joint>
      <simulation><gravity xyz="0 0 0"/><initial link="top" linear="0.3 -0.2 0.1" angular="0.8 0 2"/></simulation></robot>)";
  constexpr double kTime = 4;
  const Vector3 momentum(0.3 * 0.8, 0, 0.5 * 2);
  const Quaternion turned = Quaternion(Eigen::AngleAxisd(kTime * momentum.norm() / 0.3, momentum.normalized())) *
                            Quaternion(Eigen::AngleAxisd(kTime * 2 * (0.3 - 0.5) / 0.3, Vector3::UnitZ()));
  const auto error = [&](int steps) {
    Simulation s = simulation_of(text, GetParam().name, kTime / steps);
    for (int n = 0; n < steps; ++n) EXPECT_TRUE(s.step().converged);
    const Pose pose = s.link_pose(1);
    EXPECT_LT((pose.position - kTime * Vector3(0.3, -0.2, 0.1)).norm(), 1e-12);
    return pose.orientation.angularDistance(turned);
  };
  const int steps = static_cast<int>(std::lround(kTime / GetParam().coarse));
  const double coarse = error(steps), fine = error(2 * steps);
  EXPECT_GT(fine, 1e-13);
  EXPECT_NEAR(order_between(coarse, fine), GetParam().order, 0.4) << coarse << " " << fine;
}

// Two links with springs, dampers, smooth friction, rotors, an effort and a load: what the energy lacks is the work and
// what was dissipated, up to the error of the steps. Results are those of em4 with short steps.
TEST_P(ExplicitSchemes, KeepTheAccount) {
  const std::string text =
      "<robot name=\"arm\"><link name=\"world\"/>" + link("upper", "0.3 0 0") + link("fore", "0.2 0.1 0") + R"xml(
    <joint name="shoulder" type="continuous"><parent link="world"/><child link="upper"/> <axis xyz="0 1 0"/>
      <dynamics damping="0.3"/></joint>
    <joint name="elbow" type="prismatic"><parent link="upper"/><child link="fore"/> <axis xyz="1 0 0"/>
      <origin xyz="0.6 0 0" rpy="0.3 0 0.2"/> <limit lower="-2" upper="2" effort="100" velocity="9"/>
      <dynamics damping="1"/></joint>
    <spring joint="elbow" stiffness="60" rest="0.1"/> <drive joint="shoulder" rotor_inertia="0.1"/>
    <simulation><gravity xyz="0 0 -9.81"/> <effort joint="shoulder" history="3*sin(5*t)"/>
      <load link="fore" at="0.1 0 0.2" force="2 -1 3" frame="follower" history="1+t"/> </simulation></robot>)xml";
  const double step = GetParam().order == 4 ? 2e-3 : 1e-2;
  Simulation s = simulation_of(text, GetParam().name, step), reference = simulation_of(text, "em4", 1e-3);
  const double start = s.energies().total();
  while (s.time() < 1 - 1e-9) {
    ASSERT_TRUE(s.step().converged);
    const Energies now = s.energies();
    EXPECT_NEAR(now.total() + now.dissipated - now.work, start, 1e-6);  // energies of 10 J
  }
  while (reference.time() < 1 - 1e-9) ASSERT_TRUE(reference.step().converged);
  EXPECT_GT(s.energies().dissipated, 0.1);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(s.position(i), reference.position(i), 1e-6);
    EXPECT_NEAR(s.velocity(i), reference.velocity(i), 1e-4);
    EXPECT_NEAR(s.effort(i), reference.effort(i), 1e-2);  // em4's is the mean over its last step
  }
  EXPECT_NEAR(s.energies().dissipated, reference.energies().dissipated, 1e-5);
  EXPECT_NEAR(s.energies().work, reference.energies().work, 1e-5);
}

TEST_P(ExplicitSchemes, GoOnFromARestoredStateBitByBit) {
  const std::string text =
      "<robot name=\"arm\"><link name=\"world\"/>" + link("upper", "0.3 0 0") + link("fore", "0.2 0.1 0") + R"xml(
    <joint name="shoulder" type="continuous"><parent link="world"/><child link="upper"/> <axis xyz="0 0.6 0.8"/></joint>
    <joint name="ball" type="spherical"><parent link="upper"/><child link="fore"/> <origin xyz="0.6 0 0"/></joint>
    <simulation><gravity xyz="0 0 -9.81"/></simulation></robot>)xml";
  const scene::ReadResult read = scene::read_scene_text(text, "explicit.urdf");
  ASSERT_TRUE(read.scene) << scene::to_text(read.diagnostics);
  SimulationOptions options;
  options.scheme = GetParam().name;
  options.reuse_factorisation = false;
  Simulation s(*read.scene, options);
  for (int n = 0; n < 7; ++n) ASSERT_TRUE(s.step().converged);
  const Snapshot middle = s.snapshot();
  for (int n = 0; n < 9; ++n) ASSERT_TRUE(s.step().converged);
  const Pose end = s.link_pose(2);
  s.restore(middle);
  for (int n = 0; n < 9; ++n) ASSERT_TRUE(s.step().converged);
  EXPECT_EQ(s.link_pose(2).position, end.position);
  EXPECT_EQ(s.link_pose(2).orientation.coeffs(), end.orientation.coeffs());
}

// What a step had computed when it failed is not used by later ones.
TEST_P(ExplicitSchemes, GoOnAfterAFailure) {
  const std::string text = "<robot name=\"arm\"><link name=\"world\"/>" + link("arm", "0.3 0 0") + R"xml(
    <joint name="hinge" type="continuous"><parent link="world"/><child link="arm"/> <axis xyz="0 1 0"/></joint>
    <simulation><load link="arm" at="1 0 0" force="0 0 1" history="t &lt; 0.55 ? 1 : sqrt(-1)"/></simulation></robot>)xml";
  Simulation s = simulation_of(text, GetParam().name, 0.1);
  for (int n = 0; n < 5; ++n) ASSERT_TRUE(s.step().converged);
  EXPECT_FALSE(s.step().converged);
  EXPECT_GT(s.time(), 0.54);  // sub-steps went on after the first one had failed
  EXPECT_LE(s.time(), 0.55);
  EXPECT_TRUE(std::isfinite(s.energies().total()));
}

// A scene with something that explicit schemes do not have is refused by name.
TEST_P(ExplicitSchemes, RefuseWhatTheyDoNotHave) {
  const auto refusal = [&](const std::string& parts, const std::string& options = "") {
    try {
      simulation_of("<robot name=\"arm\"><link name=\"world\"/>" + link("arm", "0.3 0 0") + parts + "<simulation>" +
                        options + "</simulation></robot>",
                    GetParam().name, 1e-3);
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::string hinge = R"(<joint name="hinge" type="continuous"><parent link="world"/><child link="arm"/>)",
                    end = "</joint>";
  EXPECT_EQ(refusal(hinge + end), "accepted");
  const std::string refused = std::string("scheme '") + GetParam().name + "' has no ";
  const auto expect_no = [&](const std::string& what, const std::string& text) {
    EXPECT_NE(text.find(refused + what), std::string::npos) << text;
  };
  expect_no("prescribed motions", refusal(hinge + end, R"(<motion joint="hinge" position="t"/>)"));
  expect_no("servos", refusal(hinge + end + R"(<servo joint="hinge" mode="position" kp="4" kd="1" set_point="1"/>)"));
  expect_no("dry friction", refusal(hinge + R"(<dynamics friction="1"/><friction law="coulomb"/>)" + end));
  expect_no("springs, lines or contacts", refusal(hinge + end + R"(<spring name="coil" stiffness="1" rest_length="1"
      from="world" from_at="1 1 0" to="arm" to_at="0 0 1"/>)"));
  expect_no("flexible links", refusal(hinge + end + R"(<joint name="glue" type="fixed"><parent link="arm"/>
      <child link="rod"/></joint><link name="rod"><beam elements="1"><centerline><line to="1 0 0"/></centerline>
      <section ea="1e5" ga2="4e4" ga3="4e4" gj="20" ei2="30" ei3="30" mass="1" j1="1e-3" j2="5e-4" j3="5e-4"/></beam></link>)"));
}

INSTANTIATE_TEST_SUITE_P(Methods, ExplicitSchemes, ::testing::Values(Method{"rk4", 4, 0.05}, Method{"dop853", 8, 0.25}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace flexarm::test
