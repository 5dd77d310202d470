// Tests how lines slip over guides with friction: ratios of tensions, derivatives against differences.
#include "elements/tendon_slip.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace flexarm::test {
namespace {

const TendonLaw kLaw{1000, 2};

/// Parts of 1 m of rest length that are stretched by these amounts at the end of a step, and by half of them before.
std::vector<TendonPartStep> parts_with(const std::vector<double>& stretches) {
  std::vector<TendonPartStep> parts;
  for (const double stretch : stretches) parts.push_back({{1 + 0.5 * stretch, 1}, {1 + stretch, 1}, 0.01});
  return parts;
}

TEST(TendonSlip, SticksWithinTheRatio) {
  TendonSlip slip;
  ASSERT_TRUE(slip.solve(kLaw, parts_with({0.01, 0.012, 0.009}), {1.5, 1.5}));
  EXPECT_EQ(slip.slips().norm(), 0);
}

TEST(TendonSlip, SlipsUntilTheRatioIsReached) {
  TendonSlip slip;
  ASSERT_TRUE(slip.solve(kLaw, parts_with({0.01, 0.03, 0.001}), {1.5, 2}));
  EXPECT_GT(slip.slips()[0], 0);  // towards the larger tension
  EXPECT_LT(slip.slips()[1], 0);
  EXPECT_NEAR(slip.ends()[1].tension, 1.5 * slip.ends()[0].tension, 1e-9);
  EXPECT_NEAR(slip.ends()[1].tension, 2 * slip.ends()[2].tension, 1e-9);
}

TEST(TendonSlip, WithoutFrictionTensionsAreEqual) {
  TendonSlip slip;
  ASSERT_TRUE(slip.solve(kLaw, parts_with({0.01, 0.03, 0.001, 0, -0.01}), {1, 1, 1, 1}));
  for (const TendonStep& step : slip.ends()) EXPECT_NEAR(step.tension, slip.ends()[0].tension, 1e-9);
}

TEST(TendonSlip, NeverSlipsWhereItGrips) {
  TendonSlip slip;
  ASSERT_TRUE(slip.solve(kLaw, parts_with({0.01, 0.5}), {TendonSlip::kNever}));
  EXPECT_EQ(slip.slips()[0], 0);
}

// A slack part gives its line to a taut one until that is slack, too, or both are taut.
TEST(TendonSlip, TakesFromSlackParts) {
  TendonSlip slip;
  ASSERT_TRUE(slip.solve(kLaw, parts_with({-0.1, 0.02}), {2}));
  EXPECT_NEAR(slip.ends()[1].tension, 0, 1e-9);
  EXPECT_GE(slip.slips()[0], 0);
}

/// Checks that no ratio is exceeded by more than `tolerance` [N], and that the line slips only at its ratio, towards
/// the larger tension.
void expect_balance(const std::vector<TendonStep>& ends, const std::vector<double>& ratios,
                    const Eigen::VectorXd& slips, double tolerance) {
  for (Eigen::Index i = 0; i < slips.size(); ++i) {
    const double before = ends[i].tension, behind = ends[i + 1].tension, ratio = ratios[i];
    if (ratio == TendonSlip::kNever) {
      EXPECT_EQ(slips[i], 0);
      continue;
    }
    EXPECT_LE(behind, ratio * before + tolerance) << i;
    EXPECT_LE(before, ratio * behind + tolerance) << i;
    if (slips[i] > 0) {
      EXPECT_NEAR(behind, ratio * before, tolerance) << i;
    }
    if (slips[i] < 0) {
      EXPECT_NEAR(before, ratio * behind, tolerance) << i;
    }
  }
}

// Tensions are rounded by EA times the machine's precision, magnified by the ratio.
TEST(TendonSlip, SlipsOverManyGuides) {
  std::mt19937 random(5);
  const auto number = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  };
  TendonSlip slip;
  SlipChain chain;
  for (int trial = 0; trial < 300; ++trial) {
    const int guides = 1 + trial % 40;
    const double friction = std::pow(10.0, number(-5, 0.5));
    const TendonLaw law{std::pow(10.0, number(1, 6)), trial % 3 == 0 ? 2.0 : 0.0};
    std::vector<double> stretches, ratios;
    for (int i = 0; i <= guides; ++i) stretches.push_back(number(trial % 4 == 0 ? -0.02 : 0.001, 0.05));
    for (int i = 0; i < guides; ++i)
      ratios.push_back(number(0, 1) < 0.05 ? TendonSlip::kNever : std::exp(friction * number(0, 2)));
    const std::vector<TendonPartStep> parts = parts_with(stretches);
    ASSERT_TRUE(slip.solve(law, parts, ratios)) << trial;
    expect_balance(slip.ends(), ratios, slip.slips(), 1e-8 * law.stiffness);

    Eigen::VectorXd slips(guides);
    chain.solve(law, parts, ratios, slips);
    std::vector<TendonStep> ends;
    for (int p = 0; p <= guides; ++p)
      ends.push_back(parts[p].at_last(law, (p > 0 ? slips[p - 1] : 0) - (p < guides ? slips[p] : 0)));
    expect_balance(ends, ratios, slips, 1e-9 * law.stiffness);
  }
}

TEST(TendonSlip, FindsTheRestLengthOfATension) {
  TendonPartStep mean{{1.02, 1}, {1.05, 1.001}, 0.01}, end{{1.02, 1}, {1.05, 1.001}, 0.01, true, -2, 40};
  for (const TendonPartStep& part : {mean, end})
    for (const double tension : {1e-9, 0.1, 3.0, 100.0, 1e5}) {
      const double slip = part.rest_at(kLaw, tension) - part.end.rest;
      EXPECT_NEAR(part.at_last(kLaw, slip).tension, tension, 1e-12 * (kLaw.stiffness + tension));
    }
}

// Central differences with the step 1e-6 of a function with kinks, none of which is near: second order.
TEST(TendonSlip, HasItsDerivatives) {
  constexpr double h = 1e-6;
  const std::vector<TendonPartStep> parts = parts_with({0.01, 0.03, 0.029, 0.001, 0.05});
  const std::vector<double> ratios = {1.5, 1.2, 2, TendonSlip::kNever};
  TendonSlip slip;
  ASSERT_TRUE(slip.solve(kLaw, parts, ratios));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(4, 2);  // by the part's length, and by its rest length
    for (int guide = 0; guide < 4; ++guide)
      for (int k = 0; k < 2; ++k)
        if (guide + k == static_cast<int>(p))
          rows.row(guide) << -slip.row(guide).by_length[k], -slip.row(guide).by_rest[k];
    slip.find_slopes(rows);
    const auto slips = [&](double length, double rest) {
      std::vector<TendonPartStep> other = parts;
      other[p].end.length += length;
      other[p].end.rest += rest;
      TendonSlip there;
      EXPECT_TRUE(there.solve(kLaw, other, ratios));
      return Eigen::VectorXd(there.slips());
    };
    EXPECT_LT(((slips(h, 0) - slips(-h, 0)) / (2 * h) - rows.col(0)).norm(), 1e-6);
    EXPECT_LT(((slips(0, h) - slips(0, -h)) / (2 * h) - rows.col(1)).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace flexarm::test
