// Tests the benchmark of scaling: the slopes that it fits, the sizes of its scenes, and its report.
#include "bench/scaling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flexarm::bench {
namespace {

// Round-off of logarithms of sizes up to 1e5, in a fit over at least a decade.
constexpr double kSlopeRoundOff = 1e-12;

TEST(Scaling, SlopeOfAPowerLawIsItsExponent) {
  for (const double exponent : {0.0, 1.0, 1.5, 3.0}) {
    std::vector<double> x, y;
    for (const double size : {1.0, 3.0, 10.0, 30.0, 1e3, 1e5}) {
      x.push_back(size);
      y.push_back(7e-6 * std::pow(size, exponent));
    }
    EXPECT_NEAR(log_slope(x, y), exponent, kSlopeRoundOff);
    EXPECT_NEAR(log_slope(x, y, 0.01), exponent, kSlopeRoundOff);
  }
}

TEST(Scaling, SlopeIsTheLeastSquaresFit) {
  // Deviations of log y by +d, -2 d, +d at equal distances in log x are orthogonal to constants and to log x.
  const std::vector<double> x = {1, 10, 100};
  std::vector<double> y;
  for (int i = 0; i < 3; ++i) y.push_back(x[i] * x[i] * std::exp(i == 1 ? -0.2 : 0.1));
  EXPECT_NEAR(log_slope(x, y), 2, kSlopeRoundOff);
}

TEST(Scaling, FixedCostsOfSmallSizesDoNotCount) {
  std::vector<double> x, y;
  for (const double size : {1.0, 10.0, 100.0, 1e3, 1e4}) {
    x.push_back(size);
    y.push_back(size < 50 ? 1.0 : size);
  }
  // For x = 0 ... 4 (decades), y is 0, 0, 2, 3, 4.
  EXPECT_NEAR(log_slope(x, y), 1.1, kSlopeRoundOff);
  EXPECT_NEAR(log_slope(x, y, 0.01), 1, kSlopeRoundOff);
}

TEST(Scaling, OnePointHasNoSlope) {
  EXPECT_TRUE(std::isnan(log_slope({5}, {3})));
  EXPECT_TRUE(std::isnan(log_slope({1, 10, 1000}, {1, 1, 1}, 0.5)));
}

TEST(Scaling, FamiliesHaveTheSizesThatTheySay) {
  // Unknowns: 6 per node of a beam except the clamped node, and 1 per hinge.
  const std::vector<ScalingFamily> families = scaling_families(true);
  ASSERT_EQ(families.size(), 6u);
  const std::size_t in_tree = 6 * (2 * 3 + 2 * (1 + 2 + 3)) + 1;  // branches of 1, 2, 3 elements, the second on a hinge
  const std::size_t expected[] = {6 * 3, 6 * 2 * 3, in_tree, 3, 6 * 3, 6 * 3};
  for (std::size_t i = 0; i < families.size(); ++i) {
    const ScalingPoint point = measure_scaling_point(families[i], 3);
    ASSERT_TRUE(point.completed) << families[i].name;
    EXPECT_EQ(point.unknowns, expected[i]) << families[i].name;
    EXPECT_GE(point.iterations, 1) << families[i].name;
    EXPECT_GT(point.bytes, 8.0 * static_cast<double>(point.unknowns)) << families[i].name;
    for (const double seconds :
         {point.read_seconds, point.first_build_seconds, point.build_seconds, point.step_seconds})
      EXPECT_TRUE(std::isfinite(seconds) && seconds >= 0) << families[i].name;
    EXPECT_LE(point.build_seconds, point.first_build_seconds) << families[i].name;
  }
}

TEST(Scaling, ReportSaysWhatFailed) {
  ScalingReport report;
  report.series.push_back({{"chain", "links", "A chain.", {1, 10, 100}, {}}, {}});
  for (const int size : {1, 10, 100}) {
    ScalingPoint point;
    point.size = size;
    point.unknowns = size;
    point.read_seconds = point.build_seconds = point.step_seconds = 1e-3 * size;
    point.first_build_seconds = 2e-3 * size;
    point.bytes = 1e6 * size * size;
    point.iterations = 2;
    point.completed = size < 100;
    report.series[0].points.push_back(point);
  }
  const std::string text = to_markdown(report, "");
  EXPECT_NE(text.find("| chain | 100 links | 1.00, 1.00 | 1.00, 1.00 | 1.00, 1.00 | 1.00, 1.00 | **2.00**, **2.00** |"),
            std::string::npos)
      << text;
  for (const char* row :
       {"\n| first build [ms] | 1.05 | 1.00: chain | met |\n", "\n| build [ms] | 1.05 | 1.00: chain | met |\n",
        "\n| step [ms] | 1.05 | 1.00: chain | met |\n"})
    EXPECT_NE(text.find(row), std::string::npos) << text;
  EXPECT_NE(text.find("| 100 | 100 | – | – | – | fails |"), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos);
  const std::string data = scaling_to_csv(report);
  EXPECT_NE(data.find("\"chain\",links,10,10,0.01,0.02,0.01,0.01,100000000,2\n"), std::string::npos) << data;
  EXPECT_EQ(data.find(",100,100,"), std::string::npos);
}

}  // namespace
}  // namespace flexarm::bench
