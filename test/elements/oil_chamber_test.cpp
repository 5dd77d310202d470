// Tests the law of oil in a chamber: exact account of energy, derivatives against differences, relief and voids.
#include "elements/oil_chamber.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flexarm::test {
namespace {

constexpr double kBulk = 1e9, kRelief = 2e7;  // [Pa]

struct OilCase {
  const char* name;
  double volume, content, end_volume, inflow;  // [l]
};

// Volumes of a litre, which the relief pressure makes 2 % smaller.
const std::vector<OilCase> kOilCases = {
    {"compressed", 1.0, 1.005, 0.995, 0},
    {"decompressed", 1.0, 1.012, 1.006, 0},
    {"filled", 1.0, 1.005, 1.0, 0.004},
    {"filled while it grows", 1.0, 1.005, 1.1, 0.105},
    {"emptied while it shrinks", 1.0, 1.005, 0.9, -0.098},
    {"becomes void", 1.0, 1.003, 1.02, 0},
    {"becomes void by its outflow", 1.0, 1.003, 1.0, -0.01},
    {"stays void", 1.02, 1.0, 1.03, 0.001},
    {"is filled again", 1.02, 1.0, 0.99, 0},
    {"relieved", 1.0, 1.01, 0.98, 0},
    {"relieved while it is filled", 1.0, 1.01, 1.0, 0.02},
    {"relieved from a void", 1.01, 1.0, 0.97, 0},
    {"at rest", 1.0, 1.005, 1.0, 0},
};

OilStep step_of(const OilCase& tested, bool at_end, double by_volume = 0, double by_oil = 0, bool makes_up = false) {
  const OilChamber oil{kBulk, kRelief, makes_up};
  return oil.over(1e-3 * tested.volume, 1e-3 * tested.content, 1e-3 * tested.end_volume + by_volume,
                  1e-3 * (tested.content + tested.inflow) + by_oil, at_end);
}

}  // namespace

// Differences of energies of up to 200 J, from contents with a round-off of 2e-19 m^3 at 2e7 Pa.
TEST(OilChamber, KeepsTheAccount) {
  for (const bool makes_up : {false, true})
    for (const OilCase& tested : kOilCases) {
      const OilChamber oil{kBulk, kRelief, makes_up};
      const OilStep step = step_of(tested, false, 0, 0, makes_up);
      const double work =
          step.price * 1e-3 * tested.inflow - step.pressure * 1e-3 * (tested.end_volume - tested.volume);
      const double change =
          oil.energy(1e-3 * tested.end_volume, step.content) - oil.energy(1e-3 * tested.volume, 1e-3 * tested.content);
      EXPECT_NEAR(work, change + step.dissipated, 2e-11) << tested.name;
      EXPECT_GE(step.pressure, 0) << tested.name;
      EXPECT_GE(step.dissipated, 0) << tested.name;
    }
}

// Steps of 1e-9 m^3 change pressures by 1e3 Pa of 2e7. Truncation: the third derivative of a mean pressure across the
// border of a void is up to 2 B / (V x^2) for a way x of 0.01 l, times h^2 / 6; round-off is 1e-9 Pa / h.
TEST(OilChamber, HasItsDerivatives) {
  constexpr double h = 1e-9;
  const double tolerance = 1e-5 * kBulk / 1e-3;
  for (const bool at_end : {false, true})
    for (const OilCase& tested : kOilCases) {
      const OilStep here = step_of(tested, at_end);
      const auto slope = [&](double volume, double inflow, double OilStep::*part) {
        return (step_of(tested, at_end, volume * h, inflow * h).*part -
                step_of(tested, at_end, -volume * h, -inflow * h).*part) /
               (2 * h);
      };
      EXPECT_NEAR(here.by_volume, slope(1, 0, &OilStep::pressure), tolerance) << tested.name;
      EXPECT_NEAR(here.by_oil, slope(0, 1, &OilStep::pressure), tolerance) << tested.name;
      EXPECT_NEAR(here.price_by_volume, slope(1, 0, &OilStep::price), tolerance) << tested.name;
      EXPECT_NEAR(here.price_by_oil, slope(0, 1, &OilStep::price), tolerance) << tested.name;
    }
}

TEST(OilChamber, IsRelieved) {
  for (const OilCase& tested : kOilCases)
    for (const bool at_end : {false, true}) {
      const OilChamber oil{kBulk, kRelief};
      const OilStep step = step_of(tested, at_end);
      const double pressure = oil.pressure(1e-3 * tested.end_volume, step.content);
      const bool is_relieved = std::string(tested.name).find("relieved") == 0;
      EXPECT_LE(pressure, kRelief + 4e-16 * kBulk) << tested.name;
      EXPECT_EQ(step.dissipated > 0, is_relieved) << tested.name;
      if (!is_relieved) continue;
      EXPECT_NEAR(pressure, kRelief, 4e-16 * kBulk) << tested.name;
    }
}

// A tank fills a void at the end of the step, which costs nothing.
TEST(OilChamber, IsMadeUp) {
  for (const OilCase& tested : kOilCases) {
    const OilStep with = step_of(tested, false, 0, 0, true), without = step_of(tested, false);
    EXPECT_EQ(with.content, std::max(without.content, 1e-3 * tested.end_volume)) << tested.name;
    EXPECT_EQ(with.pressure, without.pressure) << tested.name;
    EXPECT_EQ(with.dissipated, without.dissipated) << tested.name;
  }
}

// A valve that stays open while the volume shrinks holds its pressure: up to the square of the step.
TEST(OilChamber, HoldsTheReliefPressureOverAStep) {
  const OilChamber oil{kBulk, kRelief};
  const double content = oil.content_at(1e-3, kRelief), shrinks = 1e-3;  // part of the volume
  const OilStep step = oil.over(1e-3, content, 1e-3 * (1 - shrinks), content, false);
  EXPECT_NEAR(step.pressure / kRelief, 1 + 0.25 * shrinks * shrinks, 1e-9);
  const double change = oil.energy(1e-3 * (1 - shrinks), step.content) - oil.energy(1e-3, content);
  EXPECT_NEAR(step.dissipated, step.pressure * 1e-3 * shrinks - change, 2e-11);
}

TEST(OilChamber, HasItsPressure) {
  const OilChamber oil{kBulk};
  const double round_off = 4e-16 * kBulk;
  EXPECT_NEAR(oil.pressure(0.98, 1), 0.02 * kBulk, round_off);
  EXPECT_NEAR(oil.energy(0.98, 1), 0.5 * kBulk * 0.02 * 0.02, 0.02 * round_off);
  EXPECT_EQ(oil.pressure(1.01, 1), 0);
  EXPECT_EQ(oil.energy(1.01, 1), 0);
  EXPECT_NEAR(oil.pressure(0.98, oil.content_at(0.98, 3e7)), 3e7, round_off);
}

}  // namespace flexarm::test
