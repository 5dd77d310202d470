// Compares the thesis's examples with flexarm's default contact with the thesis's results.
#include "bench/thesis.h"
#include "support/source_path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flexarm::bench {
namespace {

const std::string kScenes = test::source_path("config/thesis");

ThesisOutcome outcome_of(const std::string& number, const std::string& label, double step) {
  for (const ThesisExample& example : thesis_examples())
    for (const ThesisRun& run : example.runs)
      if (example.number == number && run.label == label && run.step == step)
        return run_thesis(kScenes, example, run, false);
  throw std::invalid_argument(number + " " + label);
}

/// Tolerance of the energy account: the error of Newton's method in thousands of steps.
constexpr double kClosed = 1e-8;

// The rigid estimate is L / (w c) = 6.25 s. Stiffer beams come closer to it, with both node-to-node and node-to-element
// contact.
TEST(Thesis, StiffArmsDescendAsTheRigidEstimateSays) {
  // The arm (0.5 kg) starts without descent. Its descent reduces the spin: w J = w' (J + m c^2).
  const double J = 0.125 / 3 + 0.01 * 0.5, rigid = 6.25 * (1 + 0.5 * 0.02 * 0.02 / J);
  for (const char* how : {"node-to-node, em", "node-to-element, em, sm_em"}) {
    double last = 1;
    for (const auto& [name, factor] :
         {std::pair{"", 1.0}, {"E x 10, ", 10.0}, {"E x 100, ", 1e2}, {"E x 100000, ", 1e5}}) {
      const ThesisOutcome out = outcome_of("12.1", name + std::string(how), 0.02);
      ASSERT_TRUE(out.arrival) << name << how;
      EXPECT_LT(std::abs(*out.arrival - rigid), last) << name << how;
      // Newton's method leaves 1e-15 m in a step, against forces up to EA. The kinetic energy is 1.5 J.
      EXPECT_LT(out.energy_defect, 350 * 1e-15 * 1e4 * factor / 1.5);
      last = std::abs(*out.arrival - rigid);
    }
    // The tangent-scaled rule turns by 2 atan(h w / 2) in a step, 0.21 % less than h w.
    EXPECT_LT(last, 0.0022 * rigid) << how;
  }
}

TEST(Thesis, SlidersPassTheirBordersWhenTheThesisSays) {
  const ThesisOutcome descends = outcome_of("12.1", "node-to-element, em, sm_em", 0.02);
  ASSERT_TRUE(descends.arrival);
  EXPECT_NEAR(*descends.arrival, 6.78, 0.02);  // the last step that the thesis computed
  ASSERT_GE(descends.crossings.size(), 2u);
  EXPECT_NEAR(descends.crossings[0], 1.76, 0.04);
  EXPECT_NEAR(descends.crossings[1], 3.48, 0.04);

  for (const double step : {0.002, 0.004}) {
    const ThesisOutcome slides = outcome_of("12.2", "em, sm_em", step);
    ASSERT_TRUE(slides.arrival) << step;
    EXPECT_EQ(slides.halvings, 0);
    EXPECT_NEAR(slides.crossings[0], 0.088, 2 * step);
    EXPECT_NEAR(slides.crossings[1], 0.160, 2 * step);
    EXPECT_LT(slides.energy_defect, 1e-10);
    EXPECT_LT(slides.angular_momentum_defect, 1e-11);
  }
}

TEST(Thesis, SmoothLinesTakeFourTimesTheStep) {
  const std::tuple<const char*, const char*, double> runs[] = {
      {"12.1", "node-to-element, em, sm_em, smooth line", 0.08},
      {"12.2", "em, sm_em, smooth line", 0.008},
      {"12.3", "H2, em, sm_em, smooth line", 2e-3},
      {"12.4", "H1, em, sm_em, smooth line", 4e-3},
      {"12.4", "H2, em, sm_em, smooth line", 4e-3},
      {"12.5", "node-to-element, em, sm_em, smooth line", 0.04}};
  for (const auto& [number, label, step] : runs) {
    const ThesisOutcome out = outcome_of(number, label, step);
    EXPECT_FALSE(out.failure) << number << " " << label << ": at " << out.end << " s";
    EXPECT_LT(out.energy_defect, kClosed) << number << " " << label;
  }
}

}  // namespace
}  // namespace flexarm::bench
