// Tests the acceleration at the end of a step that MeanRates computes from the last four steps.
#include "simulation/published_motion.h"

#include <gtest/gtest.h>

namespace flexarm::test {
namespace {

/// Mean rates of a position over steps that end at t = 0.
template <class Place>
MeanRates rates_of(const Place& place, const std::array<double, 4>& length) {
  MeanRates rates;
  rates.count = 4;
  rates.length = length;
  double end = 0;
  for (int k = 0; k < 4; ++k) {
    rates.rate[k] = (place(end, k) - place(end - length[k], k + 1)) / length[k];
    end -= length[k];
  }
  return rates;
}

const Vector3 kA(1, -2, 3), kB(0.5, 4, -1), kC(2, 1, 1);

TEST(MeanRates, AreExactForAcceleratedMotions) {
  const auto place = [](double t, int) { return Vector3(kA * t * t / 2 + kB * t + kC); };
  for (const std::array<double, 4>& length :
       {std::array{0.1, 0.1, 0.1, 0.1}, std::array{0.1, 0.05, 0.2, 0.1}, std::array{0.025, 0.05, 0.1, 0.1}})
    EXPECT_LE((rates_of(place, length).change_at_end() - kA).norm(), 1e-11);
}

TEST(MeanRates, AreOfSecondOrder) {
  const auto error = [](double h) {
    const auto place = [](double t, int) { return Vector3(kA * std::exp(t) + kB * std::sin(t)); };
    return (rates_of(place, {h, h, h, h}).change_at_end() - kA).norm();
  };
  EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), 2, 0.1);
}

// A mode that the steps do not resolve makes the position alternate from step to step.
TEST(MeanRates, DoNotRing) {
  constexpr double h = 0.01;
  const auto place = [](double t, int k) { return Vector3(kA * t * t / 2 + (k % 2 ? 1e-3 : -1e-3) * kB); };
  const Vector3 found = rates_of(place, {h, h, h, h}).change_at_end();
  EXPECT_LE((found - kA).norm(), 1e-9) << "4e-3 kB / h^2 = " << 4e-3 * kB.norm() / (h * h) << " in second differences";
}

TEST(MeanRates, DoNotOvershootAJump) {
  constexpr double h = 0.01;
  for (const double jump : {-0.5 * h, -1.2 * h, -2.3 * h, -3.4 * h}) {
    const auto place = [&](double t, int) { return Vector3((t > jump ? (t - jump) * (t - jump) / 2 : 0) * kA); };
    const double part = rates_of(place, {h, h, h, h}).change_at_end().dot(kA) / kA.squaredNorm();
    EXPECT_GE(part, -1e-9) << jump;
    EXPECT_LE(part, 1.3) << jump;
  }
}

TEST(MeanRates, NeedTwoSteps) {
  MeanRates rates;
  EXPECT_EQ(rates.change_at_end(), Vector3(0, 0, 0));
}

}  // namespace
}  // namespace flexarm::test
