// Tests hits of bodies against closed forms: what they give back, along the surface and across it.
#include "math/pi.h"
#include "reference/contact_scenes.h"

namespace flexarm::test::touching {
namespace {

TEST(Contact, ElasticBallKeepsItsEnergyOverAHundredBounces) {
  Simulation simulation = simulation_of(
      ball("ball", 2, 0.1) + floating("ball") + kFloor + contact_of("ball", "floor", "restitution='1' stiffness='1e5'"),
      start("ball", {0, 0, 0.3}, {0.1, 0, 0}), 2e-3);
  const double begin = simulation.energies().total();
  int bounces = 0;
  double last = 0;
  while (bounces < 100 && simulation.time() < 60) {
    ASSERT_TRUE(simulation.step().converged);
    const double rate = simulation.momentum().z();
    bounces += last < 0 && rate >= 0;
    last = rate;
  }
  EXPECT_EQ(bounces, 100);
  EXPECT_NEAR(simulation.energies().total(), begin, 1e-10 * begin);
  EXPECT_NEAR(simulation.energies().dissipated, 0, 1e-12 * begin);
  EXPECT_NEAR(simulation.momentum().x(), 0.2, 1e-10);
}

/// Ratio of the speeds after and before the first hit of a weightless ball.
double restitution_seen(double asked, double step, double speed) {
  Simulation simulation =
      simulation_of(ball("ball", 2, 0.1) + floating("ball") + kFloor +
                        contact_of("ball", "floor", fmt::format("restitution='{}'", asked)),
                    start("ball", {0, 0, 0.1 + 0.3 * speed * step + 1e-4}, {0, 0, -speed}), step, {0, 0, 0});
  while (simulation.momentum().z() <= 0 || simulation.link_pose(1).position.z() < 0.1)
    if (!simulation.step().converged || simulation.time() > 400 * step) return -1;
  return simulation.momentum().z() / 2 / speed;
}

// The error is 1 %, of steps of a ninth of half a turn of the oscillation, and of halved longer steps
// (docs/notes/contact.md 2).
TEST(Contact, HitsGiveBackWhatTheyAreAskedFor) {
  for (const double e : {0.3, 0.5, 0.8, 1.0})
    for (const double step : {1e-3, 1e-2})
      for (const double speed : {0.01, 1.0, 10.0})
        EXPECT_NEAR(restitution_seen(e, step, speed), e, 0.01) << step << speed;
}

// Friction grips harder as the contact hardens, so that it reaches Coulomb's force also in hard hits.
TEST(Contact, SlidingHitsHaveCoulombsImpulse) {
  constexpr double kFriction = 0.3;
  for (const double radius : {0.01, 0.1})
    for (const double speed : {0.1, 3.0, 30.0})
      for (const double e : {0.3, 0.8}) {
        const double along = 8 * kFriction * (1 + e) * speed;  // a hit takes less than half of the slip
        Simulation simulation =
            simulation_of(ball("ball", 2, radius) + floating("ball") + kFloor +
                              contact_of("ball", "floor", fmt::format("restitution='{}' friction='{}'", e, kFriction)),
                          start("ball", {0, 0, 1.01 * radius}, {along, 0, -speed}), 1e-3, {0, 0, 0});
        while (simulation.momentum().z() <= 0 || simulation.link_pose(1).position.z() < radius)
          ASSERT_TRUE(simulation.step().converged && simulation.time() < 0.5) << radius << " " << speed;
        const Vector3 velocity = simulation.momentum() / 2;
        EXPECT_NEAR((along - velocity.x()) / (kFriction * (velocity.z() + speed)), 1, 0.01)
            << radius << " m, " << speed << " m/s, restitution " << e;
      }
}

// While a hit sticks, its slip swings as cos(w t), w^2 = grip k (1 / m + r^2 / J), for the time pi sqrt(m / k). Forces
// at the end of a step damp it with a ratio of w h / 4; the hardening changes the phase by less.
TEST(Contact, HitsThatStickReboundByTheGrip) {
  constexpr double kSpeed = 0.05, kStep = 1e-6, kTime = 1e-3;
  for (const double grip : {0.5, 1.0, 4.0}) {
    Simulation simulation = simulation_of(
        ball("ball", 1, 0.05) + floating("ball") + kFloor +
            contact_of("ball", "floor",
                       fmt::format("restitution='1' friction='2' contact_time='{}' grip='{}'", kTime, grip)),
        start("ball", {0, 0, 0.05 + 1e-6}, {kSpeed, 0, -0.3}), kStep, {0, 0, 0});
    while (simulation.momentum().z() <= 0 || simulation.link_pose(1).position.z() < 0.05)
      ASSERT_TRUE(simulation.step().converged && simulation.time() < 3 * kTime);
    const double rate = kPi / kTime * std::sqrt(3.5 * grip), phase = rate * kTime;
    const double expected = kSpeed * (1 - (1 - std::cos(phase)) / 3.5);
    EXPECT_NEAR(simulation.momentum().x(), expected, kSpeed / 3.5 * (rate * kStep / 4 * phase + 0.01 * phase)) << grip;
  }
}

/// Times between the hits of a ball, of which each begins with the speed v of the last one times e(v): recursion.
std::vector<double> flights(double speed, double gravity, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    out.push_back(2 * speed / gravity);
    speed *= 0.95 - 0.1 * speed;
  }
  return out;
}

// A restitution that falls with the speed, as of balls that yield: from 0.75 at 2 m/s to 0.88 at the last hit. A flight
// is longer by a hit of ten steps, a part of which is below the height at which it begins. The error of the restitution
// is 1 % as above; it adds up over the hits.
TEST(Contact, FastHitsGiveBackLess) {
  constexpr double kStep = 1e-4, kGravity = 9.81, kBegin = 2;
  constexpr int kHits = 6;
  Simulation simulation =
      simulation_of(ball("ball", 2, 0.1) + floating("ball") + kFloor +
                        contact_of("ball", "floor", "restitution='0.95 0.65' speeds='0 3' contact_time='1e-3'"),
                    start("ball", {0, 0, 0.1 + 1e-9}, {0, 0, kBegin}), kStep, {0, 0, -kGravity});
  const double begin = simulation.energies().total();
  const std::vector<double> expected = flights(kBegin, kGravity, kHits);
  double last_hit = 0, rate = kBegin;
  for (int hit = 0; hit < kHits;) {
    ASSERT_TRUE(simulation.step().converged);
    ASSERT_LT(simulation.time(), 3);
    const double now = simulation.momentum().z() / 2;
    if (rate < 0 && now >= 0) {
      EXPECT_NEAR(simulation.time() - last_hit, expected[hit], 10 * kStep + 0.01 * hit * expected[hit]) << hit;
      last_hit = simulation.time();
      ++hit;
    }
    rate = now;
  }
  EXPECT_NEAR(simulation.energies().total() + simulation.energies().dissipated, begin, 1e-9) << "the account closes";
}

TEST(Contact, NothingGoesThroughAThinWall) {
  for (const double speed : {1.0, 30.0, 100.0}) {
    Simulation simulation =
        simulation_of(ball("ball", 1, 0.02) + floating("ball") + fixed("wall", "<box size='0.001 1 1'/>") +
                          contact_of("ball", "wall", "restitution='0.5'"),
                      start("ball", {-0.1, 0.01, 0.02}, {speed, 0, 0}), 1e-3, {0, 0, 0});
    run_until(simulation, 0.1 + 0.2 / speed);
    EXPECT_LT(simulation.link_pose(1).position.x(), -0.02) << speed;
    EXPECT_NEAR(simulation.momentum().x(), -0.5 * speed, 0.01 * speed);
    // Positions of 0.1 m have round-off. Over the shortest steps of 1e-3 / 2^22 s this is a velocity error of 6e-8 m/s.
    EXPECT_NEAR(energy_account(simulation), 0.5 * speed * speed, 1e-7 * speed * speed);
  }
}

// Two balls and a weightless box hit each other many times. Energy and momenta are conserved.
TEST(Contact, HitsOfFreeBodiesKeepEnergyAndMomenta) {
  Simulation simulation =
      simulation_of(ball("one", 1, 0.1) + ball("two", 2, 0.15) + box("box", 1.5, {0.3, 0.2, 0.25}) + floating("one") +
                        floating("two") + floating("box") + contact_of("*", "*", "restitution='1' stiffness='2e4'"),
                    start("one", {-0.5, 0.03, 0.02}, {1, 0, 0}) + start("two", {0.5, 0, 0}, {-1, 0.05, 0}) +
                        start("box", {0, 0.02, 0}, {0, 0, 0}),
                    2e-3, {0, 0, 0});
  const double energy = simulation.energies().total();
  const Vector3 momentum = simulation.momentum(), angular = simulation.angular_momentum();
  const Vector3 box_at_start = simulation.link_pose(3).position;
  run_until(simulation, 1.5);
  EXPECT_GT((simulation.link_pose(3).position - box_at_start).norm(), 0.01) << "nothing was hit";
  EXPECT_NEAR(simulation.energies().total(), energy, 1e-10 * energy);
  EXPECT_LE((simulation.momentum() - momentum).norm(), 1e-11);
  EXPECT_LE((simulation.angular_momentum() - angular).norm(), 1e-11);
}

// The hits follow each other ever faster and end at the time 2 v e / (g (1 - e)). After this the ball is at rest.
TEST(Contact, BouncesComeToAnEnd) {
  Simulation simulation =
      simulation_of(ball("ball", 2, 0.1) + floating("ball") + kFloor + contact_of("ball", "floor", "restitution='0.5'"),
                    start("ball", {0, 0, 0.1}, {0, 0, 2}), 1e-3);
  const double fall = 2 * 2 / kG, end = fall + fall * 0.5 / (1 - 0.5);
  run_until(simulation, end + 0.1);
  EXPECT_NEAR(simulation.momentum().z(), 0, 1e-6);
  EXPECT_NEAR(simulation.link_pose(1).position.z(), 0.1, 2e-4);  // sinks by its weight over the stiffness
  EXPECT_NEAR(energy_account(simulation), 0.5 * 2 * 4 + 2 * kG * 0.1, 1e-9);
}

}  // namespace
}  // namespace flexarm::test::touching
