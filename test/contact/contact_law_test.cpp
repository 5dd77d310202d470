// Tests the laws of contact at a point (push and grip): slopes against differences, energies, and restitution.
#include "contact/contact_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "joints/penetration.h"
namespace flexarm::test {
namespace {

ContactLaw law_with(double restitution, double depth = std::numeric_limits<double>::infinity()) {
  ContactLaw law;
  law.stiffness = 7;
  law.frequency = 2;
  law.restitution = Restitution(restitution);
  law.depth = depth;
  return law;
}
/// A law whose restitution falls with the speed from 0.2 m/s to 1.6 m/s.
ContactLaw falling_law(double depth = std::numeric_limits<double>::infinity()) {
  ContactLaw law = law_with(1, depth);
  law.restitution = Restitution({0.9, 0.5, 0.4}, {0.2, 0.8, 1.6});
  return law;
}

struct Case {
  ContactLaw law;
  ContactChange change;
};
std::vector<Case> random_cases() {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> place(-0.6, 0.6), speed(0, 1), part(0.05, 1);
  std::vector<Case> out;
  for (int i = 0; i < 3000; ++i) {
    const double depth = i % 2 == 0 ? 0.7 : std::numeric_limits<double>::infinity();
    const ContactLaw law = i % 7 == 0 ? falling_law(depth) : law_with(i % 5 == 0 ? 1.0 : part(generator), depth);
    out.push_back({law, {place(generator), place(generator), 0.3, speed(generator)}});
  }
  return out;
}

TEST(ContactPush, HasItsSlope) {
  for (const auto& [law, change] : random_cases()) {
    // These cases are near a kink of the law, or lose digits.
    if (std::abs(change.end) < 1e-5 || std::abs(change.end - change.begin) < 1e-4) continue;
    ContactChange more = change, less = change;
    more.end += 1e-6;
    less.end -= 1e-6;
    const double difference = (contact_push(law, more).value - contact_push(law, less).value) / 2e-6;
    const double slope = contact_push(law, change).slope;
    // If the push ends within the difference, it has a kink there, too.
    if (contact_push(law, more).value == 0 || contact_push(law, less).value == 0) continue;
    EXPECT_NEAR(slope, difference, 1e-6 * (std::abs(slope) + 100));
  }
}

TEST(ContactPush, DoesTheWorkOfItsEnergyAndDissipates) {
  for (const auto& [law, change] : random_cases()) {
    const ContactPush push = contact_push(law, change);
    const double stored = contact_energy(law, change.end) - contact_energy(law, change.begin);
    const double size = contact_energy(law, change.end) + contact_energy(law, change.begin);
    EXPECT_GE(push.value, 0);
    EXPECT_GE(push.dissipated, -1e-15 * size);
    if (law.restitution.of_slow_hits() == 1) {
      EXPECT_EQ(push.dissipated, 0);
    }
    EXPECT_NEAR(push.value * (change.end - change.begin), stored + push.dissipated, 1e-13 * (size + push.dissipated));
  }
}

TEST(ContactPush, IsTheDerivativeOfTheEnergyAtRest) {
  for (const double depth : {0.7, std::numeric_limits<double>::infinity()})
    for (const double p : {-0.1, 0.05, 0.3, 0.6}) {
      const ContactLaw law = law_with(0.5, depth);
      const auto push = [&](double at) { return contact_push(law, {0, at, 0}); };
      const double h = 1e-6;
      EXPECT_NEAR(push(p).value, (contact_energy(law, p + h) - contact_energy(law, p - h)) / (2 * h),
                  1e-7 * (1 + push(p).value));
      EXPECT_NEAR(push(p).slope, (push(p + h).value - push(p - h).value) / (2 * h), 1e-7 * (1 + push(p).slope));
    }
}

// The mean over a short step equals the push at an instant within it, with an error of second order in the length.
TEST(ContactPush, AtAnInstantIsTheMeanOfAShortStep) {
  for (const double depth : {0.7, std::numeric_limits<double>::infinity()})
    for (const double rate : {-0.05, 0.2})
      for (const double speed : {0.0, 0.4}) {
        const double p = 0.3, h = 1e-4;
        const ContactChange change{p - 0.5 * h * rate, p + 0.5 * h * rate, h, speed};
        for (const ContactLaw& law : {law_with(0.5, depth), falling_law(depth)}) {
          const double mean = contact_push(law, change).value;
          EXPECT_NEAR(push_at(law, p, rate, speed), mean, 1e-8 * mean);
        }
      }
  EXPECT_EQ(push_at(law_with(0.5), -0.1, 1, 1), 0);
  EXPECT_EQ(push_at(law_with(0.5), 0.1, -10, 1), 0) << "it never pulls";
}

/// Speed after a hit over the speed before it. The steps of the midpoint rule are a hundredth of the oscillator's
/// radian, so that their error is below 1e-4.
double restitution_of(const ContactLaw& law, double mass, double speed) {
  const double step = 0.01 / std::sqrt(law.stiffness / mass);
  double p = 0, v = speed, remembered = 0;
  do {
    ContactChange change{p, p, step};
    change.speed = approach_speed(p, v, remembered);
    double low = p - speed * step, high = p + v * step;
    const auto balance = [&](double end) {
      change.end = end;
      return 2 * mass * (end - p - v * step) / (step * step) + contact_push(law, change).value;
    };
    while (balance(low) > 0) low -= speed * step;
    for (int i = 0; i < 80; ++i) {
      const double middle = 0.5 * (low + high);
      (balance(middle) > 0 ? high : low) = middle;
    }
    change.end = low;
    remembered = remembered_speed(change, v);
    v = 2 * (low - p) / step - v;
    p = low;
  } while (p > 0);
  return -v / speed;
}

// The restitution is independent of mass, speed and depth. The error of half a per cent is from the steps at both ends
// of the hit.
TEST(ContactPush, GivesBackWhatItsRestitutionSays) {
  for (const double e : {0.1, 0.3, 0.5, 0.8, 1.0})
    for (const double mass : {1.0, 7.0 / 4, 5.0})
      for (const double speed : {0.01, 1.0})
        EXPECT_NEAR(restitution_of(law_with(e, speed == 1.0 ? 2.0 : 0.02), mass, speed), e, 0.005) << mass << speed;
}

TEST(ContactPush, GivesBackWhatItsRestitutionSaysAtEachSpeed) {
  for (const double mass : {1.0, 7.0 / 4})
    for (const auto& [speed, e] : {std::pair{0.01, 0.9}, {0.2, 0.9}, {0.5, 0.7}, {0.8, 0.5}, {1.2, 0.45}, {3.0, 0.4}})
      EXPECT_NEAR(restitution_of(falling_law(9), mass, speed), e, 0.005) << mass << ' ' << speed;
}

TEST(Restitution, IsLinearBetweenItsSpeedsAndConstantBeyond) {
  const Restitution falling({0.9, 0.5, 0.4}, {0.2, 0.8, 1.6});
  for (const auto& [speed, e] :
       {std::pair{0.0, 0.9}, {0.2, 0.9}, {0.35, 0.8}, {0.8, 0.5}, {1.2, 0.45}, {1.6, 0.4}, {7.0, 0.4}}) {
    EXPECT_NEAR(falling.at(speed), e, 1e-15);
    EXPECT_NEAR(falling.damping_at(speed), damping_for_restitution(e), 1e-14) << speed;
  }
  EXPECT_EQ(falling.of_slow_hits(), 0.9);
  EXPECT_EQ(falling.of_fast_hits(), 0.4);
  EXPECT_EQ(Restitution(0.3).at(5), 0.3);
  EXPECT_EQ(Restitution().damping_at(1), 0) << "elastic";
}

// If a point reverses and penetrates again before it has left, the law uses the speed of the new approach instead of
// the first one.
TEST(ContactPush, WhatTurnsRoundOnItsWayBackIsANewHit) {
  ContactChange turning{1e-3, 1.2e-3, 0.01};  // -0.1 m/s at the beginning, 0.14 m/s at the end
  turning.speed = approach_speed(turning.begin, -0.1, -2.0);
  EXPECT_EQ(turning.speed, 2.0);
  EXPECT_EQ(approach_speed(turning.end, 0.14, remembered_speed(turning, -0.1)), 0.14);
}

// A step from the touch to beyond the turning point is too long. A step of a twentieth of a turn is short enough. So is
// any step of a point at rest, and any step of a linear elastic contact. (docs/notes/contact.md 2)
TEST(ContactPush, HitsAreCoarseInLongSteps) {
  const ContactLaw law = law_with(0.5), elastic = law_with(1);
  const double radian = 1 / law.frequency, speed = 0.3;
  EXPECT_TRUE(is_coarse_hit(law, {0, 0.1, 2 * radian}, speed, 1));
  EXPECT_FALSE(is_coarse_hit(law, {0, 0.3 * radian * speed, 0.3 * radian}, speed, 1));
  EXPECT_TRUE(is_coarse_hit(law, {0, 0.3 * radian * speed, 0.3 * radian}, speed, 2)) << "with a refinement";
  EXPECT_FALSE(is_coarse_hit(law, {0.1, 0.1, 50 * radian}, 0, 1)) << "it rests";
  EXPECT_FALSE(is_coarse_hit(law, {-0.2, -0.1, 2 * radian}, speed, 1)) << "it does not touch";
  EXPECT_FALSE(is_coarse_hit(elastic, {0, 0.1, 2 * radian}, speed, 1));
  EXPECT_TRUE(is_coarse_hit(law_with(1, 0.3), {0, 0.1, 2 * radian}, speed, 1)) << "an elastic one that hardens";
  // A point at rest that is pressed in covers all of its motion in any step. It counts as a hit if it is fast.
  ContactLaw slow = law;
  slow.most_start = 0.1;
  EXPECT_FALSE(is_coarse_hit(slow, {0, 1e-5, 2 * radian}, 0, 1));
  EXPECT_TRUE(is_coarse_hit(slow, {0, 1e-2, 2 * radian}, 0, 1));
}

TEST(ContactPush, HasTheDampingOfItsClosedForm) {
  for (const double e : {0.05, 0.3, 0.5, 0.8, 0.95}) {
    const double d = damping_for_restitution(e);
    // 1 - e d has the round-off of 1, so its logarithm has this round-off over 1 - e d.
    EXPECT_NEAR(std::log((1 + d) / (1 - e * d)), d * (1 + e), 1e-14 + 1e-15 / (1 - e * d)) << e;
    EXPECT_GT(d, 0.5 * (1 - e)) << "0 is a solution, too";
  }
  EXPECT_EQ(damping_for_restitution(1), 0);
  EXPECT_EQ(damping_for_restitution(0), damping_for_restitution(0.05)) << "the most damped hit";
}

Vector3 random_vector(std::mt19937& generator, double size) {
  std::uniform_real_distribution<double> number(-size, size);
  return {number(generator), number(generator), number(generator)};
}

TEST(GripRoot, HardensInHitsAsTheNormalForceDoes) {
  ContactLaw law;
  law.stiffness = 500;
  law.frequency = 20;
  law.depth = 0.01;
  const double fast = 10, step = 1e-5;
  for (const double penetration : {0.001, 0.004, 0.006}) {
    const double root = grip_root(law, penetration, fast, step).value;
    EXPECT_NEAR(root * root, contact_push(law, {0, penetration, 0}).slope / law.stiffness, 1e-12 * root * root);
    const double x = hardened({penetration, law.depth}).value;
    EXPECT_EQ(grip_root(law, penetration, 0.5 * law.frequency * x, step).value, 1) << "pressed";
    for (const double speed : {fast, 0.8 * law.frequency * x}) {
      constexpr double h = 1e-8;
      const double slope =
          (grip_root(law, penetration + h, speed, step).value - grip_root(law, penetration - h, speed, step).value) /
          (2 * h);
      EXPECT_NEAR(grip_root(law, penetration, speed, step).slope, slope, 1e-6 * std::abs(slope));
    }
  }
  EXPECT_EQ(grip_root(law, -0.001, fast, step).value, 1);
  // What sticks turns by no more than the best angle in a step.
  const GripRoot deep = grip_root(law, 0.009, 1e3, 0.01);
  EXPECT_NEAR(deep.value * law.frequency * 0.01, 4, 1e-14);
  EXPECT_EQ(deep.slope, 0);
  law.depth = std::numeric_limits<double>::infinity();
  EXPECT_EQ(grip_root(law, 1, fast, step).value, 1);
}

TEST(ContactGrip, HasItsSlopesAndDissipates) {
  std::mt19937 generator(5);
  ContactLaw law;
  law.friction = 0.4;
  law.grip = 30;
  int sliding = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3 stretch = random_vector(generator, 0.01), slip = random_vector(generator, 0.02);
    const Vector3 normal = random_vector(generator, 1).normalized();
    const double push = 1.5 * (1 + i % 2), root = 1 + 0.2 * (i % 5);
    const ContactGrip here = contact_grip(law, stretch, slip, normal, push, root);
    const auto at = [&](const Vector3& ds, const Vector3& dn, double dp) {
      return contact_grip(law, stretch, slip + ds, normal + dn, push + dp, root).pull;
    };
    const auto pull_at = [&](double r) { return contact_grip(law, stretch, slip, normal, push, r).pull; };
    const double h = 1e-7;
    EXPECT_LE(((pull_at(root + h) - pull_at(root - h)) / (2 * h) - here.by_root).norm(), 1e-6);
    for (int k = 0; k < 3; ++k) {
      const Vector3 by = h * Vector3::Unit(k);
      const Vector3 zero = Vector3::Zero();
      EXPECT_LE(((at(by, zero, 0) - at(-by, zero, 0)) / (2 * h) - here.by_slip.col(k)).norm(), 1e-6);
      EXPECT_LE(((at(zero, by, 0) - at(zero, -by, 0)) / (2 * h) - here.by_normal.col(k)).norm(), 1e-6);
    }
    EXPECT_LE(
        ((at(Vector3::Zero(), Vector3::Zero(), h) - at(Vector3::Zero(), Vector3::Zero(), -h)) / (2 * h) - here.by_push)
            .norm(),
        1e-6);
    EXPECT_LE((here.pull - root * here.stretch).norm(), 1e-16);
    const double size = law.grip * here.pull.norm(), most = law.friction * push;
    EXPECT_LE(size, most * (1 + 1e-14));
    EXPECT_NEAR(here.stretch.dot(normal), 0, 1e-16);
    sliding += size > most * (1 - 1e-14);
    const double dissipated =
        law.grip * (here.pull.dot(slip) - 0.5 * (here.stretch - stretch).dot(here.stretch + stretch));
    EXPECT_GE(dissipated, -1e-16);
  }
  EXPECT_GT(sliding, 30);
  EXPECT_LT(sliding, 270);
}

}  // namespace
}  // namespace flexarm::test
