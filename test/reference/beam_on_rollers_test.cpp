// Tests contacts of a beam's line with cylinders that are fixed to the world, in equilibrium and about it.
#include <algorithm>
#include <cmath>
#include <map>

#include "math/pi.h"
#include "reference/contact_scenes.h"

namespace flexarm::test::touching {
namespace {

/// A beam of 2 m, clamped to a carriage at its middle, lies on two rollers that are fixed to the world, at 0.6 m to
/// both sides.
Simulation beam_on_two_rollers(int elements) {
  std::string parts = body("carriage", 1e-4, Vector3::Constant(1e-6)) + rail("up", "carriage", "0 0 1");
  for (const int side : {1, -1}) {
    const std::string name = side > 0 ? "right" : "left";
    parts += fmt::format(
                 "<link name='{}'><beam elements='{}' order='2'><centerline><line to='{} 0 0'/></centerline>"
                 "<orientation y='0 1 0'/><section ea='1e7' ga2='1e7' ga3='1e7' gj='100' ei2='50' ei3='50' mass='0.8' "
                 "j1='1e-4' j2='5e-5' j3='5e-5'/></beam></link>",
                 name, elements, side) +
             joint("of_" + name, "fixed", "carriage", name) +
             fixed(name + "_roller", "<cylinder radius='0.05' length='0.2'/>",
                   fmt::format("<origin xyz='{} 0 {:.17g}' rpy='{:.17g} 0 0'/>", 0.6 * side,
                               1e-6 - 0.05 - std::sqrt(4 * 50 / 1e7), 0.5 * kPi)) +
             contact_of(name, name + "_roller", "stiffness='1e6'");
  }
  return simulation_of(parts, "", 1e-3, {0, 0, -kG});
}

// The supports carry a half each. With w = 8 g / 10 N/m, a = 0.4 m beyond them and L = 1.2 m between them, the middle
// is lower than the supports by 5 w L^4 / (384 EI) - w a^2 L^2 / (16 EI), and the ends are lower by w a^4 / (8 EI) - a
// (w L^3 / (24 EI) - w a^2 L / (4 EI)). The slope at the supports, 4e-3, moves the places of contact by 2e-4 m, which
// changes the sag by 4e-3; shear by 1e-4.
TEST(BeamOnRollers, RestsOnBoth) {
  const double w = 0.8 * kG, a = 0.4, length = 1.2, bending = 50;
  const double sag = 5 * w * std::pow(length, 4) / (384 * bending) - w * a * a * length * length / (16 * bending);
  const double end = w * std::pow(a, 4) / (8 * bending) -
                     a * (w * std::pow(length, 3) / (24 * bending) - w * a * a * length / (4 * bending));
  for (const int elements : {8, 16, 20, 27}) {
    Simulation simulation = beam_on_two_rollers(elements);
    ASSERT_TRUE(simulation.solve_static(10).converged) << elements;
    const std::size_t right = 2, left = 4;  // links: world, carriage, right, right_roller, left
    ASSERT_EQ(simulation.link_names()[left], "left");
    for (const std::size_t link : {right, left}) {
      const double over = simulation.section(link, 0.6).pose.position.z();
      EXPECT_NEAR(over - simulation.section(link, 0).pose.position.z(), sag, 6e-3 * sag) << elements;
      EXPECT_NEAR(over - simulation.section(link, 1).pose.position.z(), end, 6e-3 * sag) << elements;
      EXPECT_NEAR(over, -w / 1e6, 0.5 * w / 1e6) << elements << ": the penetration";
    }
    std::map<std::string, double> carried;
    std::vector<ActingContact> contacts;
    simulation.contacts(contacts);
    for (const ActingContact& contact : contacts) carried[contact.first] += contact.force.z();
    EXPECT_EQ(carried.size(), 2U);
    for (const auto& [link, force] : carried) EXPECT_NEAR(force, w + 0.5e-4 * kG, 1e-5 * w) << link << elements;
  }
}

// The carriage keeps the middle from turning: symmetric vibrations of a beam on two supports. With b^4 = m omega^2 / EI
// the slope and the moment of both parts agree at the support if (tan bl + tanh bl) / 2 =
// (1 + cos ba cosh ba) / (cosh ba sin ba - cos ba sinh ba), l = 0.6 m and a = 0.4 m. That the slope moves the places of
// contact by 2e-4 m changes the frequency by 1e-3 (l enters with the power 2 to 4); so does the contact's stiffness.
TEST(BeamOnRollers, VibratesBetweenThem) {
  const double a = 0.4, l = 0.6;
  const auto misfit = [&](double b) {
    const double x = b * a, y = b * l;
    return (std::sin(y) + std::cos(y) * std::tanh(y)) * (std::cosh(x) * std::sin(x) - std::cos(x) * std::sinh(x)) -
           2 * std::cos(y) * (1 + std::cos(x) * std::cosh(x));
  };
  double low = 0.1, high = low;
  while (misfit(high) * misfit(low) > 0) high += 0.01;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (misfit(middle) * misfit(low) > 0 ? low : high) = middle;
  }
  for (const int elements : {8, 20}) {
    Simulation simulation = beam_on_two_rollers(elements);
    ASSERT_TRUE(simulation.solve_static(10).converged) << elements;
    const std::vector<Mode> modes = simulation.natural_modes(6);
    const auto vertical = std::find_if(modes.begin(), modes.end(), [](const Mode& mode) {
      return std::abs(mode.coordinate_motion[0]) > 1e-3;  // the carriage moves
    });
    ASSERT_NE(vertical, modes.end()) << elements;
    const double frequency = low * low * std::sqrt(50 / 0.8) / (2 * kPi);
    EXPECT_NEAR(vertical->frequency, frequency, 3e-3 * frequency) << elements;
  }
}

// A box that cannot turn lies with its nearer end on a cantilever without weight: F c^3 / (3 EI) at c = 0.2 m. It lies
// along 64 of the beam's 80 elements, of which it touches one, far from its middle; the next place of the line is lower
// by F c^2 / (2 EI) times 25 mm, or 0.2 mm. The end's edge gives way by F / k at most, 1e-5 m, and the tube's stations
// take up some of it. Shear and the slope have the relative effect 1e-3.
TEST(LineContact, LongBoxLiesOnItsEnd) {
  const double force = 0.1 * kG, c = 0.2, radius = 0.002, young = 2e11;
  Simulation simulation = simulation_of(
      round_beam("beam", "<line to='2 0 0'/>", radius,
                 fmt::format("<material young='{}' poisson='0.3' density='1e-3'/>", young), 80) +
          joint("of_beam", "fixed", "world", "beam") + box("box", 0.1, {1.6, 0.04, 0.02}) +
          joint("up", "prismatic", "world", "box", "<origin xyz='1 0 0'/><axis xyz='0 0 1'/>" + kFarLimits) +
          contact_of("box", "beam", "stiffness='1e5'"),
      fmt::format("<initial joint='up' position='{}'/>", 0.01 + radius - 1e-6), 1e-3);
  ASSERT_TRUE(simulation.solve_static(10).converged);
  const double deflection = force * c * c * c / (3 * young * 0.25 * kPi * std::pow(radius, 4));
  const double sunk = 0.01 + radius - simulation.position(0);
  EXPECT_GT(sunk, (1 - 2e-3) * deflection);
  EXPECT_LT(sunk, (1 + 2e-3) * deflection + force / 1e5);
}

}  // namespace
}  // namespace flexarm::test::touching
