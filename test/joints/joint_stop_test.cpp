// Tests stops of joints: effort and energy over a step, depth of penetration, and restitution.
#include "joints/joint_stop.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "joints/coordinate_steps.h"
#include "math/pi.h"

namespace flexarm {
namespace {

using namespace test;

constexpr double kLower = -1, kUpper = 2, kStiffness = 50, kInertia = 2;

/// Stops with the largest penetration `give`. If it is infinite, the stop is linear.
LimitStop stops(double give, double damping = 0) {
  LimitStop out{kLower, kUpper, kInertia, give, give};
  out.stiffness = kStiffness;
  out.damping = damping;
  return out;
}
/// The same with a contact time [s], and a restitution of 0.3.
LimitStop stops_for(double give, double contact_time) {
  LimitStop out = stops(give);
  out.contact_time = contact_time;
  out.carry(kInertia);
  return out;
}
const double kGives[] = {LimitStop::kInfinity, 0.7};

/// A step of the Newmark family, whose effort acts at the end. `blur`: see CoordinateStep.
CoordinateStep step_to_end(double begin, double end, double step, double begin_rate, double blur) {
  CoordinateStep change = step_between(begin, end, step);
  change.at_end = true;
  change.gamma = 0.5;
  change.begin_rate = begin_rate;
  change.blur = blur;
  return change;
}

double stop_slope_by_difference(const LimitStop& limit, const CoordinateStep& change, double scale) {
  return slope_by_difference([&](const CoordinateStep& moved) { return stop_effort(limit, moved).effort; }, change,
                             scale);
}

/// Positions inside, at, and beyond both stops.
const double kPositions[] = {-1.6, -1.2, -1.0, -0.99, 0.0, 1.5, 2.0, 2.001, 2.5};

TEST(StopEffort, InStaticsIsTheGradientOfItsEnergy) {
  for (const double give : kGives) {
    const LimitStop limit = stops(give, 3);
    for (const double position : {-1.5, -0.3, 1.9, 2.4}) {
      const CoordinateStep rest = step_between(0.0, position, 0);
      const PassiveEffort effort = stop_effort(limit, rest);
      const double gradient = scalar_difference([&](double h) { return stop_energy(limit, position + h); }, 1e-2);
      EXPECT_NEAR(effort.effort, -gradient, 1e-8 * (1 + std::abs(gradient)));
      EXPECT_NEAR(effort.slope, stop_slope_by_difference(limit, rest, 0.1), 1e-8 * (1 + std::abs(effort.slope)));
    }
  }
}

// For every kind of contact, the work of the stop equals minus the change of its energy minus the dissipation.
TEST(StopEffort, ClosesTheEnergyBudget) {
  for (const double give : kGives)
    for (const double damping : {0.0, 0.5, 40.0}) {
      const LimitStop limit = stops(give, damping);
      for (const double begin : kPositions)
        for (const double end : kPositions) {
          const CoordinateStep change = step_between(begin, end, 0.1);
          const PassiveEffort effort = stop_effort(limit, change);
          const double before = stop_energy(limit, begin), after = stop_energy(limit, end);
          const double scale = std::abs(effort.effort * change.increment) + before + after + 1;
          EXPECT_NEAR(effort.effort * change.increment + after - before + effort.dissipated, 0, 1e-14 * scale)
              << begin << " -> " << end;
          EXPECT_GE(effort.dissipated, -1e-15) << begin << " -> " << end;
          EXPECT_TRUE(damping > 0 || effort.dissipated == 0);
        }
    }
}

// The formulas do not lose digits by cancellation, near the largest penetration and for increments of any size.
TEST(StopEffort, BudgetClosesInTheDepth) {
  const LimitStop limit = stops(0.5, 0);
  for (const double room : {0.1, 1e-2, 1e-4})
    for (const double part : {0.5, 1e-3, 1e-7}) {
      const double begin = kUpper + 0.5 - room, end = begin + part * room;
      const double work = stop_effort(limit, step_between(begin, end, 0.1)).effort * (end - begin);
      const double before = stop_energy(limit, begin), after = stop_energy(limit, end);
      // Tolerance: round-off of the energies, i.e. of a position, times the derivative of the energy.
      EXPECT_NEAR(work + after - before, 0, 1e-15 * after * 6 * (1 + kUpper / room)) << room << " " << part;
    }
}

// The effort of a stop always pushes outwards, or is zero.
TEST(StopEffort, NeverPulls) {
  for (const double give : kGives)
    for (const double damping : {0.5, 40.0}) {
      const LimitStop limit = stops(give, damping);
      for (const double begin : kPositions)
        for (const double end : kPositions) {
          if ((begin < 0) != (end < 0)) continue;  // a step from one stop to the other
          for (const CoordinateStep& change :
               {step_between(begin, end, 0.1), step_to_end(begin, end, 0.1, (end - begin) / 0.1, 0.1)}) {
            const double effort = stop_effort(limit, change).effort;
            EXPECT_GE(begin < 0 ? effort : -effort, 0) << begin << " -> " << end;
          }
        }
    }
}

TEST(StopEffort, Slope) {
  for (const double give : kGives)
    for (const double damping : {0.0, 0.5, 40.0}) {
      const LimitStop limit = stops(give, damping);
      for (const double begin : {-1.6, -1.2, -0.9, 0.5, 1.9, 2.3})
        for (const double end : {-1.61, -1.15, -0.95, 0.45, 1.92, 2.33})
          for (const CoordinateStep& change :
               {step_between(begin, end, 0.1), step_to_end(begin, end, 0.1, 10 * (end - begin) + 0.1, 0.1)}) {
            const double slope = stop_effort(limit, change).slope;
            // Round-off of a difference of the quotient: epsilon / (increment * step).
            EXPECT_NEAR(slope, stop_slope_by_difference(limit, change, 0.01), 1e-6 * (1 + std::abs(slope)))
                << begin << " -> " << end << " damping " << damping << " give " << give << " " << change.at_end;
          }
    }
}

// The effort does not jump at touch and release. So a step that just touches has a solution.
TEST(StopEffort, IsContinuousAtTouchAndRelease) {
  for (const double give : kGives) {
    const LimitStop limit = stops(give, 40);
    for (const double begin : {1.5, 1.99, 2.3})
      for (const bool at_end : {false, true}) {
        const auto effort = [&](double end) {
          const double rate = (2.0 - begin) / 0.1;
          return stop_effort(limit, at_end ? step_to_end(begin, end, 0.1, rate, 0.1) : step_between(begin, end, 0.1))
              .effort;
        };
        EXPECT_NEAR(effort(2.0 - 1e-9), effort(2.0 + 1e-9), 1e-5);  // slopes of 40 / 0.1 and 50 * 0.3 / 0.01, over 2e-9
      }
  }
}

TEST(StopEffort, IsContinuousForVanishingIncrements) {
  for (const double give : kGives) {
    const LimitStop limit = stops(give, 0);
    const PassiveEffort at_rest = stop_effort(limit, step_between(-1.2, -1.2, 0.1));
    const PassiveEffort gradient = stop_effort(limit, step_between(-1.2, -1.2, 0));
    EXPECT_NEAR(at_rest.effort, gradient.effort, 1e-12);
    EXPECT_NEAR(at_rest.slope, 0.5 * gradient.slope, 1e-12 * std::abs(gradient.slope)) << "one end moves";
    for (const double increment : {1e-15, 1e-13, 1e-12, 3e-12, 1e-9})
      EXPECT_NEAR(stop_effort(limit, step_between(-1.2, -1.2 + increment, 0.1)).effort, at_rest.effort,
                  -at_rest.slope * increment + 1e-12);
  }
}

// The effort grows without bound. So any force is held before the largest penetration.
TEST(StopEffort, GrowsWithoutBound) {
  const LimitStop limit = stops(0.5, 0);
  double last = 0;
  for (const double room : {0.3, 0.1, 1e-2, 1e-3, 1e-4}) {
    const double effort = -stop_effort(limit, step_between(0, kUpper + 0.5 - room, 0)).effort;
    EXPECT_GT(effort, last);
    last = effort;
  }
  EXPECT_GT(last, 1e12);
  // At a shallow penetration the stop is nearly linear: the effort is larger by the fraction 5 (p/d)^2.
  const double shallow = stop_effort(limit, step_between(0, kLower - 1e-3, 0)).effort;
  EXPECT_NEAR(shallow, kStiffness * 1e-3, 1.1 * kStiffness * 1e-3 * 8 * std::pow(1e-3 / 0.5, 2));
}

/// A mass against a stop, by the midpoint rule 2 m/h (du/h - v) = Q or by Newmark's rule. It halves steps as Stepper
/// does.
struct Mass {
  const LimitStop& limit;
  bool at_end;
  double blur;
  double position, velocity, acceleration = 0, dissipated = 0;

  CoordinateStep change(double increment, double h) const {
    return at_end ? step_to_end(position, position + increment, h, velocity, blur)
                  : step_between(position, position + increment, h);
  }
  double residual(double increment, double h) const {
    const double inertial =
        at_end ? 4 / h * (increment / h - velocity) - acceleration : 2 / h * (increment / h - velocity);
    return kInertia * inertial - stop_effort(limit, change(increment, h)).effort;
  }
  /// Bisection, since the residual is monotonic in the increment.
  double solve(double h) const {
    double low = -10, high = 10;
    high = std::min(high, limit.upper + limit.give_above - position);
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      (residual(middle, h) > 0 ? high : low) = middle;
    }
    return 0.5 * (low + high);
  }
  void advance(double h) {
    double increment = solve(h);
    while (is_coarse(limit, change(increment, h)) && swings(limit, change(increment, h), velocity))
      increment = solve(h *= 0.5);
    dissipated += stop_effort(limit, change(increment, h)).dissipated;
    acceleration = 4 / h * (increment / h - velocity) - acceleration;
    position += increment;
    velocity = 2 * increment / h - velocity;
  }
  double energy() const { return 0.5 * kInertia * velocity * velocity + stop_energy(limit, position); }
};

TEST(StopEffort, EnergyThroughAHit) {
  for (const double give : {LimitStop::kInfinity, 0.1, 1e-3})
    for (const double damping : {0.0, 4.0})
      for (const bool at_end : {false, true}) {
        const LimitStop limit = stops(give, damping);
        Mass mass{limit, at_end, 0.02, 1.5, 1.0};
        const double start = mass.energy();
        // A position's round-off, 4e-16, grows in the energy by the factor 4 over the remaining penetration. This is at
        // least a 30th of the largest penetration, over some steps.
        const double round_off = std::max(1e-12, 2e-13 / give) * start;
        double deepest = 0;
        for (int step = 0; step < 200 && (mass.velocity > 0 || mass.position > limit.upper); ++step) {
          mass.advance(0.02);
          deepest = std::max(deepest, mass.position - limit.upper);
          // Newmark's rule conserves the energy only of linear systems, so the balance is checked for the midpoint rule
          // alone.
          EXPECT_TRUE(at_end || std::abs(mass.energy() + mass.dissipated - start) <= round_off) << give;
        }
        EXPECT_GT(deepest, 0);
        EXPECT_LT(deepest, give);
        EXPECT_LT(mass.velocity, 0);
        EXPECT_NEAR(mass.energy() + mass.dissipated, start, round_off) << give << " " << at_end;
        EXPECT_TRUE(at_end || (mass.dissipated > 0.01) == (damping > 0));
      }
}

/// Ratio of the speeds after and before a hit. `steps`: number of steps in the contact time of a shallow hit.
double restitution(double give, double speed, double steps, bool at_end) {
  const double contact_time = 1e-2;
  const LimitStop limit = stops_for(give, contact_time);
  Mass mass{limit, at_end, contact_time / steps, limit.upper - 0.3 * speed * contact_time / steps, speed};
  for (int step = 0; step < 1000000 && (mass.velocity > 0 || mass.position > limit.upper); ++step)
    mass.advance(contact_time / steps);
  return -mass.velocity / speed;
}

// The restitution is that of a linear stop, 0.3, at any depth of the hit, with an error below 10 %. A step covers at
// most a fifth of half a turn of the oscillation. The midpoint rule turns by less, by a twelfth of the square of this
// angle, 3 %. This makes 4 % of the restitution by the damper. The rest is because the release falls into the middle of
// a step.
TEST(StopEffort, RestitutionIsTheSameAtAllSpeeds) {
  for (const double speed : {0.1, 1.0, 8.0, 20.0, 50.0, 200.0, 1000.0})
    EXPECT_NEAR(restitution(0.01, speed, 10, false), 0.3, 0.03) << speed;
}

// A hit at 3 m/s takes full steps, so its error converges as that of the midpoint rule.
TEST(StopEffort, RestitutionConverges) {
  for (const bool at_end : {false, true})
    for (const double steps : {80.0, 320.0}) {
      EXPECT_NEAR(restitution(LimitStop::kInfinity, 1, steps, at_end), 0.3, 0.6 / steps) << at_end;
      EXPECT_NEAR(restitution(0.01, 3, steps, at_end), 0.3, 3 / steps) << at_end;
    }
}

// The scene's step, a tenth of the contact time, is fine enough for light touches, and for a coordinate at rest on its
// stop.
TEST(StopEffort, LightTouchesAndRestAreNoHits) {
  const double contact_time = 1e-2, h = contact_time / 10;
  const LimitStop limit = stops_for(0.5, contact_time);
  EXPECT_FALSE(is_coarse(limit, step_between(1.9, 1.95, h)));
  EXPECT_FALSE(is_coarse(limit, step_between(2.0, 2.05, h)));
  const CoordinateStep pressed = step_between(2.45, 2.45 + 1e-9, h);
  EXPECT_TRUE(is_coarse(limit, pressed));
  EXPECT_FALSE(swings(limit, pressed, 1e-6));
  EXPECT_TRUE(swings(limit, pressed, 1e4)) << "it is thrown back in one step";
}

TEST(StopUpdate, GoesHalfTheWayAtMost) {
  const LimitStop limit = stops(0.5);
  EXPECT_EQ(admissible_part(limit, 0, 2.2), 1);
  EXPECT_EQ(admissible_part(limit, 2.4, -1.2), 1) << "away from one stop, lightly into the other";
  EXPECT_DOUBLE_EQ(admissible_part(limit, 0, 9), 2.25 / 9);
  EXPECT_DOUBLE_EQ(admissible_part(limit, 2.25, 2.75), 0.25);
  EXPECT_DOUBLE_EQ(admissible_part(limit, 0, -5), 1.25 / 5);
  EXPECT_EQ(admissible_part(limit, 2.7, 2.1), 1) << "comes back from beyond";
  EXPECT_EQ(admissible_part(stops(LimitStop::kInfinity), 0, 1e9), 1);
}

// Spring and damper give the requested contact time, and 30 % of the speed after the hit. So does a given stiffness.
TEST(LimitStop, ContactTimeAndRestitution) {
  const LimitStop limit = stops_for(LimitStop::kInfinity, 1e-2);
  const double k = limit.stiffness, c = limit.damping;
  LimitStop given = stops_for(LimitStop::kInfinity, 0.0);
  given.stiffness = k;
  given.carry(kInertia);
  EXPECT_EQ(given.stiffness, k);
  EXPECT_NEAR(given.damping, c, 1e-14 * c);
  EXPECT_NEAR(hit_time(given), 1e-2, 1e-15);
  const double omega = std::sqrt(k / kInertia);
  EXPECT_NEAR(omega, kPi / 1e-2, 1e-9 * omega);
  // The equation m x'' = min(0, -k x - c x') from unit speed, integrated with a small step until the force vanishes.
  double x = 0, v = 1;
  const double h = 1e-8;
  while (k * x + c * v > 0) {
    const double middle = v - 0.5 * h * (k * x + c * v) / kInertia;
    v -= h * (k * (x + 0.5 * h * v) + c * middle) / kInertia;
    x += h * middle;
  }
  EXPECT_NEAR(-v, 0.3, 1e-3);
}

TEST(StopEnergy, VanishesInside) {
  for (const double give : kGives)
    for (const double position : {-1.0, 0.0, 2.0}) EXPECT_EQ(stop_energy(stops(give), position), 0);
  const LimitStop linear = stops(LimitStop::kInfinity);
  EXPECT_NEAR(stop_energy(linear, -1.5), 0.5 * kStiffness * 0.25, 1e-13);
  EXPECT_NEAR(stop_energy(linear, 2.5), 0.5 * kStiffness * 0.25, 1e-13);
  EXPECT_TRUE(std::isfinite(stop_energy(stops(0.7), 100))) << "a state beyond all bounds";
}

}  // namespace
}  // namespace flexarm
