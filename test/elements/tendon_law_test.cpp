// Tests the law of lines that pull and never push: exact account of energy, derivatives against differences.
#include "elements/tendon_law.h"

#include <vector>

#include <gtest/gtest.h>

namespace flexarm::test {
namespace {

struct Ends {
  const char* name;
  TendonLengths begin, end;
};

// Taut and slack ends, with the rest length constant, growing and shrinking.
const std::vector<Ends> kSteps = {
    {"taut", {1.2, 1.1}, {1.25, 1.1}},
    {"slack", {1.0, 1.1}, {1.05, 1.1}},
    {"becomes taut", {1.05, 1.1}, {1.2, 1.1}},
    {"becomes slack", {1.2, 1.1}, {1.05, 1.1}},
    {"paid out", {1.2, 1.1}, {1.25, 1.15}},
    {"wound up", {1.2, 1.1}, {1.12, 0.9}},
    {"slack by paying out", {1.2, 1.1}, {1.22, 1.3}},
    {"taut by winding up", {1.2, 1.3}, {1.18, 1.1}},
    {"at rest", {1.2, 1.1}, {1.2, 1.1}},
};

// The work of both mean forces is the change of the energy and what is dissipated: differences of numbers of the size
// of EA times a length, 100 N m, so to about 1e-13.
TEST(TendonLaw, KeepsTheAccount) {
  for (const double damping : {0.0, 0.3, 50.0})
    for (const auto& [name, begin, end] : kSteps) {
      const TendonLaw law{100, damping};
      const TendonStep step = law.means(begin, end, 0.01);
      const double work = step.tension * (end.length - begin.length) + step.release * (end.rest - begin.rest);
      EXPECT_NEAR(work, law.energy(end) - law.energy(begin) + step.dissipated, 1e-13) << name;
      EXPECT_GE(step.tension, 0) << name;
      EXPECT_GE(step.dissipated, 0) << name;
    }
}

TEST(TendonLaw, HasItsDerivatives) {
  constexpr double h = 1e-6;
  for (const double damping : {0.0, 0.3, 50.0})
    for (const Ends& ends : kSteps) {
      const TendonLengths &begin = ends.begin, &end = ends.end;
      const char* const name = ends.name;
      const TendonLaw law{100, damping};
      const auto means = [&](double length, double rest) {
        return law.means(begin, {end.length + length, end.rest + rest}, 0.01);
      };
      const auto at_end = [&](double length, double rest) {
        const double change = end.length - end.rest + length - rest - begin.length + begin.rest;
        return law.at_end({end.length + length, end.rest + rest}, 0.6 + 150 * change, 150, change);
      };
      const auto expect = [&](const auto& at) {
        const TendonStep here = at(0.0, 0.0);
        const auto slope = [&](double length, double rest, double TendonStep::*part) {
          return (at(length, rest).*part - at(-length, -rest).*part) / (2 * h);
        };
        // Truncation 1e-12 times third derivatives (up to 1e3 / 0.05^2), round-off 1e-16 / 1e-6 times forces.
        const double tolerance = 1e-6 * (1 + damping / 0.01);
        EXPECT_NEAR(here.by_length, slope(h, 0, &TendonStep::tension), tolerance) << name;
        EXPECT_NEAR(here.by_rest, slope(0, h, &TendonStep::tension), tolerance) << name;
        EXPECT_NEAR(here.release_by_length, slope(h, 0, &TendonStep::release), tolerance) << name;
        EXPECT_NEAR(here.release_by_rest, slope(0, h, &TendonStep::release), tolerance) << name;
      };
      expect(means);
      expect(at_end);
    }
}

TEST(TendonLaw, GivesTheEnergyOfAStretchedLine) {
  const TendonLaw law{100, 0};
  EXPECT_DOUBLE_EQ(law.energy({1.5, 1.0}), 100 * 0.25 / 2);
  EXPECT_DOUBLE_EQ(law.tension({1.5, 1.0}), 50);
  EXPECT_EQ(law.energy({0.5, 1.0}), 0);
  EXPECT_EQ(law.tension({0.5, 1.0}), 0);
}

}  // namespace
}  // namespace flexarm::test
