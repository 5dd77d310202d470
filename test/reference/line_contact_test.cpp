// Beams whose smooth lines are touched: by balls, by each other, by themselves. Against closed forms.
#include <algorithm>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::test::touching_lines {
namespace {

constexpr double kG = 9.81, kPi = 3.14159265358979323846;

std::string ball(const std::string& name, double mass, double radius) {
  return fmt::format(
      "<link name=\"{0}\"><inertial><mass value=\"{1:.17g}\"/><inertia ixx=\"{2:.17g}\" iyy=\"{2:.17g}\" "
      "izz=\"{2:.17g}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><sphere radius=\"{3}\"/>"
      "</geometry></collision></link>",
      name, mass, 0.4 * mass * radius * radius, radius);
}

struct Rod {
  Vector3 to;
  double radius = 0.01, young = 7e10, density = 2700;
  int elements = 4, order = 2;
};
std::string rod(const std::string& name, const Rod& rod) {
  return fmt::format(
      "<link name=\"{}\"><beam elements=\"{}\" order=\"{}\"><centerline><line to=\"{:.17g} {:.17g} {:.17g}\"/>"
      "</centerline><circle radius=\"{:.17g}\"/><material young=\"{:.17g}\" poisson=\"0.3\" density=\"{:.17g}\"/></beam>"
      "</link>",
      name, rod.elements, rod.order, rod.to.x(), rod.to.y(), rod.to.z(), rod.radius, rod.young, rod.density);
}
double bending_stiffness(const Rod& rod) {
  return rod.young * 0.25 * kPi * std::pow(rod.radius, 4);
}

std::string joint(const std::string& link, const std::string& type, const Vector3& place = {0, 0, 0}) {
  return fmt::format(
      "<joint name=\"of_{0}\" type=\"{1}\"><parent link=\"world\"/><child link=\"{0}\"/><origin xyz=\"{2:.17g} {3:.17g} "
      "{4:.17g}\"/><axis xyz=\"0 0 1\"/></joint>",
      link, type, place.x(), place.y(), place.z());
}

std::string start(const std::string& link, const Vector3& place, const Vector3& velocity) {
  std::string out;
  const char* axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    out += fmt::format("<initial joint=\"of_{}/{}\" position=\"{:.17g}\"/>", link, axes[k], place[k]);
  return out + fmt::format("<initial link=\"{}\" linear=\"{:.17g} {:.17g} {:.17g}\"/>", link, velocity.x(),
                           velocity.y(), velocity.z());
}

Simulation simulation_of(const std::string& parts, const std::string& starts, double step,
                         const Vector3& gravity = {0, 0, 0}) {
  scene::ReadResult result = scene::read_scene_text(
      fmt::format(
          "<robot name=\"contact\"><link name=\"world\"/>{}<simulation><gravity xyz=\"{:.17g} {:.17g} {:.17g}\"/>"
          "<integrator scheme=\"em\" step=\"{:.17g}\"/>{}</simulation></robot>",
          parts, gravity.x(), gravity.y(), gravity.z(), step, starts),
      "contact.urdf");
  for (const scene::Diagnostic& finding : result.diagnostics) ADD_FAILURE() << finding.text();
  return Simulation(result.scene.value());
}

double account(const Simulation& simulation) {
  const Energies energies = simulation.energies();
  return energies.total() + energies.dissipated - energies.work;
}

// ---------------------------------------------------------------- balls

/// A ball smaller than the distance of the beam's stations, half way between two of them.
Simulation ball_over_a_thin_beam(double restitution) {
  return simulation_of(
      rod("wire", {{1, 0, 0}, 0.003, 7e10, 2700, 4, 2}) + joint("wire", "fixed") + ball("ball", 0.002, 0.004) +
          joint("ball", "floating") +
          fmt::format("<contact first=\"ball\" second=\"wire\" restitution=\"{}\" stiffness=\"2000\"/>", restitution),
      start("ball", {0.140625, 0, 0.02}, {0, 0, -0.5}), 5e-4, {0, 0, -kG});
}

TEST(LineContact, BallBouncesOnAThinBeamBetweenItsStations) {
  Simulation simulation = ball_over_a_thin_beam(1);
  const double begin = simulation.energies().total();
  int bounces = 0;
  double last = 0;
  while (bounces < 30 && simulation.time() < 3) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << simulation.explain(result);
    const double height = simulation.link_pose(2).position.z() - simulation.section(1, 0.140625).pose.position.z();
    ASSERT_GT(height, 0.0063) << simulation.time();
    bounces += last >= 0.007 && height < 0.007;
    last = height;
    ASSERT_NEAR(simulation.energies().total(), begin, 1e-10 * 0.5);
  }
  EXPECT_EQ(bounces, 30);
}

// A carriage with a ball goes down on a cantilever, whose deflection at the ball is m g a^3 / (3 E I).
TEST(LineContact, BallRestsOnABeam) {
  const Rod beam{{1, 0, 0}, 0.01, 7e10, 1e-3, 5, 3};
  const double mass = 0.2, at = 0.63, radius = 0.02, stiffness = 1e4;
  Simulation simulation = simulation_of(
      rod("beam", beam) + joint("beam", "fixed") + ball("ball", mass, radius) +
          "<joint name=\"of_ball\" type=\"prismatic\"><parent link=\"world\"/><child link=\"ball\"/>"
          "<origin xyz=\"0.63 0 0\"/><axis xyz=\"0 0 1\"/><limit effort=\"1e9\" velocity=\"1e9\" lower=\"-1\" "
          "upper=\"1\"/></joint>" +
          fmt::format("<contact first=\"ball\" second=\"beam\" stiffness=\"{}\"/>", stiffness),
      fmt::format("<initial joint=\"of_ball\" position=\"{}\"/>", radius + beam.radius - 1e-6), 1e-3, {0, 0, -kG});
  ASSERT_TRUE(simulation.solve_static(1).converged);
  const double deflection = mass * kG * std::pow(at, 3) / (3 * bending_stiffness(beam));
  const double penetration = mass * kG / stiffness;  // of what hardens by 2 (p / d)^2, which is 0.08 here
  const double height = simulation.link_pose(2).position.z();
  const double slope = mass * kG * at * at / (2 * bending_stiffness(beam));
  // Shear, the ball's place beside the section below it, and the slope count for parts of (radius / length)^2 and slope^2.
  EXPECT_NEAR(height, radius + beam.radius - deflection, deflection * (4e-3 + slope * slope) + penetration);
  EXPECT_NEAR(simulation.section(1, at).pose.position.z(), -deflection, 4e-3 * deflection);
  const double approach = height - simulation.section(1, at).pose.position.z();
  EXPECT_LT(approach, radius + beam.radius);
  EXPECT_GT(approach, radius + beam.radius - penetration - 1e-5);
}

// ---------------------------------------------------------------- two beams

/// Beams that a spring holds together hit each other again and again, and nothing else acts on them.
void expect_conserved_hits(const std::string& parts, const std::string& starts, double step, double duration) {
  Simulation simulation = simulation_of(parts, starts, step);
  const double energy = simulation.energies().total();
  const Vector3 momentum = simulation.momentum(), angular = simulation.angular_momentum();
  int hits = 0;
  bool touched = false;
  while (simulation.time() < duration) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << simulation.explain(result);
    double nearest = 1;
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; j <= 40; ++j) {
        if (parts.find("alongside") != std::string::npos && i != j) continue;
        const Vector3 a = simulation.section(1, 0.6 * i / 40).pose.position;
        const Vector3 b = simulation.section(2, 0.6 * j / 40).pose.position;
        nearest = std::min(nearest, (a - b).norm());
      }
    const bool touches = nearest < 0.0205;
    hits += touches && !touched;
    touched = touches;
  }
  EXPECT_GE(hits, 100);
  EXPECT_NEAR(simulation.energies().total(), energy, 1e-10 * energy);
  EXPECT_LE((simulation.momentum() - momentum).norm(), 1e-10);
  EXPECT_LE((simulation.angular_momentum() - angular).norm(), 1e-10);
}

TEST(LineContact, BeamsThatHitEachOtherCrosswiseKeepEnergyAndMomenta) {
  expect_conserved_hits(
      rod("one", {{0.6, 0, 0}, 0.01, 2e9, 1500, 3, 2}) + rod("two", {{0.2, 0.56, 0}, 0.01, 2e9, 1500, 3, 2}) +
          joint("one", "floating") + joint("two", "floating") +
          "<spring from=\"one\" from_at=\"0.3 0 -0.05\" to=\"two\" to_at=\"0.1 0.28 0.05\" stiffness=\"400\" "
          "rest_length=\"0.02\"/><contact first=\"one\" second=\"two\" restitution=\"1\" stiffness=\"2e4\"/>",
      start("one", {0, 0, 0}, {0, 0, 0}) + start("two", {0.2, -0.28, 0.05}, {0.02, 0.01, -1}), 1e-3, 6);
}

}  // namespace
}  // namespace flexarm::test::touching_lines
