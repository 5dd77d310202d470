/// Tests the bending of tapered strips against Bessel functions: a truncated wedge, clamped at its thick end. Also
/// tests damping ratios that a scene prescribes.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include "flexarm/simulation/simulation.h"
#include "math/pi.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

constexpr double kYoung = 70e9, kDensity = 2700;
/// Height of the strip over the distance from the wedge's edge. The closed form lacks shear and rotary inertia. These
/// change frequencies by about the square of this ratio times (mode number)^2.
constexpr double kTaper = 3e-4;

/// The determinant of W = W' = 0 at x = 1 and W'' = (x^3 W'')' = 0 at x = cut, for (x^3 W'')'' = (k/2)^4 x W. Its
/// solutions are x^(-1/2) Z_1(k sqrt x), Z = J, Y, I, K (Kirchhoff 1879). Derivatives: d/dx [x^(-n/2) Z_n] = s (k/2)
/// x^(-(n+1)/2) Z_{n+1} and d/dx [x^(n/2) Z_n] = t (k/2) x^((n-1)/2) Z_{n-1}.
double wedge_determinant(double k, double cut) {
  struct Kind {
    double (*value)(double, double);
    double raising, lowering;  // s, t
  };
  const Kind kinds[] = {{[](double n, double x) { return std::cyl_bessel_j(n, x); }, -1, 1},
                        {[](double n, double x) { return std::cyl_neumann(n, x); }, -1, 1},
                        {[](double n, double x) { return std::cyl_bessel_i(n, x); }, 1, 1},
                        {[](double n, double x) { return std::cyl_bessel_k(n, x); }, -1, -1}};
  Eigen::Matrix4d rows;
  for (int c = 0; c < 4; ++c) {
    const auto& [Z, s, t] = kinds[c];
    const double at = k * std::sqrt(cut);
    rows.col(c) << Z(1, k), s * Z(2, k), Z(3, at), t * Z(2, at);
    rows.col(c) /= rows.col(c).cwiseAbs().maxCoeff();
  }
  return rows.determinant();
}

/// The lowest `count` roots k.
std::vector<double> wedge_roots(double cut, int count) {
  std::vector<double> roots;
  const double step = 0.05;
  for (double k = 1; static_cast<int>(roots.size()) < count; k += step) {
    double low = k, high = k + step;
    const double sign = wedge_determinant(low, cut);
    if (sign * wedge_determinant(high, cut) > 0) continue;
    while (high - low > 1e-13 * high) {
      const double middle = 0.5 * (low + high);
      (sign * wedge_determinant(middle, cut) > 0 ? low : high) = middle;
    }
    roots.push_back(low);
  }
  return roots;
}

/// A strip: the wedge of length 1 m without the fraction `cut` at its thin end.
Simulation strip(double cut, const std::string& damping = "") {
  const auto station = [](double at, double height) {
    return fmt::format(R"(<station at="{}"><rectangle width="0.02" height="{}"/></station>)", at, height);
  };
  return Simulation(scene_of(
      robot(fmt::format(R"(<link name="strip"><beam elements="16" order="4"><centerline><line to="{} 0 0"/></centerline>
                             <stations>{}{}</stations><material young="{}" poisson="0.3" density="{}"/>{}</beam></link>)",
                        1 - cut, station(0, kTaper), station(1 - cut, cut * kTaper), kYoung, kDensity, damping) +
                joint("clamp", "fixed", "world", "strip"),
            gravity({0, 0, 0}))));
}

TEST(Wedge, Frequencies) {
  for (const double cut : {0.1, 0.4}) {
    const std::vector<double> roots = wedge_roots(cut, 3);
    const std::vector<Mode> modes = strip(cut).natural_modes(3);
    ASSERT_EQ(modes.size(), 3u);
    for (int i = 0; i < 3; ++i) {
      const double omega = 0.25 * roots[i] * roots[i] * std::sqrt(kYoung / kDensity / 12) * kTaper;
      EXPECT_NEAR(2 * kPi * modes[i].frequency, omega, 1e-5 * omega) << cut << ", mode " << i;
    }
  }
}

TEST(StatedDamping, RatioAtOneFrequency) {
  const std::vector<Mode> undamped = strip(0.4).natural_modes(3);
  const std::vector<Mode> modes =
      strip(0.4, fmt::format(R"(<damping ratio="0.02" frequency="{}"/>)", undamped[0].frequency)).natural_modes(3);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(modes[i].damping_ratio(), 0.02 * undamped[i].frequency / undamped[0].frequency, 1e-4 * 0.02);
}

TEST(StatedDamping, RatioAtTwoFrequencies) {
  const std::vector<Mode> undamped = strip(0.4).natural_modes(3);
  const std::vector<Mode> modes = strip(0.4, fmt::format(R"(<damping ratio="0.02" frequencies="{} {}"/>)",
                                                         undamped[0].frequency, undamped[2].frequency))
                                      .natural_modes(3);
  EXPECT_NEAR(modes[0].damping_ratio(), 0.02, 1e-4 * 0.02);
  EXPECT_LT(modes[1].damping_ratio(), 0.02);
  EXPECT_NEAR(modes[2].damping_ratio(), 0.02, 1e-4 * 0.02);
}

}  // namespace
}  // namespace flexarm::test
