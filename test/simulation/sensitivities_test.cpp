// Tests derivatives of runs with respect to parameters and start, against differences of whole runs.
#include "flexarm/simulation/sensitivities.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/mechanism_states.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/linear_model.h"
#include "model/state_numbers.h"
#include "simulation/linear_names.h"
#include "simulation/sensitivity_scenes.h"
#include "support/runs.h"

namespace flexarm::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Positions and momenta, which depend smoothly on the state. Published velocities do not: they are chosen from several
/// estimates.
VectorXd observed(const Simulation& simulation) {
  std::vector<double> values;
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i) values.push_back(simulation.position(i));
  const auto add = [&](const Vector3& part) { values.insert(values.end(), part.data(), part.data() + 3); };
  for (std::size_t i = 0; i < simulation.scene().probes.size(); ++i) add(simulation.probe(i).pose.position);
  add(simulation.momentum());
  add(simulation.angular_momentum());
  return Eigen::Map<VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

template <class Start>
VectorXd after(const Start& start, double value, int steps) {
  Simulation simulation = start(value);
  for (int i = 0; i < steps; ++i)
    if (!simulation.step().converged) throw std::runtime_error("a step has failed");
  return observed(simulation);
}

/// Central differences of whole runs, extrapolated to zero step: the error is of order way^4, plus round-off over way.
template <class Start>
VectorXd difference_of_runs(const Start& start, double value, double way, int steps) {
  const auto quotient = [&](double h) -> VectorXd {
    return (after(start, value + h, steps) - after(start, value - h, steps)) / (2 * h);
  };
  return (4 * quotient(way / 2) - quotient(way)) / 3;
}

double deviation(const VectorXd& a, const VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

/// Compares the derivatives after `steps` with differences, for parameters with the given values. `way`: relative step
/// of the differences.
void expect_differences(const Scene& scene, const std::vector<std::pair<std::string, double>>& parameters, int steps,
                        double way = 1e-3) {
  Simulation simulation = scene.simulation();
  std::vector<std::string> names;
  for (const auto& [name, value] : parameters) names.push_back(name);
  Sensitivities sensitivities(simulation, scene.request(names));
  ASSERT_EQ(sensitivities.directions(), names);
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(sensitivities.step().converged);
  ASSERT_EQ(sensitivities.lost(), "");
  const MatrixXd found = sensitivities.of(observed);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto start = [&](double value) { return scene.simulation({{names[k], value}}); };
    const double value = parameters[k].second;
    const VectorXd expected = difference_of_runs(start, value, way * (value != 0 ? std::abs(value) : 1.0), steps);
    EXPECT_LT(deviation(found.col(static_cast<Eigen::Index>(k)), expected), 1e-6) << names[k];
  }
}

// ---------------------------------------------------------------- scenes

// A rigid leg that slides on a bent flexible rail.
const std::string kSlider = R"(<robot name="slider"> <link name="world"/>
  <joint name="mount" type="fixed"> <parent link="world"/> <child link="rail"/> </joint>
  <link name="rail"> <beam elements="3"> <centerline> <line to="1 0 0"/> <arc to="2 0 -0.4" center="1 0 -1.45"/>
    </centerline> <circle radius="0.02"/> <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
  <joint name="runner" type="floating"> <parent link="rail"/> <child link="leg"/> <axis xyz="0 1 0"/>
    <slide start="0.4" rotation="revolute"/> </joint>
  <link name="leg"> <inertial> <origin xyz="0 0 -0.4"/> <mass value="0.3"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
  <simulation> <initial joint="runner/s" position="0.4" velocity="0.8"/> <probe name="leg" link="leg"/> </simulation>
  )";

const std::string kLoop = R"(<robot name="loop"> <parameter name="mass" value="0.6"/> <link name="world"/>
  <joint name="crank" type="continuous"> <parent link="world"/> <child link="crank"/> <axis xyz="0 1 0"/> </joint>
  <link name="crank"> <inertial> <origin xyz="0 0 0.1"/> <mass value="0.4"/>
    <inertia ixx="0.0015" ixy="0" ixz="0" iyy="0.0015" iyz="0" izz="0.0001"/> </inertial> </link>
  <joint name="knee" type="continuous"> <parent link="crank"/> <child link="coupler"/> <origin xyz="0 0 0.2"/>
    <axis xyz="0 1 0"/> </joint>
  <link name="coupler"> <inertial> <origin xyz="0.3 0 0.1" rpy="0 1.249 0"/> <mass value="0.1"/>
    <inertia ixx="0.003" ixy="0" ixz="0" iyy="0.003" iyz="0" izz="1e-6"/> </inertial> </link>
  <joint name="foot" type="continuous"> <parent link="world"/> <child link="rocker"/> <origin xyz="0.6 0 0"/>
    <axis xyz="0 1 0"/> </joint>
  <link name="rocker"> <inertial> <origin xyz="0 0 0.2"/> <mass value="${mass}"/>
    <inertia ixx="0.008" ixy="0" ixz="0" iyy="0.008" iyz="0" izz="0.0001"/> </inertial> </link>
  <loop_joint name="hip" type="continuous"> <parent link="rocker"/> <child link="coupler"/>
    <origin xyz="0 0 0.4"/> <child_origin xyz="0.6 0 0.2"/> <axis xyz="0 1 0"/> </loop_joint>
  <simulation> <initial joint="crank" velocity="2"/> <probe name="middle" link="coupler" at="0.3 0 0.1"/> </simulation>
  )";

// A rod with a hand whose joint is held by a constant motion.
const std::string kBentRod = R"(<robot name="bent_rod">
  <parameter name="bend" value="0.6"/> <parameter name="payload" value="0.5"/> <link name="world"/>
  <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/> </joint>
  <link name="rod"> <inertial> <origin xyz="0.5 0 0"/> <mass value="2"/>
    <inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
  <joint name="grip" type="continuous"> <parent link="rod"/> <child link="hand"/> <origin xyz="1 0 0"/>
    <axis xyz="0 0.6 0.8"/> </joint>
  <link name="hand"> <inertial> <origin xyz="0.2 0.1 0"/> <mass value="${payload}"/>
    <inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
  <simulation> <motion joint="grip" position="${bend}"/> <initial joint="hinge" velocity="0.7"/>
    <probe name="end" link="hand" at="0.4 0 0"/> </simulation>
  )";

// ---------------------------------------------------------------- against differences of whole runs

TEST(Sensitivities, RigidPendulumByItsParametersAndItsStart) {
  for (const std::string scheme : {"em", "newmark"})
    expect_differences({with_scheme(kPendulum, scheme, 5e-3)},
                       {{"damping", 0.5}, {"payload", 2}, {"angle", 1.2}, {"speed", 0.7}, {"reach", 0.8}}, 300, 1e-2);
}

TEST(Sensitivities, JointThatIsHeld) {
  const Scene scene{with_scheme(kBentRod, "em", 5e-3)};
  ASSERT_EQ(model_of(scene.simulation()).held.size(), 1U);
  expect_differences(scene, {{"bend", 0.6}, {"payload", 0.5}}, 200, 1e-2);
}

TEST(Sensitivities, FlexibleArm) {
  for (const std::string scheme : {"em", "edmc2", "hht2", "newmark"}) {
    SCOPED_TRACE(scheme);
    const Scene scene{with_scheme(flexible_arm("0 0 1"), scheme, 2e-3)};
    expect_differences(scene, {{"payload", 0.4}, {"damping", 0.3}, {"length", 1}}, 300, 2e-3);
    // A larger step of the differences, because of the round-off of runs. In the Newmark family, the accelerations at
    // the start add to it.
    expect_differences(scene, {{"young", 7e9}}, 300, 4e-3);
  }
}

// Each step consists of five sub-steps, some of them backwards.
TEST(Sensitivities, ComposedSteps) {
  expect_differences({with_scheme(flexible_arm("0 1 0"), "em4", 5e-3)}, {{"payload", 0.4}, {"damping", 0.3}}, 40, 2e-3);
}

TEST(Sensitivities, Loop) {
  for (const std::string scheme : {"em", "newmark"})
    expect_differences({with_scheme(kLoop, scheme, 2e-3)}, {{"mass", 0.6}}, 300, 1e-2);
}

TEST(Sensitivities, StepsAndToleranceOfARunThatWereChanged) {
  const Scene scene{with_scheme(kPendulum, "newmark", 5e-3)};
  const auto start = [&](double payload) {
    Simulation simulation = scene.simulation({{"payload", payload}});
    simulation.set_step_size(2e-3);
    simulation.set_tolerance(1e-11);
    return simulation;
  };
  Simulation simulation = start(2);
  Sensitivities sensitivities(simulation, scene.request({"payload"}));
  constexpr int kSteps = 40;
  for (int i = 0; i < kSteps; ++i) ASSERT_TRUE(sensitivities.step().converged);
  EXPECT_LT(deviation(sensitivities.of(observed).col(0), difference_of_runs(start, 2, 2e-2, kSteps)), 1e-6);
}

TEST(Sensitivities, ParameterAtTheEndOfItsRange) {
  std::string scene = kPendulum;
  const std::string value = "name=\"damping\" value=\"0.5\"";
  scene.replace(scene.find(value), value.size(), "name=\"damping\" value=\"0\"");
  Simulation at_end = Scene{with_scheme(scene, "em", 5e-3)}.simulation();
  Sensitivities one_sided(at_end, Scene{with_scheme(scene, "em", 5e-3)}.request({"damping"}));
  const std::string limit = " min=\"0\"";
  scene.replace(scene.find(limit), limit.size(), "");
  Simulation inside = Scene{with_scheme(scene, "em", 5e-3)}.simulation();
  Sensitivities central(inside, Scene{with_scheme(scene, "em", 5e-3)}.request({"damping"}));
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(one_sided.step().converged && central.step().converged);
  EXPECT_LT(deviation(one_sided.of(observed), central.of(observed)), 1e-6);
}

/// Round-off of a run: the difference to the same run with new factors in every iteration.
double round_off(const Scene& scene, int steps) {
  const auto run = [&](const SimulationOptions& options) {
    return after([&](double) { return scene.simulation({}, options); }, 0, steps);
  };
  return (run({}) - run(full_newton())).cwiseAbs().maxCoeff();
}

/// Compares the derivatives with respect to the joint positions and rates at the start with differences. `round_off` of
/// the runs enters the tolerance divided by 1e-5, the distance of the neighbouring runs that the sensitivities use.
void expect_transition(const Scene& scene, int steps, double way, double round_off = 0) {
  Simulation simulation = scene.simulation();
  const MechanismStates states(model_of(simulation), motion_of(simulation));
  SensitivityRequest request;
  request.initial_state = true;
  Sensitivities sensitivities(simulation, request);
  const std::vector<std::string>& names = sensitivities.directions();
  ASSERT_EQ(names, sensitivities.state_names());
  const MatrixXd unit = sensitivities.states();
  EXPECT_LT((unit - MatrixXd::Identity(unit.rows(), unit.cols())).cwiseAbs().maxCoeff(), 1e-6);
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(sensitivities.step().converged);
  ASSERT_EQ(sensitivities.lost(), "");
  const MatrixXd found = sensitivities.of(observed);
  int count = 0;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const bool is_rotor = names[k].find("rotor:") != std::string::npos;
    if (names[k].find(':') != std::string::npos && !is_rotor) continue;  // a state of a node, not of a joint
    const auto start_off = [&](double off) {
      Simulation other = scene.simulation();
      const MechanismMotion motion = states.moved(static_cast<int>(k), off);
      restore(other, start_at(other, motion));
      return other;
    };
    const VectorXd expected = difference_of_runs(start_off, 0, way, steps);
    const double tolerance = 1e-6 + round_off / 1e-5 / expected.cwiseAbs().maxCoeff();
    EXPECT_LT(deviation(found.col(static_cast<Eigen::Index>(k)), expected), tolerance) << names[k];
    ++count;
  }
  EXPECT_GE(count, 2);
}

TEST(Sensitivities, TransitionOfPendulumArmSliderAndLoop) {
  expect_transition({with_scheme(kPendulum, "em", 5e-3)}, 200, 1e-3);
  expect_transition({with_scheme(flexible_arm("0 0 1"), "em", 2e-3)}, 100, 1e-3);
  // The round-off of the slider's momentum is 7e-12. round_off() measures only a part of it, by one change of factors.
  const Scene slider{with_scheme(kSlider, "em", 2e-3)};
  expect_transition(slider, 100, 5e-3, 3 * round_off(slider, 100));
  expect_transition({with_scheme(kLoop, "em", 2e-3)}, 200, 1e-3);
}

TEST(Sensitivities, TransitionOfARotorBehindAnElasticGear) {
  for (const char* scheme : {"em", "newmark"})
    expect_transition({with_scheme(kGearedPendulum, scheme, 5e-3)}, 200, 1e-2);
}

// A parameter that sets the start position of a joint has the same derivatives as this position as a state of the
// start.
TEST(Sensitivities, StatesOfTheStartAreWhatInitialSays) {
  const Scene scene{with_scheme(flexible_arm("0 0 1"), "em", 2e-3)};
  Simulation simulation = scene.simulation();
  SensitivityRequest request = scene.request({"turn"});
  request.initial_state = true;
  Sensitivities sensitivities(simulation, request);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(sensitivities.step().converged);
  const MatrixXd found = sensitivities.states();
  const auto& names = sensitivities.directions();
  const auto wrist = std::find(names.begin(), names.end(), "wrist") - names.begin();
  EXPECT_LT(deviation(found.col(0), found.col(wrist)), 1e-6);
}

// For small motions, a step is a step of the midpoint rule with the linear model.
TEST(Sensitivities, FirstStepFromRestIsThatOfTheLinearModel) {
  const Scene scene{with_scheme(R"(<robot name="rod"> <link name="world"/>
    <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/>
      <dynamics damping="0.2"/> </joint>
    <link name="rod"> <beam elements="2"> <centerline> <line to="0 0 -1"/> </centerline> <circle radius="0.02"/>
      <material young="7e9" poisson="0.3" density="2700"/> </beam> </link>
    <simulation> <gravity xyz="0 0 0"/> </simulation> )",
                                "em", 1e-3)};
  Simulation simulation = scene.simulation();
  const MatrixXd a = linearise(simulation).a, one = MatrixXd::Identity(a.rows(), a.cols());
  SensitivityRequest request;
  request.initial_state = true;
  Sensitivities sensitivities(simulation, request);
  ASSERT_TRUE(sensitivities.step().converged);
  const MatrixXd expected = (one - 5e-4 * a).fullPivLu().solve(one + 5e-4 * a);
  const MatrixXd found = sensitivities.states();
  const Eigen::Index half = a.rows() / 2;
  const auto block = [&](const MatrixXd& all, bool rates, bool by_rates) -> MatrixXd {
    return all.block(rates ? half : 0, by_rates ? half : 0, half, half);
  };
  for (const bool rates : {false, true})
    for (const bool by_rates : {false, true})
      EXPECT_LT((block(found, rates, by_rates) - block(expected, rates, by_rates)).cwiseAbs().maxCoeff(),
                1e-6 * block(expected, rates, by_rates).cwiseAbs().maxCoeff())
          << rates << by_rates;
}

// ---------------------------------------------------------------- derivatives that are computed along with the run

std::vector<double> numbers_of(const State& state) {
  std::vector<double> numbers;
  for_each_number(state, [&](const char*, double number) { numbers.push_back(std::isnan(number) ? 0 : number); });
  return numbers;
}

TEST(Sensitivities, RunKeepsItsBits) {
  for (const std::string scheme : {"em", "em4", "hht2"}) {
    const Scene scene{with_scheme(flexible_arm("0 1 0"), scheme, 2e-3)};  // the arm moves in a plane
    Simulation alone = scene.simulation(), accompanied = scene.simulation();
    SensitivityRequest request = scene.request({"young", "payload"});
    request.initial_state = true;
    Sensitivities sensitivities(accompanied, request);
    for (int i = 0; i < 60; ++i) {
      alone.step();
      sensitivities.step();
    }
    EXPECT_EQ(sensitivities.lost(), "");
    EXPECT_EQ(numbers_of(state_of(alone)), numbers_of(state_of(accompanied))) << scheme;
  }
}

// Differences of two runs lose accuracy as their phases drift apart. The derivatives beside the run do not.
TEST(Sensitivities, FrequencyAfterThousandPeriods) {
  const std::string scene = R"(<robot name="oscillator"> <parameter name="stiffness" value="400"/> <link name="world"/>
    <joint name="slide" type="prismatic"> <parent link="world"/> <child link="mass"/> <axis xyz="1 0 0"/>
      <limit lower="-10" upper="10" effort="0" velocity="100"/> </joint>
    <link name="mass"> <inertial> <mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <spring joint="slide" stiffness="${stiffness}"/>
    <simulation> <initial joint="slide" position="0.5"/> </simulation> )";
  const double step = 1e-2, rate = std::sqrt(400.0);
  const int steps = 30000;
  const Scene whole{with_scheme(scene, "em", step)};
  Simulation simulation = whole.simulation();
  Sensitivities sensitivities(simulation, whole.request({"stiffness"}));
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(sensitivities.step().converged);
  // The midpoint rule turns the phase by 2 atan(rate step / 2) in a step.
  const double half = 0.5 * rate * step, phase = 2 * steps * std::atan(half);
  const double by_rate = -0.5 * std::sin(phase) * steps * step / (1 + half * half);
  EXPECT_NEAR(sensitivities.positions()(0, 0), by_rate / (2 * rate), 1e-6 * 0.5 * steps * step / (2 * rate));
}

TEST(Sensitivities, OfWhatHasNotAlwaysAsManyNumbersAreRefused) {
  Simulation simulation = Scene{with_scheme(kPendulum, "em", 5e-3)}.simulation();
  SensitivityRequest request;
  request.initial_state = true;
  const Sensitivities sensitivities(simulation, request);
  const auto grows = [&](const Simulation& seen) -> VectorXd { return VectorXd::Zero(&seen == &simulation ? 1 : 2); };
  EXPECT_THROW(sensitivities.of(grows), std::invalid_argument);
}

}  // namespace
}  // namespace flexarm::test
