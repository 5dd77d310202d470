// Tests contacts with the smooth lines of beams: with balls, other beams, and the beam itself, against closed forms.
#include <algorithm>

#include "math/pi.h"
#include "reference/contact_scenes.h"

namespace flexarm::test::touching {
namespace {

struct Rod {
  Vector3 to;
  double radius = 0.01, young = 7e10, density = 2700;
  int elements = 4, order = 2;
};
std::string line_of(const std::string& name, const Rod& rod) {
  return round_beam(name, "<line to='" + xyz(rod.to) + "'/>", rod.radius,
                    fmt::format("<material young='{:.17g}' poisson='0.3' density='{:.17g}'/>", rod.young, rod.density),
                    rod.elements, rod.order);
}
double bending_stiffness(const Rod& rod) {
  return rod.young * 0.25 * kPi * std::pow(rod.radius, 4);
}

std::string clamped(const std::string& link, const Vector3& place = {0, 0, 0}) {
  return joint("of_" + link, "fixed", "world", link, "<origin xyz='" + xyz(place) + "'/>");
}
/// A slider that carries a link up and down at a place along x.
std::string upright(const std::string& link, double x) {
  return joint("of_" + link, "prismatic", "world", link,
               fmt::format("<origin xyz='{} 0 0'/><axis xyz='0 0 1'/>", x) + kFarLimits);
}

Simulation weightless(const std::string& parts, const std::string& starts, double step) {
  return simulation_of(parts, starts, step, {0, 0, 0});
}

/// Smallest distance between points on two links' lines, in steps of 1/100 of their lengths. On one link, only points
/// count that are farther apart along it than `apart` [m].
double nearest_of(const Simulation& simulation, const std::pair<std::size_t, double>& first,
                  const std::pair<std::size_t, double>& second, double apart = 0) {
  constexpr int kPlaces = 100;
  double nearest = 1e9;
  std::vector<Vector3> places[2];
  for (int i = 0; i <= kPlaces; ++i) {
    places[0].push_back(simulation.section(first.first, first.second * i / kPlaces).pose.position);
    places[1].push_back(simulation.section(second.first, second.second * i / kPlaces).pose.position);
  }
  for (int i = 0; i <= kPlaces; ++i)
    for (int j = 0; j <= kPlaces; ++j)
      if (std::abs(i - j) * first.second >= apart * kPlaces)
        nearest = std::min(nearest, (places[0][i] - places[1][j]).norm());
  return nearest;
}
double distance_of(const Simulation& simulation, const Vector3& point, std::size_t link, double length) {
  double nearest = 1e9;
  for (int i = 0; i <= 2000; ++i)
    nearest = std::min(nearest, (simulation.section(link, length * i / 2000).pose.position - point).norm());
  return nearest;
}

// ---------------------------------------------------------------- balls

/// A ball that is smaller than the distance of the beam's stations, half-way between two stations.
Simulation ball_over_a_thin_beam(double restitution) {
  return simulation_of(line_of("wire", {{1, 0, 0}, 0.003, 7e10, 2700, 4, 2}) + clamped("wire") +
                           ball("ball", 0.002, 0.004) + floating("ball") +
                           contact_of("ball", "wire", fmt::format("restitution='{}' stiffness='2000'", restitution)),
                       start("ball", {0.140625, 0, 0.02}, {0, 0, -0.5}), 5e-4);
}

TEST(LineContact, BallBouncesOnAThinBeamBetweenItsStations) {
  Simulation simulation = ball_over_a_thin_beam(1);
  const double begin = simulation.energies().total();
  int bounces = 0;
  double last = 0;
  while (bounces < 30 && simulation.time() < 3) {
    ASSERT_TRUE(steps(simulation));
    const double distance = distance_of(simulation, simulation.link_pose(2).position, 1, 1);
    ASSERT_GT(distance, 0.9 * 0.003 + 0.004) << simulation.time();
    bounces += last >= 0.007 && distance < 0.007;
    last = distance;
    ASSERT_NEAR(simulation.energies().total(), begin, 1e-10 * 0.5);
  }
  EXPECT_EQ(bounces, 30);
}

TEST(LineContact, NothingGoesThroughAThinBeam) {
  for (const double speed : {1.0, 100.0}) {
    Simulation simulation =
        weightless(line_of("wire", {{1, 0, 0}, 0.002, 2e11, 7800, 4, 2}) + clamped("wire") + ball("ball", 1e-3, 0.002) +
                       floating("ball") + contact_of("ball", "wire", "restitution='0.5'"),
                   start("ball", {0.53, 0, 0.03}, {0, 0, -speed}), 1e-3);
    const double begin = energy_account(simulation);
    run_until(simulation, 0.06 + 0.06 / speed);
    const double height = simulation.link_pose(2).position.z();
    EXPECT_GT(height, simulation.section(1, 0.53).pose.position.z() + 0.0035) << speed;
    EXPECT_NEAR(energy_account(simulation), begin, 1e-6 * begin) << speed;
  }
}

// Elements of 0.25 m have stations every 31 mm. A box of 10 mm would fall between them.
TEST(LineContact, SmallBoxLiesOnAThinBeamBetweenItsStations) {
  Simulation simulation = simulation_of(line_of("wire", {{1, 0, 0}, 0.003, 2e11, 7800, 4, 2}) + clamped("wire") +
                                            box("box", 0.01, Vector3::Constant(0.01)) + upright("box", 0.140625) +
                                            contact_of("box", "wire"),
                                        "<initial joint='of_box' position='0.012'/>", 1e-3);
  run_until(simulation, 0.5);
  const double height = simulation.link_pose(2).position.z() - simulation.section(1, 0.140625).pose.position.z();
  EXPECT_LT(height, 0.0081) << "it has fallen";
  EXPECT_GT(height, 0.008 - 0.1 * 0.003) << "as far as it gives way at most";
}

// A carriage with a ball is lowered onto a cantilever. The deflection at the ball is m g a^3 / (3 E I).
TEST(LineContact, BallRestsOnABeam) {
  const Rod beam{{1, 0, 0}, 0.01, 7e10, 1e-3, 5, 3};
  const double mass = 0.2, at = 0.63, radius = 0.02, stiffness = 1e4;
  Simulation simulation =
      simulation_of(line_of("beam", beam) + clamped("beam") + ball("ball", mass, radius) + upright("ball", at) +
                        contact_of("ball", "beam", fmt::format("stiffness='{}'", stiffness)),
                    fmt::format("<initial joint='of_ball' position='{}'/>", radius + beam.radius - 1e-6), 1e-3);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  const double deflection = mass * kG * std::pow(at, 3) / (3 * bending_stiffness(beam));
  const double penetration = mass * kG / stiffness;  // the contact hardens by 2 (p / d)^2, which is 0.08 here
  const double height = simulation.link_pose(2).position.z();
  const double slope = mass * kG * at * at / (2 * bending_stiffness(beam));
  // Shear, the position of the ball relative to the section below it, and the slope have relative effects of (radius /
  // length)^2 and slope^2.
  EXPECT_NEAR(height, radius + beam.radius - deflection, deflection * (4e-3 + slope * slope) + penetration);
  EXPECT_NEAR(simulation.section(1, at).pose.position.z(), -deflection, 4e-3 * deflection);
  const double approach = height - simulation.section(1, at).pose.position.z();
  EXPECT_LT(approach, radius + beam.radius);
  EXPECT_GT(approach, radius + beam.radius - penetration - 1e-5);
  // Small vibrations: the ball on the contact's stiffness in series with that of the beam, whose mass is negligible. A
  // penetration of s times the depth d counts as s d / (1 - s^2)^2 for the spring.
  const double depth = 0.1 * beam.radius;
  double low = 0, high = 0.9;
  for (int i = 0; i < 60; ++i) {
    const double s = 0.5 * (low + high), a = 1 - s * s;
    (stiffness * depth * s * (1 + 3 * s * s) / std::pow(a, 5) < mass * kG ? low : high) = s;
  }
  const double s2 = low * low;
  const double hardened = (std::pow(1 + 3 * s2, 2) + 12 * s2 * (1 + s2)) / std::pow(1 - s2, 6);
  const double soft = 1 / (1 / (stiffness * hardened) + std::pow(at, 3) / (3 * bending_stiffness(beam)));
  EXPECT_NEAR(simulation.natural_modes(1)[0].frequency, std::sqrt(soft / mass) / (2 * kPi), 0.01);
}

// Timoshenko's problem, against modes of Euler and Bernoulli and a spring. test/elements/scripts/reference_impact.py
// gives 0.09797, 0.09813, 0.09817 m/s with 8, 12, 16 modes, and -2.337e-4 m. Shear and rotary inertia have relative
// effects of (radius times wave number)^2: 0.5 % in the 12th mode.
TEST(LineContact, BallHitsABeamFromTheSide) {
  Simulation simulation =
      weightless(line_of("beam", {{1, 0, 0}, 0.005, 2e11, 7800, 8, 3}) + clamped("beam") + ball("ball", 0.05, 0.02) +
                     floating("ball") + contact_of("ball", "beam", "restitution='1' stiffness='1e5'"),
                 start("ball", {0.5, 0, 0.0251}, {0, 0, -0.2}), 2e-5);
  run_until(simulation, 0.01);
  const double begin = simulation.link_pose(2).position.z();
  EXPECT_NEAR(simulation.section(1, 0.5).pose.position.z(), -2.337e-4, 0.01 * 2.337e-4);
  run_until(simulation, 0.012);
  EXPECT_NEAR((simulation.link_pose(2).position.z() - begin) / 0.002, 0.0982, 0.01 * 0.0982);
}

// ---------------------------------------------------------------- two beams

/// Springs pull two beams together, which hit each other again and again. There are no other forces.
void expect_conserved_hits(const std::string& second, const std::string& springs, const std::string& second_start) {
  const Rod along{{0.6, 0, 0}, 0.01, 2e9, 1500, 3, 2};
  Simulation simulation = weightless(line_of("one", along) + second + floating("one") + floating("two") + springs +
                                         contact_of("one", "two", "restitution='1' stiffness='1e5'"),
                                     second_start, 1e-3);
  simulation.set_tolerance(1e-10);
  const double energy = simulation.energies().total();
  const Vector3 momentum = simulation.momentum(), angular = simulation.angular_momentum();
  const auto height = [&](std::size_t link) {
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += 0.25 * simulation.section(link, 0.59 * (i + 0.5) / 4).pose.position.z();
    return sum;
  };
  int hits = 0;
  double last = height(2) - height(1), before = last;
  while (hits < 100 && simulation.time() < 20) {
    ASSERT_TRUE(steps(simulation));
    const double gap = height(2) - height(1);
    hits += last < before && last < gap;
    before = last;
    last = gap;
  }
  EXPECT_EQ(hits, 100);
  // The error of Newton's method is at most 1e-12 J per hit. A step is exact to round-off; see test/contact.
  EXPECT_NEAR(simulation.energies().total(), energy, 1e-10);
  EXPECT_LE((simulation.momentum() - momentum).norm(), 1e-10);
  EXPECT_LE((simulation.angular_momentum() - angular).norm(), 1e-10);
}

std::string spring(const std::string& from, const std::string& to, double stiffness, double rest) {
  return fmt::format("<spring from='one' from_at='{}' to='two' to_at='{}' stiffness='{}' rest_length='{}'/>", from, to,
                     stiffness, rest);
}

TEST(LineContact, BeamsThatHitEachOtherCrosswiseKeepEnergyAndMomenta) {
  std::string springs;
  for (const char* one : {"0 0 0", "0.6 0 0"})
    for (const char* two : {"0 0 0", "0.2 0.56 0"}) springs += spring(one, two, 300, 0.3);
  expect_conserved_hits(line_of("two", {{0.2, 0.56, 0}, 0.01, 2e9, 1500, 3, 2}), springs,
                        start("two", {0.2, -0.28, 0.0205}, {0.002, 0.001, -0.05}));
}

TEST(LineContact, BeamsThatHitEachOtherAlongsideKeepEnergyAndMomenta) {
  std::string springs;
  for (const char* at : {"0", "0.6"})
    for (const double side : {-0.05, 0.05})
      springs += spring(fmt::format("{} {} 0", at, side), fmt::format("{} {} 0", at, -side), 150, 0.08);
  expect_conserved_hits(line_of("two", {{0.6, 0, 0}, 0.01, 2e9, 1500, 3, 2}), springs,
                        start("two", {0, 0, 0.0205}, {0.002, 0.001, -0.05}));
}

// Stiff rods hit each other at their middles, at two angles. The effect of their bending is the squared ratio of the
// contact's frequency to theirs, 314 to 14000 rad/s.
TEST(LineContact, CrossedRodsGiveBackWhatTheyAreAskedFor) {
  for (const double e : {0.3, 0.5, 0.8, 1.0})
    for (const double angle : {90.0, 30.0}) {
      const double c = std::cos(angle * kPi / 180), s = std::sin(angle * kPi / 180);
      const Rod one{{0.2, 0, 0}, 0.01, 2e11, 7800, 2, 2}, two{{0.2 * c, 0.2 * s, 0}, 0.01, 2e11, 7800, 2, 2};
      Simulation simulation = weightless(
          line_of("one", one) + line_of("two", two) + floating("one") + floating("two") +
              contact_of("one", "two", fmt::format("restitution='{}'", e)),
          start("one", {0, 0, 0}, {0, 0, 0.05}) + start("two", {0.1 - 0.1 * c, -0.1 * s, 0.0205}, {0, 0, -0.05}), 1e-3);
      const double begin = simulation.energies().kinetic;
      run(simulation, 60);
      EXPECT_GT(simulation.section(2, 0.1).pose.position.z() - simulation.section(1, 0.1).pose.position.z(), 0.02);
      EXPECT_NEAR(std::sqrt(simulation.energies().kinetic / begin), e, 0.01) << e << " at " << angle;
      EXPECT_NEAR(energy_account(simulation), begin, 1e-9 * begin);
    }
}

/// Acceleration along an inclined axis of a rod that lies across two held rods [m/s^2].
double acceleration_of_a_rod(int axis, double slope, double friction) {
  const double down = kG * std::sin(slope);
  const Rod held{{0.6, 0, 0}, 0.01, 2e11, 7800, 6, 2}, moving{{0, 0.4, 0}, 0.01, 2e11, 7800, 4, 2};
  Simulation simulation =
      simulation_of(line_of("left", held) + line_of("right", held) + line_of("rod", moving) +
                        clamped("left", {0, -0.08, 0}) + clamped("right", {0, 0.08, 0}) + floating("rod") +
                        contact_of("rod", "*", fmt::format("friction='{}' restitution='1'", friction)),
                    start("rod", {0.05, -0.2, 0.02}, {0, 0, 0}), 1e-3,
                    {axis == 0 ? down : 0, axis == 0 ? 0 : down, -kG * std::cos(slope)});
  const auto place_at = [&](double time) {
    run_until(simulation, time);
    return simulation.section(3, 0.2).pose.position[axis];
  };
  const double first = place_at(0.1), second = place_at(0.175), third = place_at(0.25);
  return (third - 2 * second + first) / (0.075 * 0.075);
}

// The contacts are elastic. With restitution, stations that enter the contact at the front are pressed harder than
// those that leave it at the back, which adds to the friction (docs/notes/contact.md 6). The entering stations excite
// waves of about a hundredth of the force.
TEST(LineContact, CrossedRodsSlideAndRoll) {
  EXPECT_NEAR(acceleration_of_a_rod(1, 0.5, 0.3), kG * (std::sin(0.5) - 0.3 * std::cos(0.5)), 0.015 * kG);
  EXPECT_NEAR(acceleration_of_a_rod(0, 0.3, 0.5), kG * std::sin(0.3) / 1.5, 0.015 * kG) << "it rolls";
}

// The tip of a rod lies on the tip of another one that crosses it below. The load is at both tips, and two equal
// cantilevers carry half of it each.
TEST(LineContact, CrossedCantileversShareALoadInStatics) {
  const Rod along{{1, 0, 0}, 0.005, 2e11, 1e-3, 6, 2}, across{{0, 1, 0}, 0.005, 2e11, 1e-3, 6, 2};
  Simulation simulation =
      weightless(line_of("upper", along) + line_of("lower", across) + clamped("upper", {0, 0, 0.01}) +
                     clamped("lower", {0.98, -0.98, 0}) + contact_of("upper", "lower", "stiffness='1e6'"),
                 "<load link='upper' at='1 0 0' force='0 0 -0.7'/>", 1e-3);
  ASSERT_TRUE(simulation.solve_static(4).converged);
  const double bending = bending_stiffness(along), load = 0.7, at = 0.98;
  // Load of the lower cantilever, from equal deflections at the crossing less the contact's penetration.
  const double by_load = load * at * at * (3 - at) / (6 * bending), by_push = at * at * at / (3 * bending);
  const double lower = -simulation.section(2, at).pose.position.z(),
               upper = 0.01 - simulation.section(1, at).pose.position.z();
  const double push = (by_load - (upper - lower)) / (2 * by_push);
  EXPECT_NEAR(lower, push * by_push, 2e-3 * lower);
  EXPECT_GT(upper, lower - 1e-6);
  EXPECT_LT(upper - lower, 2e-4) << "of 0.35 N on 1e6 N/m, which is less where it is shallow";
  Vector3 told = Vector3::Zero();
  std::vector<ActingContact> contacts;
  simulation.contacts(contacts);
  for (const ActingContact& contact : contacts) told += contact.force;
  EXPECT_NEAR(told.z(), push, 4e-3 * push);
  // The sideways component is at most the distance of the contact points from the crossing, half of their spacing or
  // 1.3 mm, over the distance of both lines.
  EXPECT_LT(told.head<2>().norm(), 0.14 * push) << "there is no friction";
}

// ---------------------------------------------------------------- a beam and itself

/// A moment at its tip rolls up a rod by more than one turn, so that the tip comes to the root in one plane. Returns
/// the smallest distance.
double nearest_of_itself(bool touches) {
  const Rod rope{{1, 0, 0}, 0.01, 1e7, 1000, 12, 2};
  Simulation simulation =
      weightless(line_of("rope", rope) + clamped("rope") + (touches ? contact_of("rope", "rope") : ""),
                 fmt::format("<load link='rope' at='1 0 0' moment='0 {:.17g} 0' history='0:0 4:1 10:1'/>",
                             -2.4 * kPi * bending_stiffness(rope)),
                 5e-3);
  double nearest = 1e9;
  run_until(simulation, 4, [&] {
    nearest = std::min(nearest, nearest_of(simulation, {1, 1}, {1, 1}, kPi * rope.radius));
  });
  return nearest;
}

TEST(LineContact, RodDoesNotGoThroughItself) {
  EXPECT_LT(nearest_of_itself(false), 0.005) << "nothing would have been hit";
  EXPECT_GT(nearest_of_itself(true), 0.02 - 0.1 * 0.01) << "as far as it gives way at most";
}

}  // namespace
}  // namespace flexarm::test::touching
