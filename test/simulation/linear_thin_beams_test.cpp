// Tests linear models of very thin beams, whose motions differ in speed by many powers of ten: gains, poles, responses
// to steps, and smaller models.
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/linear_reduction.h"
#include "flexarm/simulation/linear_response.h"
#include "math/pi.h"
#include "simulation/gain_errors.h"
#include "support/scene_text.h"

namespace flexarm {
namespace {

using Complex = std::complex<double>;
using Eigen::VectorXd;
using test::largest_error;
using test::logarithmic;

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

}  // namespace
}  // namespace flexarm
