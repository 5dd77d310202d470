// Tests linear models against closed forms, and against runs of the simulator.
#include "flexarm/simulation/linear_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "math/pi.h"
#include "simulation/step_resolution.h"
#include "support/dense_solution.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Simulation simulation_of(const std::string& text) {
  return Simulation(test::scene_of(text));
}

// ---------------------------------------------------------------- closed forms

std::string rotating_cantilever(double speed, const std::string& integrator = "") {
  // EI = m = L = 1, so that speeds and frequencies are dimensionless. The beam is so thin that shear and stretching
  // change frequencies by less than 1e-6: EI / (EA L^2) = EI / (GA L^2) = 1e-8.
  return fmt::format(R"(<robot name="rotor"><link name="world"/>
    <joint name="hub" type="continuous"> <parent link="world"/> <child link="blade"/> <axis xyz="0 0 1"/> </joint>
    <link name="blade"> <beam elements="8" order="3"> <centerline> <line to="1 0 0"/> </centerline>
      <section ea="1e8" ga2="1e8" ga3="1e8" gj="1" ei2="1" ei3="1e4" mass="1" j1="2e-8" j2="1e-8" j3="1e-8"/>
    </beam> </link>
    <simulation> <gravity xyz="0 0 0"/> <motion joint="hub" position="{} * t"/> {} </simulation> </robot>)",
                     speed, integrator);
}

// Published frequencies of flapwise bending without hub radius: Wright, Smith, Thresher and Wang, Vibration modes of
// centrifugally stiffened beams, J. Appl. Mech. 49, 1982. The seven digits come from the method of Ritz with twenty
// polynomials.
TEST(LinearModel, RotatingCantilever) {
  const std::vector<std::pair<double, std::array<double, 3>>> published = {{0, {3.516015, 22.034492, 61.697214}},
                                                                           {2, {4.137320, 22.614922, 62.273184}},
                                                                           {6, {7.360373, 26.809082, 66.683914}},
                                                                           {12, {13.170150, 37.603112, 79.614478}}};
  for (const auto& [speed, frequencies] : published) {
    LinearRequest request;
    request.about = LinearisedAbout::Steady;
    request.outputs = {"position:blade/tip:z"};
    const LinearModel model = linearise(simulation_of(rotating_cantilever(speed)), request);
    std::vector<double> flap;
    for (const Pole& pole : poles(model))
      if (pole.mode.size() > 0 && std::abs((model.c * pole.mode)[0]) > 0.1) flap.push_back(std::abs(pole.value));
    ASSERT_GE(flap.size(), 3u);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(flap[i] / frequencies[i], 1, 5e-5) << "speed " << speed;
  }
}

// Linear models have local strains and the spin form, whatever interpolation and weak form the steps have.
TEST(LinearModel, OfSchemesWithOtherInterpolations) {
  LinearRequest request;
  request.about = LinearisedAbout::Steady;
  for (const char* more : {"", "interpolation='incremental'", "interpolation='total' weak_form='additive'"}) {
    const std::string integrator = fmt::format("<integrator scheme='newmark' {}/>", more);
    double lowest = 1e9;
    for (const Pole& pole : poles(linearise(simulation_of(rotating_cantilever(0, integrator)), request)))
      lowest = std::min(lowest, std::abs(pole.value));
    EXPECT_NEAR(lowest / 3.516015, 1, 5e-5) << integrator;
  }
}

// A disc on a shaft that may tilt: It theta'' + Ip speed (i theta') + k theta = 0, where theta is the rotation about x
// plus i times that about y.
TEST(LinearModel, WhirlingDisc) {
  const double transverse = 2, polar = 3, stiffness = 50, speed = 7;
  LinearRequest request;
  request.about = LinearisedAbout::Steady;
  const LinearModel model = linearise(simulation_of(fmt::format(R"(<robot name="disc"><link name="world"/>
    <joint name="tilt" type="floating"> <parent link="world"/> <child link="shaft"/> <axis xyz="1 0 0"/>
      <axis2 xyz="0 1 0"/> <release kind="universal"/> </joint>
    <link name="shaft"/>
    <joint name="spin" type="continuous"> <parent link="shaft"/> <child link="disc"/> <axis xyz="0 0 1"/> </joint>
    <link name="disc"> <inertial> <mass value="1"/>
      <inertia ixx="{0}" iyy="{0}" izz="{1}" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <spring joint="tilt/1" stiffness="{2}"/> <spring joint="tilt/2" stiffness="{2}"/>
    <simulation> <gravity xyz="0 0 0"/> <motion joint="spin" position="{3} * t"/> </simulation> </robot>)",
                                                                transverse, polar, stiffness, speed)),
                                      request);
  const std::vector<Pole> found = poles(model);
  ASSERT_EQ(found.size(), 2u);
  const double half = polar * speed / (2 * transverse), root = std::sqrt(half * half + stiffness / transverse);
  EXPECT_NEAR(found[0].value.imag(), root - half, 1e-9);
  EXPECT_NEAR(found[1].value.imag(), root + half, 1e-9);
  EXPECT_NEAR(found[0].value.real(), 0, 1e-9);
}

// Stiffness-proportional damping eta gives the damping ratio pi f eta.
TEST(LinearModel, KelvinVoigtDamping) {
  const double eta = 1e-4;
  const LinearModel model = linearise(simulation_of(fmt::format(R"(<robot name="cantilever"><link name="world"/>
    <joint name="clamp" type="fixed"> <parent link="world"/> <child link="beam"/> </joint>
    <link name="beam"> <beam elements="4" order="2"> <centerline> <line to="1 0 0"/> </centerline>
      <circle radius="0.01"/> <material young="70e9" poisson="0.33" density="2700"/>
      <damping stiffness_proportional="{}"/> </beam> </link>
    <simulation> <gravity xyz="0 0 0"/> </simulation> </robot>)",
                                                                eta)));
  int seen = 0;
  // Strongly damped modes are left out: near a damping ratio of 1, the two poles of a mode nearly coincide, and lose
  // half of the digits.
  for (const Pole& pole : poles(model)) {
    if (pole.damping_ratio() > 0.9) continue;
    const double undamped = std::abs(pole.value) / (2 * kPi);
    EXPECT_NEAR(pole.damping_ratio() / (kPi * undamped * eta), 1, 1e-6);
    ++seen;
  }
  EXPECT_GT(seen, 4);
}

std::string gauged_cantilever(const std::string& load) {
  // The nodes stand at the centre of mass. It lies off the reference line, to which strains and forces refer.
  return R"(<robot name="cantilever"><link name="world"/>
    <joint name="clamp" type="fixed"> <parent link="world"/> <child link="beam"/> </joint>
    <link name="beam"> <beam elements="3" order="2"> <centerline> <line to="1.2 0 0"/> </centerline>
      <section_matrix stiffness="1e6 0 0 0 0 0  0 1e5 0 0 0 0  0 0 1e5 0 0 0  0 0 0 200 0 0  0 0 0 0 250 0  0 0 0 0 0 300"
        inertia="0.5 0 0 0 -0.01 -0.015  0 0.5 0 0.01 0 0  0 0 0.5 0.015 0 0
                 0 0.01 0.015 0.03 0 0  -0.01 0 0 0 0.02 0  -0.015 0 0 0 0 0.01"/>
    </beam> </link>
    <sensor name="gauge" kind="strain" link="beam" at="0.31 0.02 -0.03"/>
    <sensor name="section" kind="section_force" link="beam" at="0.31 0 0"/>
    <simulation> <gravity xyz="0 0 0"/> <integrator scheme="newmark" tolerance="1e-13"/> )" +
         load + "</simulation> </robot>";
}

/// Outputs per unit of a constant input, in the limit of long times.
VectorXd static_gain(const LinearModel& model) {
  return model.d - model.c * test::solution(model.a, model.b);
}

// A force P at the tip gives the bending moment M(s) = P (L - s), which the elements represent exactly. The fibre at y
// has the strain -y M/EI.
TEST(LinearModel, StrainGaugeByBeamTheory) {
  LinearRequest request;
  request.inputs = {"wrench:beam/tip:fy"};
  request.outputs = {"strain:gauge", "section_force:section"};
  const LinearModel model = linearise(simulation_of(gauged_cantilever("")), request);
  ASSERT_EQ(model.outputs,
            (std::vector<std::string>{"strain:gauge", "section_force:section:fx", "section_force:section:fy",
                                      "section_force:section:fz", "section_force:section:mx",
                                      "section_force:section:my", "section_force:section:mz"}));
  const VectorXd gain = static_gain(model);
  const double arm = 1.2 - 0.31;
  // Tolerance: the round-off of displacements is 1e-16 times the ratio of squared frequencies, 1e5. Forces are
  // differences of displacements of 1e-3 m over an element of 0.2 m, times 1e6 N.
  EXPECT_NEAR(gain[0], -0.02 * arm / 300, 1e-7 * arm / 300);
  EXPECT_NEAR(gain[2], 1, 1e-7);
  EXPECT_NEAR(gain[6], arm, 1e-7);
  for (const int none : {1, 3, 4, 5}) EXPECT_NEAR(gain[none], 0, 1e-7);
}

// The same for a strongly bent beam, against differences of equilibria under loads that differ by h, with an error of
// h^2.
TEST(LinearModel, StrainGaugeOfABentBeam) {
  const double force = 150, way = 1e-2;
  const auto load = [](double value) {
    return fmt::format(R"(<load link="beam" at="1.2 0 0" force="0 {} 10"/>)", value);
  };
  const auto sampled = [&](double value) {
    Simulation simulation = simulation_of(gauged_cantilever(load(value)));
    if (!simulation.solve_static(10).converged) throw std::runtime_error("no equilibrium");
    VectorXd values(7);
    values[0] = simulation.sample(0).values[0];
    for (int i = 0; i < 6; ++i) values[1 + i] = simulation.sample(1).values[i];
    return values;
  };
  const VectorXd expected = (sampled(force + way) - sampled(force - way)) / (2 * way);
  Simulation simulation = simulation_of(gauged_cantilever(load(force)));
  ASSERT_TRUE(simulation.solve_static(10).converged);
  LinearRequest request;
  request.inputs = {"wrench:beam/tip:fy"};
  request.outputs = {"strain:gauge", "section_force:section"};
  const VectorXd gain = static_gain(linearise(simulation, request));
  EXPECT_LT(std::abs(gain[0] - expected[0]), 1e-6 * std::abs(expected[0]));
  EXPECT_LT((gain - expected).norm(), 1e-6 * expected.norm());
}

// ---------------------------------------------------------------- against the simulator

constexpr const char* kBody = R"(<inertial> <origin xyz="{0} 0.1 -0.05"/> <mass value="2"/>
  <inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0.01" ixz="0.02" iyz="-0.03"/> </inertial>)";

/// Two rigid links in series with joints about different axes, and a third one on a prismatic joint.
std::string rigid_arm(const std::string& more = "", const std::string& gravity = "1 2 -9.81") {
  const std::string body = fmt::format(kBody, 0.4);
  return R"(<robot name="arm"><link name="world"/>
    <joint name="yaw" type="continuous"> <parent link="world"/> <child link="upper"/> <axis xyz="0 0 1"/>
      <dynamics damping="0.3"/> </joint> <link name="upper">)" +
         body + R"(</link>
    <joint name="pitch" type="continuous"> <parent link="upper"/> <child link="boom"/> <origin xyz="0.8 0 0"/>
      <axis xyz="0 0.8 0.6"/> </joint> <link name="boom">)" +
         body + R"(</link>
    <joint name="travel" type="prismatic"> <parent link="boom"/> <child link="hand"/> <origin xyz="0.5 0 0"/>
      <axis xyz="0.6 0 0.8"/> <limit lower="-9" upper="9" effort="100" velocity="9"/> </joint> <link name="hand">)" +
         body + R"(</link> <spring joint="pitch" stiffness="30"/> <spring joint="travel" stiffness="200"/>
    <simulation> <gravity xyz=")" +
         gravity + R"("/> )" + more + R"( </simulation> </robot>)";
}

/// Exact accelerations y'' at present, from the drift of the linear model. The drift contains the forces, but not their
/// derivatives, which are to be tested.
VectorXd accelerations(const Simulation& simulation) {
  LinearRequest request;
  request.about = LinearisedAbout::Instant;
  const VectorXd drift = linearise(simulation, request).drift;
  return drift.tail(drift.size() / 2);
}

/// Compares the state matrix A at present with central differences of accelerations with respect to joint positions and
/// velocities. Their step of 1e-4 gives a truncation error of second order and a round-off of 1e-12.
void expect_exact_state_matrix(const std::string& scene) {
  Simulation simulation = simulation_of(scene);
  LinearRequest request;
  request.about = LinearisedAbout::Instant;
  std::vector<CoordinateState> start;
  const std::size_t count = simulation.coordinate_names().size();
  for (std::size_t i = 0; i < count; ++i) start.push_back({i, 0.3 - 0.2 * double(i), 0.7 + 0.4 * double(i)});
  simulation.set_joint_state(start);
  const LinearModel model = linearise(simulation, request);
  ASSERT_EQ(model.a.rows(), 2 * static_cast<Eigen::Index>(count));
  const double way = 1e-4, scale = model.a.cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < 2 * count; ++k) {
    std::array<VectorXd, 2> at;
    for (const int side : {0, 1}) {
      std::vector<CoordinateState> moved = start;
      (k < count ? *moved[k].position : *moved[k - count].velocity) += side ? way : -way;
      simulation.set_joint_state(moved);
      at[side] = accelerations(simulation);
    }
    const VectorXd difference = (at[1] - at[0]) / (2 * way);
    const VectorXd column = model.a.col(static_cast<Eigen::Index>(k)).tail(static_cast<Eigen::Index>(count));
    EXPECT_LT((difference - column).cwiseAbs().maxCoeff(), 100 * way * way * scale) << "state " << model.states[k];
  }
}

TEST(LinearModel, StateMatrixOfMovingRigidArm) {
  expect_exact_state_matrix(rigid_arm());
}

/// Difference of outputs between simulator and linear model after a run from equilibrium under a constant effort. The
/// linear model is stepped by the implicit midpoint rule, to which the energy-momentum scheme reduces for small
/// motions. So the difference comes only from nonlinearity, whatever the step.
VectorXd defect(const std::string& text, const std::string& joint, const std::string& output, double effort,
                double step = 0.01) {
  const int steps = static_cast<int>(std::lround(0.4 / step));
  scene::SceneDescription description = test::scene_of(text);
  description.starts_in_equilibrium = true;
  Simulation simulation(std::move(description), test::options("em", step, 1e-13));
  LinearRequest request;
  request.inputs = {"effort:" + joint};
  request.outputs = {"position:" + joint, "position:" + output + ":x", "position:" + output + ":y",
                     "position:" + output + ":z"};
  const LinearModel model = linearise(simulation, request);
  const std::size_t coordinate = *simulation.find_coordinate(joint), link = *[&]() -> std::optional<std::size_t> {
    for (std::size_t i = 0; i < simulation.link_names().size(); ++i)
      if (simulation.link_names()[i] == output) return i;
    return std::nullopt;
  }();
  const auto outputs = [&](const Simulation& simulation) {
    VectorXd values(4);
    values << simulation.position(coordinate), simulation.link_pose(link).position;
    return values;
  };
  const VectorXd start = outputs(simulation);
  simulation.command_effort(coordinate, effort);
  const MatrixXd half = 0.5 * simulation.step_size() * model.a, one = MatrixXd::Identity(half.rows(), half.cols());
  VectorXd state = VectorXd::Zero(half.rows());
  for (int n = 0; n < steps; ++n) {
    if (!simulation.step().converged) throw std::runtime_error("a step failed");
    state = test::solution(one - half, (one + half) * state + simulation.step_size() * effort * model.b.col(0));
  }
  return outputs(simulation) - start - model.c * state;
}

/// Expects the difference of defect() to fall with the square of the amplitude.
void expect_quadratic_defect(const std::string& text, const std::string& joint, const std::string& output,
                             double effort) {
  const double large = defect(text, joint, output, effort).norm(),
               small = defect(text, joint, output, effort / 4).norm();
  EXPECT_NEAR(std::log(large / small) / std::log(4.0), 2, 0.1) << large << ", " << small;
}

constexpr const char* kBeam = R"(<beam elements="2" order="2"> <centerline> <line to="1 0 0"/> </centerline>
  <section ea="1e4" ga2="4e3" ga3="4e3" gj="8" ei2="10" ei3="12" mass="1" j1="2e-3" j2="1e-3" j3="1e-3"/>
  <damping stiffness_proportional="{}" mass_proportional="0.3"/> </beam>)";
/// A beam, by default without damping of strains: the scheme integrates this damping by another rule than the midpoint
/// rule (see DefectOfDampedArmFallsWithTheStep).
std::string beam(double stiffness_damping = 0) {
  return fmt::format(kBeam, stiffness_damping);
}

std::string flexible_arm(double stiffness_damping) {
  return fmt::format(R"(<robot name="arm"><link name="world"/>
    <joint name="shoulder" type="continuous"> <parent link="world"/> <child link="upper"/> <axis xyz="0 0.6 0.8"/>
      <dynamics damping="0.2"/> </joint> <link name="upper">{0}</link>
    <joint name="elbow" type="continuous"> <parent link="upper"/> <child link="fore"/> <origin xyz="1 0 0"/>
      <axis xyz="0 1 0"/> </joint> <link name="fore">{0}</link>
    <joint name="grip" type="fixed"> <parent link="fore"/> <child link="load"/> <origin xyz="1 0 0"/> </joint>
    <link name="load">{1}</link>
    <spring joint="shoulder" stiffness="60"/> <spring joint="elbow" stiffness="40" rest="0.5"/>
    <simulation> <gravity xyz="0 0.5 -2"/> </simulation> </robot>)",
                     beam(stiffness_damping), fmt::format(kBody, 0.1));
}

TEST(LinearModel, DefectOfFlexibleArmIsQuadratic) {
  expect_quadratic_defect(flexible_arm(0), "shoulder", "load", 0.5);
}

// With damping of strains there remains a part of the defect that is linear in the amplitude. It falls with the square
// of the step.
TEST(LinearModel, DefectOfDampedArmFallsWithTheStep) {
  const double effort = 1e-3;
  const double large = defect(flexible_arm(2e-3), "shoulder", "load", effort, 0.01).norm();
  const double small = defect(flexible_arm(2e-3), "shoulder", "load", effort, 0.0025).norm();
  EXPECT_GT(std::log(large / small) / std::log(4.0), 1.9) << large << ", " << small;
}

// Without gravity: on a rail bent by a weight, the contact in a step would move the carriage off its line, here by 3e-7
// m.
TEST(LinearModel, DefectOfSliderIsQuadratic) {
  expect_quadratic_defect(fmt::format(R"(<robot name="slider"><link name="world"/>
    <joint name="shoulder" type="continuous"> <parent link="world"/> <child link="rail"/> <axis xyz="0 1 0"/> </joint>
    <link name="rail">{0}</link>
    <joint name="run" type="floating"> <parent link="rail"/> <child link="carriage"/> <axis xyz="0 0 1"/>
      <slide start="0.7" rotation="fixed"/> </joint>
    <link name="carriage">{1}</link>
    <spring joint="shoulder" stiffness="60"/> <spring joint="run" stiffness="80" rest="0.7"/>
    <simulation> <gravity xyz="0 0 0"/> </simulation> </robot>)",
                                      beam(), fmt::format(kBody, 0.1)),
                          "run", "carriage", 0.2);
}

TEST(LinearModel, DefectOfFourBarIsQuadratic) {
  // A parallelogram of rigid bars with a spring, closed by a loop joint. Its coupler is a beam.
  expect_quadratic_defect(fmt::format(R"(<robot name="four_bar"><link name="world"/>
    <joint name="crank_joint" type="continuous"> <parent link="world"/> <child link="crank"/> <axis xyz="0 1 0"/> </joint>
    <link name="crank">{0}</link>
    <joint name="coupler_joint" type="continuous"> <parent link="crank"/> <child link="coupler"/>
      <origin xyz="0 0 -0.7"/> <axis xyz="0 1 0"/> </joint> <link name="coupler">{1}</link>
    <joint name="rocker_joint" type="continuous"> <parent link="world"/> <child link="rocker"/> <origin xyz="1 0 0.2"/>
      <axis xyz="0 1 0"/> </joint> <link name="rocker">{0}</link>
    <loop_joint name="closure" type="continuous"> <parent link="coupler"/> <child link="rocker"/>
      <origin xyz="1 0 0"/> <child_origin xyz="0 0 -0.9"/> <axis xyz="0 1 0"/> </loop_joint>
    <spring joint="crank_joint" stiffness="60" rest="0.2"/>
    <simulation> <gravity xyz="0 0 -3"/> </simulation> </robot>)",
                                      fmt::format(kBody, 0.1), beam()),
                          "crank_joint", "coupler", 1);
}

// The four-bar vibrates at a frequency that the first step size does not resolve, and the second one does.
TEST(LinearModel, SaysWhereStepsAreTooLong) {
  const scene::SceneDescription scene = test::scene_at("config/examples/four_bar.urdf");
  for (const double step : {2e-3, 2e-4}) {
    SimulationOptions options;
    options.step = step;
    Simulation simulation(scene, options);
    while (simulation.time() < 0.1 - step / 2) ASSERT_TRUE(simulation.step().converged);
    LinearRequest request;
    request.about = LinearisedAbout::Instant;
    const LinearModel model = linearise(simulation, request);
    EXPECT_EQ(doubt_about_instant(simulation, model).empty(), step < 1e-3);
  }
}

}  // namespace
}  // namespace flexarm
