// The thesis's examples by flexarm's default contact, against what the text states of them.
#include "bench/thesis.h"

#include <gtest/gtest.h>

#include <numeric>

namespace flexarm::bench {
namespace {

const std::string kScenes = std::string(FLEXARM_SOURCE_DIR) + "/config/thesis";

ThesisOutcome outcome_of(const std::string& number, const std::string& label, double step) {
  for (const ThesisExample& example : thesis_examples())
    for (const ThesisRun& run : example.runs)
      if (example.number == number && run.label == label && run.step == step)
        return run_thesis(kScenes, example, run, false);
  throw std::invalid_argument(number + " " + label);
}

/// Energy closes to what Newton's method leaves per step; so many steps of them.
constexpr double kClosed = 1e-7;

// 6.25 s by the rigid estimate L / (w c); stiffer beams come closer to it, node-to-node and node-to-element alike.
TEST(Thesis, StiffArmsDescendAsTheRigidEstimateSays) {
  for (const char* how : {"node-to-node, em", "node-to-element, em, sm_em"}) {
    double last = 0.7;
    for (const char* factor : {"", "E x 10, ", "E x 100, ", "E x 100000, "}) {
      const ThesisOutcome out = outcome_of("12.1", factor + std::string(how), 0.02);
      ASSERT_TRUE(out.arrival) << factor << how;
      EXPECT_LT(std::abs(*out.arrival - 6.25), last) << factor << how;
      EXPECT_LT(out.energy_defect, kClosed);
      last = std::abs(*out.arrival - 6.25);
    }
    // The tangent-scaled rule turns by 2 atan(h w / 2) in a step, 0.21 % less than h w.
    EXPECT_LT(last, 6.25 * 0.0022 + 0.02) << how;
  }
}

TEST(Thesis, SlidersPassTheirBordersWhenTheThesisSays) {
  const ThesisOutcome descends = outcome_of("12.1", "node-to-element, em, sm_em", 0.02);
  ASSERT_TRUE(descends.arrival);
  EXPECT_NEAR(*descends.arrival, 6.78, 0.02);  // the last step computed there
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
