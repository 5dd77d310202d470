// Tests responses of linear models and of reduced models, against closed forms and the defining equations.
#include "flexarm/simulation/linear_response.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/linear_reduction.h"
#include "math/pi.h"
#include "simulation/gain_errors.h"
#include "support/dense_solution.h"
#include "support/scene_text.h"

namespace flexarm {
namespace {

using Complex = std::complex<double>;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::largest_error;
using test::logarithmic;

/// The model y'' + 2 ratio frequency y' + frequency^2 y = u with outputs y, y' and y''.
LinearModel oscillator(double frequency, double ratio) {
  LinearModel model;
  model.positions = 1;
  model.states = {"y", "d/dt y"};
  model.inputs = {"u"};
  model.outputs = {"y", "d/dt y", "acceleration"};
  model.a = (MatrixXd(2, 2) << 0, 1, -frequency * frequency, -2 * ratio * frequency).finished();
  model.b = (MatrixXd(2, 1) << 0, 1).finished();
  model.c = (MatrixXd(3, 2) << MatrixXd::Identity(2, 2), model.a.bottomRows(1)).finished();
  model.d = (MatrixXd(3, 1) << 0, 0, 1).finished();
  model.drift = VectorXd::Zero(2);
  return model;
}

/// A damped beam of three elements with input and outputs at its tip.
LinearModel cantilever(const std::string& joint) {
  scene::SceneDescription description = test::scene_of(R"(<robot name="cantilever"><link name="world"/>
    <joint name="root" type=")" + joint + R"("> <parent link="world"/> <child link="beam"/> <axis xyz="0 0 1"/> </joint>
    <link name="beam"> <beam elements="3" order="2"> <centerline> <line to="1 0 0"/> </centerline>
      <section ea="1e4" ga2="4e3" ga3="4e3" gj="8" ei2="10" ei3="12" mass="1" j1="2e-3" j2="1e-3" j3="1e-3"/>
      <damping stiffness_proportional="2e-3"/> </beam> </link>
    <simulation> <gravity xyz="0 0 0"/> </simulation> </robot>)");
  LinearRequest request;
  request.inputs = {"wrench:beam/tip:fy", "wrench:beam/tip:fz"};
  request.outputs = {"position:beam/tip:y", "position:beam/tip:z", "acceleration:beam/tip:y"};
  return linearise(Simulation(std::move(description)), request);
}

// The exact response is 1 / (w0^2 - w^2 + 2 i z w0 w). Near resonance its round-off grows by 1/(2 z).
TEST(FrequencyResponse, OfAnOscillatorByFormula) {
  const double natural = 7, ratio = 0.01;
  const std::vector<double> frequencies = logarithmic(0.01, 100, 200);
  const FrequencyResponse response = frequency_response(oscillator(natural, ratio), frequencies);
  ASSERT_EQ(response.gains.size(), frequencies.size());
  for (std::size_t n = 0; n < frequencies.size(); ++n) {
    const Complex rate = {0, 2 * kPi * frequencies[n]};
    const Complex expected = 1.0 / (natural * natural + 2 * ratio * natural * rate + rate * rate);
    EXPECT_LT(std::abs(response.gains[n](0, 0) - expected), 1e-13 / ratio * std::abs(expected));
    EXPECT_LT(std::abs(response.gains[n](1, 0) - rate * expected), 1e-13 / ratio * std::abs(rate * expected));
    // The acceleration's gain is the difference of 1 and a multiple of the position's gain.
    EXPECT_LT(std::abs(response.gains[n](2, 0) - rate * rate * expected), 1e-13 / ratio * (1 + std::abs(expected)));
  }
}

// Elimination of the unscaled matrix loses digits: as many as its largest entry is larger than the distance to the next
// pole.
TEST(FrequencyResponse, SolvesItsEquations) {
  const LinearModel model = cantilever("fixed");
  for (const double frequency : {0.3, 2.0, 40.0}) {
    const Complex rate = {0, 2 * kPi * frequency};
    double distance = std::abs(rate);
    for (const Pole& pole : poles(model)) distance = std::min(distance, std::abs(rate - pole.value));
    const double round_off = 1e-15 * model.a.cwiseAbs().maxCoeff() / distance;
    const MatrixXcd gains = frequency_response(model, {frequency}).gains[0];
    const MatrixXcd matrix = rate * MatrixXcd::Identity(model.a.rows(), model.a.cols()) - model.a.cast<Complex>();
    for (Eigen::Index j = 0; j < model.b.cols(); ++j) {
      const Eigen::VectorXcd states = test::complex_solution(matrix, model.b.col(j).cast<Complex>());
      const Eigen::VectorXcd positions = model.c.topRows(2).cast<Complex>() * states;
      EXPECT_LT((gains.col(j).head(2) - positions).norm(), round_off * states.norm());
    }
  }
}

// The peak of a well separated mode lies within its half-power band. Half its width is the damping ratio times the
// frequency.
TEST(FrequencyResponse, PeaksAtThePole) {
  const LinearModel model = cantilever("fixed");
  for (const Pole& pole : poles(model)) {
    if (pole.damping_ratio() > 0.05) break;
    const std::vector<double> near = logarithmic(0.8 * pole.frequency(), 1.25 * pole.frequency(), 2001);
    const FrequencyResponse response = frequency_response(model, near);
    const int axis = std::abs((model.c * pole.mode)[0]) > std::abs((model.c * pole.mode)[1]) ? 0 : 1;
    std::size_t peak = 0;
    for (std::size_t n = 0; n < near.size(); ++n)
      if (std::abs(response.gains[n](axis, axis)) > std::abs(response.gains[peak](axis, axis))) peak = n;
    EXPECT_NEAR(near[peak] / pole.frequency(), 1, pole.damping_ratio());
  }
}

// Behind an elastic gear the load moves much less than the motor: at high frequencies, what the free motion and the
// swing contribute cancels. With I y'' = c (r - y) + d (r' - y') and J r'' = u - c (r - y) - d (r' - y'), the gain is
// (d s + c) / (I J s^4 + (I + J) (d s^3 + c s^2)).
TEST(FrequencyResponse, BehindAnElasticGear) {
  scene::SceneDescription description = test::scene_of(R"(<robot name="drive"><link name="world"/>
    <joint name="hinge" type="continuous"> <parent link="world"/> <child link="load"/> <axis xyz="0 0 1"/> </joint>
    <link name="load"> <inertial> <mass value="1"/>
      <inertia ixx="0.35" iyy="0.35" izz="0.35" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <drive joint="hinge" gear="60" rotor_inertia="3e-5" stiffness="900" damping="0.4"/>
    <simulation> <gravity xyz="0 0 0"/> </simulation> </robot>)");
  LinearRequest request;
  request.inputs = {"effort:hinge"};
  request.outputs = {"position:hinge"};
  const double load = 0.35, motor = 3600 * 3e-5, c = 900, d = 0.4;
  const std::vector<double> frequencies = logarithmic(0.1, 2e4, 400);
  const FrequencyResponse response =
      frequency_response(linearise(Simulation(std::move(description)), request), frequencies);
  for (std::size_t n = 0; n < frequencies.size(); ++n) {
    const Complex s = {0, 2 * kPi * frequencies[n]};
    const Complex expected = (d * s + c) / (load * motor * s * s * s * s + (load + motor) * (d * s + c) * s * s);
    EXPECT_LT(std::abs(response.gains[n](0, 0) / expected - 1.0), 1e-12) << frequencies[n];
  }
}

TEST(FrequencyResponse, SaysWhereThereIsNone) {
  EXPECT_THROW(frequency_response(oscillator(1, 0), {1 / (2 * kPi)}), std::runtime_error);
}

TEST(StepResponse, OfAnOscillatorByFormula) {
  const double natural = 7, ratio = 0.1, until = 3;
  const StepResponse response = step_response(oscillator(natural, ratio), until, 60);
  ASSERT_EQ(response.times.size(), 61u);
  EXPECT_EQ(response.times.back(), until);
  const double decay = ratio * natural, damped = natural * std::sqrt(1 - ratio * ratio);
  for (std::size_t n = 0; n < response.times.size(); ++n) {
    const double phase = damped * response.times[n];
    const double wave = std::cos(phase) + decay / damped * std::sin(phase);
    const double expected = (1 - std::exp(-decay * response.times[n]) * wave) / (natural * natural);
    EXPECT_NEAR(response.outputs[n](0, 0), expected, 1e-13);
  }
  EXPECT_THROW(step_response(oscillator(1, 1), 0, 10), std::invalid_argument);
  EXPECT_THROW(step_response(oscillator(1, 1), 1, 0), std::invalid_argument);
}

// Poles of very different sizes: the fast part is complete at once. The slow part keeps its digits, except those that
// 30 squarings lose.
TEST(StepResponse, OfAStiffModel) {
  LinearModel model = oscillator(1, 1);
  model.a = (MatrixXd(2, 2) << -1e6, 0, 0, -1).finished();
  model.b = (MatrixXd(2, 1) << 1e6, 1).finished();
  model.c = MatrixXd::Identity(2, 2);
  model.d = MatrixXd::Zero(2, 1);
  const StepResponse response = step_response(model, 5, 5);
  for (std::size_t n = 1; n < response.times.size(); ++n) {
    EXPECT_NEAR(response.outputs[n](0, 0), 1, 1e-9);
    EXPECT_NEAR(response.outputs[n](1, 0), -std::expm1(-response.times[n]), 1e-9);
  }
}

// ---------------------------------------------------------------- smaller models

// The Hankel singular value of a first-order lag with the gain 1 is 1/2.
TEST(ReducedModel, HankelSingularValueOfALag) {
  LinearModel model = oscillator(1, 1);
  model.a = MatrixXd::Constant(1, 1, -3);
  model.b = MatrixXd::Constant(1, 1, 3);
  model.c = MatrixXd::Ones(1, 1);
  model.d = MatrixXd::Zero(1, 1);
  model.drift = VectorXd::Zero(1);
  model.states = {"x"};
  const ReducedModel same = reduced(model, 1);
  ASSERT_EQ(same.hankel_singular_values.size(), 1);
  EXPECT_NEAR(same.hankel_singular_values[0], 0.5, 1e-14);
  EXPECT_NEAR(same.model.a(0, 0), -3, 1e-13);
}

// Bounds by Glover 1984: the error at any frequency is at most twice the sum of the singular values that are left out.
// At some frequency, it is at least the largest of them.
TEST(ReducedModel, ErrorIsWithinItsBound) {
  const LinearModel model = cantilever("fixed");
  const std::vector<double> frequencies = logarithmic(0.01, 1e4, 300);
  for (const int order : {2, 4, 8, 12}) {
    const ReducedModel small = reduced(model, order);
    EXPECT_EQ(small.kept, 0);
    ASSERT_EQ(small.model.a.rows(), order);
    const VectorXd& values = small.hankel_singular_values;
    const double bound = 2 * values.tail(values.size() - order).sum();
    // The second term is round-off of the full model's gains.
    EXPECT_LT(largest_error(model, small.model, frequencies), bound + 1e-10 * values[0]) << order;
    for (const Pole& pole : poles(small.model)) EXPECT_LT(pole.value.real(), 0) << order;
  }
}

/// Relative round-off of a gain at this frequency [Hz] of a model with a hinge that nothing holds.
/// Round-off of its stiffness counts beside (2 pi frequency)^2 times its inertia. Reduced models have no such
/// stiffness.
double round_off_of_free_hinge(const LinearModel& model, const std::string& hinge, double frequency) {
  const auto found = std::find(model.coordinates.begin(), model.coordinates.end(), hinge);
  const auto place = found - model.coordinates.begin();
  return model.stiffness_round_off[place] / (model.mass(place, place) * std::pow(2 * kPi * frequency, 2));
}

// A free beam on a hinge: the two poles at 0 are kept, and the bound holds for the remaining part.
TEST(ReducedModel, KeepsFreeMotions) {
  const LinearModel model = cantilever("continuous");
  const std::vector<double> frequencies = logarithmic(0.1, 1e4, 200);
  const ReducedModel small = reduced(model, 10);
  EXPECT_EQ(small.kept, 2);
  const VectorXd& values = small.hankel_singular_values;
  const double free = frequency_response(model, {0.1}).gains[0].norm();
  EXPECT_LT(largest_error(model, small.model, frequencies),
            2 * values.tail(values.size() - 8).sum() + round_off_of_free_hinge(model, "root", 0.1) * free);
  EXPECT_THROW(reduced(model, 1), std::invalid_argument);
  EXPECT_THROW(reduced(model, static_cast<int>(model.a.rows()) + 1), std::invalid_argument);
}

/// A boom on a hinge about the vertical, in no gravity, from the hinge's effort to the way of its tip.
LinearModel boom_on_hinge(const std::string& hinge, const std::string& boom) {
  scene::SceneDescription description = test::scene_of(R"(<robot name="arm"><link name="world"/>
    <joint name="shoulder" type="continuous"> <parent link="world"/> <child link="boom"/> <axis xyz="0 0 1"/>)" +
                                                       hinge + R"(</joint>
    <link name="boom"> <beam elements="4"> <centerline> <line to="2 0 0"/> </centerline> <circle radius="0.008"/>
      <material young="70e9" poisson="0.33" density="2700"/>)" +
                                                       boom + R"(
      <hub at="start" mass="0.5" inertia="0.02 0.02 0.02"/> </beam> </link>
    <simulation> <gravity xyz="0 0 0"/> </simulation> </robot>)");
  LinearRequest request;
  request.inputs = {"effort:shoulder"};
  request.outputs = {"position:boom/tip:y"};
  return linearise(Simulation(std::move(description)), request);
}

int zeros_among(const std::vector<Pole>& poles) {
  return static_cast<int>(
      std::count_if(poles.begin(), poles.end(), [](const Pole& pole) { return pole.value == 0.0; }));
}

// A free hinge has two poles at 0, a damped one has one. Swings that decay slowly do decay, and what the effort does
// not move is left out: here all swings in the vertical plane.
TEST(ReducedModel, KeepsWhatInputsMove) {
  const std::string damped = "<damping ratio=\"0.002\" frequency=\"3\"/>";
  const LinearModel free = boom_on_hinge("", damped), held = boom_on_hinge("<dynamics damping=\"0.01\"/>", damped);
  for (const bool is_free : {true, false}) {
    const LinearModel& model = is_free ? free : held;
    const int zeros = is_free ? 2 : 1;
    EXPECT_EQ(zeros_among(poles(model)), zeros);
    const ReducedModel small = reduced(model, 6);
    EXPECT_EQ(small.kept, zeros);
    EXPECT_EQ(small.model.a.rows(), 6);
    EXPECT_EQ(zeros_among(poles(small.model)), zeros);
    const VectorXd& values = small.hankel_singular_values;
    const std::vector<double> frequencies = logarithmic(0.1, 1e3, 100);
    const double largest = frequency_response(model, {0.1}).gains[0].norm();
    EXPECT_LT(
        largest_error(model, small.model, frequencies),
        2 * values.tail(values.size() - 6 + zeros).sum() + round_off_of_free_hinge(model, "shoulder", 0.1) * largest);
  }
  const LinearModel undamped = boom_on_hinge("", "");
  const auto states = static_cast<int>(undamped.a.rows());
  const ReducedModel small = reduced(undamped, states);
  EXPECT_GT(small.kept, 2);
  EXPECT_LE(small.kept, states / 2 + 1);  // as many swings in each of the two planes, and the hinge
  EXPECT_EQ(zeros_among(poles(small.model)), 2);
}

TEST(FrequencyResponse, RefusesWhatIsNoFrequency) {
  for (const double frequency : {double(NAN), double(INFINITY)})
    EXPECT_THROW(frequency_response(oscillator(1, 1), {frequency}), std::invalid_argument) << frequency;
}

TEST(StepResponse, RefusesAnEndThatNeverComes) {
  for (const double until : {double(NAN), double(INFINITY)})
    EXPECT_THROW(step_response(oscillator(1, 1), until, 10), std::invalid_argument) << until;
}

TEST(LinearModels, WhoseMatricesDoNotFitAreRefused) {
  std::vector<LinearModel> models(6, oscillator(1, 1));
  models[0].a = MatrixXd::Identity(2, 3);
  models[1].b = MatrixXd::Zero(3, 1);
  models[2].c = MatrixXd::Zero(3, 1);
  models[3].d = MatrixXd::Zero(2, 1);
  models[4].positions = 3;
  models[5].positions = -1;
  for (std::size_t i = 0; i < models.size(); ++i) {
    EXPECT_THROW(poles(models[i]), std::invalid_argument) << i;
    EXPECT_THROW(frequency_response(models[i], {1}), std::invalid_argument) << i;
    EXPECT_THROW(step_response(models[i], 1, 1), std::invalid_argument) << i;
    EXPECT_THROW(reduced(models[i], 2), std::invalid_argument) << i;
  }
}

}  // namespace
}  // namespace flexarm
