// Passive efforts on coordinates: damping, friction, stops.
#include "joints/joint_forces.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "math/pi.h"

namespace flexarm {
namespace {

using namespace test;

CoordinateStep step_between(double begin, double end, double step) {
  CoordinateStep change;
  change.begin = begin;
  change.end = end;
  change.increment = end - begin;
  change.step = step;
  return change;
}

Coordinate with_stops() {
  Coordinate coordinate;
  coordinate.limit = LimitStop{-1.0, 2.0};
  return coordinate;
}

StopPenalty penalty_with(double damping) {
  return {50, damping};
}

/// d(effort)/d(end) by differences with a step small against `scale`.
double slope_by_difference(const Coordinate& coordinate, const StopPenalty& penalty, CoordinateStep change,
                           double scale) {
  return scalar_difference(
      [&](double h) {
        CoordinateStep moved = change;
        moved.end += h;
        moved.increment += h;
        return passive_effort(coordinate, penalty, moved).effort;
      },
      0.02 * scale);
}

TEST(PassiveEffort, DampingAndFriction) {
  const StopPenalty penalty;
  Coordinate coordinate;
  coordinate.damping = 0.7;
  coordinate.friction = 1.3;
  const double h = 0.01;
  for (const double rate : {-1.0, -2e-3, -1e-4, 0.0, 3e-4, 1e-3, 0.5})
    for (const double gamma : {1.0, 0.5, 0.6}) {
      CoordinateStep change = step_between(0.2, 0.2 + rate * h, h);
      change.increment = rate * h;
      change.gamma = gamma;
      change.begin_rate = gamma == 1.0 ? 123.0 : rate;  // plays no part in the mean rate
      const PassiveEffort effort = passive_effort(coordinate, penalty, change);
      EXPECT_NEAR(effort.effort, -0.7 * rate - 1.3 * std::tanh(rate / kFrictionSpeed), 1e-12);
      EXPECT_GE(effort.dissipated, 0);
      EXPECT_NEAR(effort.dissipated, -effort.effort * change.increment, 1e-15);
      const double scale = kFrictionSpeed * h * gamma;  // of the increment, over which friction changes
      EXPECT_NEAR(effort.slope, slope_by_difference(coordinate, penalty, change, scale), 1e-9 / scale);
    }
}

TEST(PassiveEffort, NoneInStatics) {
  const StopPenalty penalty;
  Coordinate coordinate;
  coordinate.damping = coordinate.friction = 1;
  const PassiveEffort effort = passive_effort(coordinate, penalty, step_between(0, 0, 0));
  EXPECT_EQ(effort.effort, 0);
  EXPECT_EQ(effort.slope, 0);
  EXPECT_EQ(effort.dissipated, 0);
}

TEST(PassiveEffort, StopInStaticsIsTheGradientOfItsEnergy) {
  const Coordinate coordinate = with_stops();
  const StopPenalty penalty = penalty_with(3);
  for (const double position : {-1.5, -0.3, 1.9, 2.4}) {
    const PassiveEffort effort = passive_effort(coordinate, penalty, step_between(0.0, position, 0));
    const double gradient = scalar_difference([&](double h) { return stop_energy(coordinate, penalty, position + h); });
    EXPECT_NEAR(effort.effort, -gradient, 1e-9);
    EXPECT_NEAR(effort.slope, slope_by_difference(coordinate, penalty, step_between(0.0, position, 0), 1), 1e-9);
  }
}

/// Positions on both sides of both stops and on them.
const double kPositions[] = {-1.6, -1.2, -1.0, -0.99, 0.0, 1.5, 2.0, 2.001, 2.5};

// Work of the stop = - change of its energy - what it dissipates, through every kind of contact.
TEST(PassiveEffort, StopClosesTheEnergyBudget) {
  for (const double damping : {0.0, 0.5, 40.0}) {
    const Coordinate coordinate = with_stops();
    const StopPenalty penalty = penalty_with(damping);
    for (const double begin : kPositions)
      for (const double end : kPositions) {
        const CoordinateStep change = step_between(begin, end, 0.1);
        const PassiveEffort effort = passive_effort(coordinate, penalty, change);
        const double stored = stop_energy(coordinate, penalty, end) - stop_energy(coordinate, penalty, begin);
        const double scale = std::abs(effort.effort * change.increment) + stop_energy(coordinate, penalty, begin) + 1;
        EXPECT_NEAR(effort.effort * change.increment + stored + effort.dissipated, 0, 1e-14 * scale)
            << begin << " -> " << end;
        EXPECT_GE(effort.dissipated, -1e-15) << begin << " -> " << end;
        EXPECT_TRUE(damping > 0 || effort.dissipated == 0);
      }
  }
}

// A stop pushes out or not at all.
TEST(PassiveEffort, StopNeverPulls) {
  for (const double damping : {0.5, 40.0}) {
    const Coordinate coordinate = with_stops();
    const StopPenalty penalty = penalty_with(damping);
    for (const double begin : kPositions)
      for (const double end : kPositions) {
        if ((begin < 0) != (end < 0)) continue;  // from one stop to the other
        const double effort = passive_effort(coordinate, penalty, step_between(begin, end, 0.1)).effort;
        const double outward = begin < 0 ? effort : -effort;
        EXPECT_GE(outward, 0) << begin << " -> " << end;
      }
  }
}

TEST(PassiveEffort, SlopeOfTheStop) {
  for (const double damping : {0.0, 0.5, 40.0}) {
    const Coordinate coordinate = with_stops();
    const StopPenalty penalty = penalty_with(damping);
    for (const double begin : {-1.6, -1.2, -0.9, 0.5, 1.9, 2.3})
      for (const double end : {-1.61, -1.15, -0.95, 0.45, 1.92, 2.33}) {
        const CoordinateStep change = step_between(begin, end, 0.1);
        const double slope = passive_effort(coordinate, penalty, change).slope;
        // Round-off of differences of the quotient: epsilon / (increment * step).
        EXPECT_NEAR(slope, slope_by_difference(coordinate, penalty, change, 0.01), 1e-6 * (1 + std::abs(slope)))
            << begin << " -> " << end << " damping " << damping;
      }
  }
}

// Neither touch nor release makes the effort jump: a step that just touches has a solution.
TEST(PassiveEffort, StopIsContinuousAtTouchAndRelease) {
  const Coordinate coordinate = with_stops();
  const StopPenalty penalty = penalty_with(40);
  for (const double begin : {1.5, 1.99, 2.3}) {
    const double below = passive_effort(coordinate, penalty, step_between(begin, 2.0 - 1e-9, 0.1)).effort;
    const double above = passive_effort(coordinate, penalty, step_between(begin, 2.0 + 1e-9, 0.1)).effort;
    EXPECT_NEAR(below, above, 1e-5);  // slopes of 40 / 0.1 and 50 * 0.3 / 0.01 over 2e-9
  }
}

TEST(PassiveEffort, StopIsContinuousForVanishingIncrements) {
  const Coordinate coordinate = with_stops();
  const StopPenalty penalty = penalty_with(0);
  const double at_rest = passive_effort(coordinate, penalty, step_between(-1.2, -1.2, 0.1)).effort;
  EXPECT_NEAR(at_rest, 50 * 0.2, 1e-12);
  for (const double increment : {1e-15, 1e-13, 1e-12, 3e-12, 1e-9})
    EXPECT_NEAR(passive_effort(coordinate, penalty, step_between(-1.2, -1.2 + increment, 0.1)).effort, at_rest,
                50 * increment + 1e-12);
}

/// A unit mass with the mid-point rule: (2/h)(du/h - v) = Q.
struct Mass {
  double position, velocity;
  void advance(const Coordinate& coordinate, const StopPenalty& penalty, double h, double& dissipated) {
    double increment = h * velocity;
    PassiveEffort effort;
    for (int iteration = 0; iteration < 100; ++iteration) {
      effort = passive_effort(coordinate, penalty, step_between(position, position + increment, h));
      const double residual = 2 / h * (increment / h - velocity) - effort.effort;
      const double update = -residual / (2 / (h * h) - effort.slope);
      increment += update;
      if (std::abs(update) < 1e-16) break;
    }
    effort = passive_effort(coordinate, penalty, step_between(position, position + increment, h));
    dissipated += effort.dissipated;
    position += increment;
    velocity = 2 * increment / h - velocity;
  }
};

TEST(PassiveEffort, EnergyThroughAHit) {
  for (const double damping : {0.0, 4.0}) {
    const Coordinate coordinate = with_stops();
    const StopPenalty penalty = penalty_with(damping);
    Mass mass{1.5, 1.0};
    double dissipated = 0, deepest = 0;
    const double h = 0.02;
    for (int step = 0; step < 100; ++step) {
      mass.advance(coordinate, penalty, h, dissipated);
      deepest = std::max(deepest, mass.position);
      const double energy = 0.5 * mass.velocity * mass.velocity + stop_energy(coordinate, penalty, mass.position);
      EXPECT_NEAR(energy + dissipated, 0.5, 1e-12);
    }
    EXPECT_GT(deepest, 2.0);
    EXPECT_LT(mass.position, 2.0);
    EXPECT_NEAR(mass.velocity, -std::sqrt(1 - 2 * dissipated), 1e-12);
    EXPECT_EQ(dissipated > 0.01, damping > 0);
  }
}

// A contact lasts as long as asked for, and gives 30 % of the speed back.
TEST(StopPenalty, ContactTimeAndRestitution) {
  Coordinate coordinate = with_stops();
  coordinate.limit->inertia = 2;
  const auto [k, c] = stop_penalty(coordinate, 1e-2);
  const double omega = std::sqrt(k / 2);
  EXPECT_NEAR(omega, kPi / 1e-2, 1e-9 * omega);
  // m x'' = min(0, -k x - c x'), hit at unit speed: integrated finely until the force vanishes.
  double x = 0, v = 1;
  const double h = 1e-8;
  while (k * x + c * v > 0) {
    const double middle = v - 0.5 * h * (k * x + c * v) / 2;
    v -= h * (k * (x + 0.5 * h * v) + c * middle) / 2;
    x += h * middle;
  }
  EXPECT_NEAR(-v, 0.3, 1e-3);
  EXPECT_EQ(stop_penalty(Coordinate(), 1e-2).stiffness, 0);
}

TEST(StopEnergy, VanishesInside) {
  const Coordinate coordinate = with_stops();
  const StopPenalty penalty = penalty_with(0);
  for (const double position : {-1.0, 0.0, 2.0}) EXPECT_EQ(stop_energy(coordinate, penalty, position), 0);
  EXPECT_NEAR(stop_energy(coordinate, penalty, -1.5), 0.5 * 50 * 0.25, 1e-13);
  EXPECT_NEAR(stop_energy(coordinate, penalty, 2.5), 0.5 * 50 * 0.25, 1e-13);
  EXPECT_EQ(stop_energy(Coordinate(), penalty, 100), 0);
}

}  // namespace
}  // namespace flexarm
