// Tests responses of linear models and of reduced models, against closed forms and the defining equations.
#include "flexarm/simulation/linear_response.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/linear_reduction.h"
#include "math/pi.h"
#include "support/dense_solution.h"
#include "support/scene_text.h"

namespace flexarm {
namespace {

using Complex = std::complex<double>;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

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

std::vector<double> logarithmic(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from * std::pow(to / from, double(i) / (count - 1)));
  return values;
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

double largest_error(const LinearModel& whole, const LinearModel& small, const std::vector<double>& frequencies) {
  const FrequencyResponse expected = frequency_response(whole, frequencies),
                          got = frequency_response(small, frequencies);
  double largest = 0;
  for (std::size_t n = 0; n < frequencies.size(); ++n) {
    // Largest singular value of the error, by power iteration with error^H error.
    const MatrixXcd error = got.gains[n] - expected.gains[n], square = error.adjoint() * error;
    Eigen::VectorXcd direction = Eigen::VectorXcd::Ones(square.cols());
    double value = 0;
    for (int k = 0; k < 50; ++k) {
      direction = square * direction;
      value = direction.norm();
      if (value == 0) break;
      direction /= value;
    }
    largest = std::max(largest, std::sqrt(value));
  }
  return largest;
}

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

// ---------------------------------------------------------------- very thin beams

constexpr double kYoung = 70e9, kDensity = 2700, kDamping = 1e-4;  // damping of strains [s]

/// A clamped beam of 1 m. Its shear stiffness exceeds its bending stiffness by the squared ratio of length to
/// thickness.
LinearModel thin_beam(const std::string& section, const std::string& axis) {
  scene::SceneDescription description = test::scene_of(R"(<robot name="thin"><link name="world"/><link name="arm">
    <beam elements="12" order="2"> <centerline> <line to="1 0 0"/> </centerline> <orientation y="0 1 0"/>)" +
                                                       section +
                                                       R"(<material young="70e9" poisson="0.3" density="2700"/>
      <damping stiffness_proportional="1e-4"/> </beam> </link>
    <joint name="clamp" type="fixed"> <parent link="world"/> <child link="arm"/> </joint>
    <simulation> <gravity xyz="0 0 0"/> </simulation> </robot>)");
  LinearRequest request;
  request.inputs = {"wrench:arm/tip:f" + axis};
  request.outputs = {"position:arm/tip:" + axis};
  return linearise(Simulation(std::move(description)), request);
}

struct ThinBeam {
  std::string section, axis;
  double radius_of_gyration, area;                                                              // [m, m^2]
  double stiffness() const { return kYoung * area * radius_of_gyration * radius_of_gyration; }  // EI
  /// Frequency of the n-th mode (n from 0) of a cantilever after Euler and Bernoulli [1/s].
  double frequency(int n) const {
    const double known[] = {1.8751040687119611, 4.6940911329741746, 7.8547574382376126};
    const double root = n < 3 ? known[n] : (n + 0.5) * kPi;
    return root * root * std::sqrt(stiffness() / (kDensity * area));
  }
  /// Relative round-off of the bending stiffness: it is a small difference of terms of the size of the shear stiffness.
  double round_off() const { return 100 * 2.2e-16 * 0.32 / (radius_of_gyration * radius_of_gyration); }
};
const ThinBeam kStrip = {R"(<rectangle width="0.03" height="0.0002"/>)", "z", 2e-4 / std::sqrt(12.0), 6e-6};
const ThinBeam kWire = {R"(<circle radius="0.00005"/>)", "y", 2.5e-5, kPi * 25e-10};

/// C (s - A)^-1 B by elimination of the unscaled matrices, with 64 bits of mantissa.
std::complex<long double> exact_gain(const LinearModel& model, Complex rate) {
  using Long = std::complex<long double>;
  using Matrix = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::Index n = model.a.rows();
  Matrix rows(n, n + 1);
  rows << -model.a.cast<Long>(), model.b.col(0).cast<Long>();
  for (Eigen::Index i = 0; i < n; ++i) rows(i, i) += Long(rate.real(), rate.imag());
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k; i < n; ++i)
      if (std::abs(rows(i, k)) > std::abs(rows(pivot, k))) pivot = i;
    rows.row(k).swap(rows.row(pivot));
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const Long factor = rows(i, k) / rows(k, k);
      if (factor != Long(0)) rows.row(i).tail(n + 1 - k) -= factor * rows.row(k).tail(n + 1 - k);
    }
  }
  std::vector<Long> states(static_cast<std::size_t>(n));
  Long gain = 0;
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    Long sum = rows(k, n);
    for (Eigen::Index j = k + 1; j < n; ++j) sum -= rows(k, j) * states[static_cast<std::size_t>(j)];
    states[static_cast<std::size_t>(k)] = sum / rows(k, k);
    gain += static_cast<long double>(model.c(0, k)) * states[static_cast<std::size_t>(k)];
  }
  return gain;
}

// The fastest motions are 1e12 times faster than the slowest one. The slowest one keeps its digits, except those that
// are lost in the stiffness itself.
TEST(ThinBeams, GainsAreThoseOfTheirEquations) {
  for (const ThinBeam& beam : {kStrip, kWire}) {
    const LinearModel model = thin_beam(beam.section, beam.axis);
    const double first = beam.frequency(0) / (2 * kPi);
    const std::vector<double> frequencies = {0.01 * first, 0.5 * first, 1.3 * first, 5 * first, 40 * first};
    const FrequencyResponse response = frequency_response(model, frequencies);
    for (std::size_t n = 0; n < frequencies.size(); ++n) {
      const std::complex<long double> expected = exact_gain(model, {0, 2 * kPi * frequencies[n]});
      const Complex got = response.gains[n](0, 0);
      const double error = static_cast<double>(std::abs(std::complex<long double>(got.real(), got.imag()) - expected) /
                                               std::abs(expected));
      // The factor is for frequencies near a pole or zero
      EXPECT_LT(error, 10 * beam.round_off()) << beam.section << frequencies[n];
    }
    // The static gain is 1/(3 EI); elements of this length miss it by at most a thousandth.
    EXPECT_NEAR(std::abs(response.gains[0](0, 0)) * 3 * beam.stiffness(), 1, 2e-3) << beam.section;
  }
}

// Damping of strains gives each bending mode the damping ratio damping * frequency / 2.
TEST(ThinBeams, SlowPolesKeepTheirDamping) {
  for (const ThinBeam& beam : {kStrip, kWire}) {
    const std::vector<Pole> all = poles(thin_beam(beam.section, beam.axis));
    ASSERT_GT(all.size(), 4u);
    for (int n = 0; n < 3; ++n) {
      const double expected = 0.5 * kDamping * beam.frequency(n);
      // The wire bends equally in two planes. In its other plane, the strip is stiffer by the square of 150.
      const Pole& pole = all[static_cast<std::size_t>(beam.axis == "y" ? 2 * n : n)];
      EXPECT_NEAR(2 * kPi * pole.frequency() / beam.frequency(n), 1, 0.005) << beam.section << n;
      EXPECT_NEAR(pole.damping_ratio() / expected, 1, 0.006) << beam.section << n;
      EXPECT_NEAR(pole.damping_ratio() / (0.5 * kDamping * std::abs(pole.value)), 1, 1e-3) << beam.section << n;
    }
  }
}

// A force that sets in at the tip. Each mode has the modal mass 1/4 of the beam's, referred to the tip, and moves from
// rest to its own static deflection.
TEST(ThinBeams, StepResponseIsThatOfTheirModes) {
  for (const ThinBeam& beam : {kStrip, kWire}) {
    const double until = 1.5 * 2 * kPi / beam.frequency(0);
    const StepResponse response = step_response(thin_beam(beam.section, beam.axis), until, 30);
    const double sag = 1 / (3 * beam.stiffness());
    for (std::size_t i = 0; i < response.times.size(); ++i) {
      double expected = 0;
      for (int n = 0; n < 30; ++n) {
        const double rate = beam.frequency(n), decay = 0.5 * kDamping * rate * rate, t = response.times[i];
        if (decay > rate) continue;
        const double damped = std::sqrt(rate * rate - decay * decay);
        const double wave = std::cos(damped * t) + decay / damped * std::sin(damped * t);
        expected += 4 / (kDensity * beam.area * rate * rate) * (1 - std::exp(-decay * t) * wave);
      }
      // The elements' frequencies, and so the phases over three half waves, have errors of at most 2e-3.
      EXPECT_NEAR(response.outputs[i](0, 0), expected, 0.02 * sag) << beam.section << response.times[i];
    }
  }
}

// Slow poles of reduced models stay stable, although the fast poles are faster by many powers of ten.
TEST(ThinBeams, SmallerModelsKeepTheBound) {
  const LinearModel model = thin_beam(kStrip.section, kStrip.axis);
  const double first = kStrip.frequency(0) / (2 * kPi);
  for (const int order : {2, 6}) {
    const ReducedModel small = reduced(model, order);
    EXPECT_EQ(small.kept, 0);
    const VectorXd& values = small.hankel_singular_values;
    const double bound = 2 * values.tail(values.size() - order).sum();
    // The Hankel singular value of a single mode is half its gain at resonance. The resonance of the first mode is its
    // static deflection times 1/(2 ratio).
    const double resonance =
        4 / (kDensity * kStrip.area * std::pow(kStrip.frequency(0), 2)) / (kDamping * kStrip.frequency(0));
    EXPECT_NEAR(values[0] / (0.5 * resonance), 1, 0.02);
    EXPECT_LT(largest_error(model, small.model, logarithmic(0.01 * first, 100 * first, 60)), bound + 1e-6 * values[0])
        << order;
  }
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
