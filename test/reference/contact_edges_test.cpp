// Tests slender bodies that cross each other, where neither has a corner in the other.
#include <algorithm>
#include <cmath>
#include <string>

#include "math/pi.h"
#include "reference/contact_scenes.h"

namespace flexarm::test::touching {
namespace {

constexpr double kBarMass = 0.5, kBarLength = 1;

/// A bar along x, of a shape whose axis is z, above one along y that is fixed to the world at z = 0. `y`: how far the
/// lower one is shifted along itself.
struct Crossing {
  std::string shape;
  double thick, y;

  std::string parts(const std::string& contact) const {
    const Vector3 moments(kBarMass * thick * thick / 6, kBarMass * kBarLength * kBarLength / 12,
                          kBarMass * kBarLength * kBarLength / 12);
    return body("upper", kBarMass, moments, Vector3::Zero(),
                "<collision><origin rpy='0 1.5707963267948966 0'/><geometry>" + shape + "</geometry></collision>") +
           fixed("lower", shape, fmt::format("<origin xyz='0 {} 0' rpy='1.5707963267948966 0 0'/>", y)) +
           contact_of("upper", "lower", contact);
  }
};
Crossing rods(double thick, double y) {
  return {fmt::format("<cylinder radius='{}' length='{}'/>", thick / 2, kBarLength), thick, y};
}
Crossing boxes(double thick, double y) {
  return {fmt::format("<box size='{0} {0} {1}'/>", thick, kBarLength), thick, y};
}

/// Velocity after a hit at -1 m/s at a distance from the middle, without weight: the impulse is (1 + e) m v / (1 + m
/// x^2 / J). [m/s]
double speed_after(double restitution, double at) {
  return (1 + restitution) / (1 + 12 / (kBarLength * kBarLength) * at * at) - 1;
}

// The hit of boxes with each other may act anywhere on the square in which they touch. Several points that hit at a
// time give back up to 2 % more or less (docs/notes/contact.md 2).
TEST(ContactOfEdges, BarsThatCrossHitEachOther) {
  constexpr double kRestitution = 0.5;
  for (const double at : {0.0, 0.0625, 0.21, 0.4})
    for (const double y : {0.0, 0.13})
      for (const Crossing& bars : {rods(0.02, y), rods(0.01, y), boxes(0.1, y), boxes(0.02, y)}) {
        Simulation simulation = simulation_of(
            floating("upper") + bars.parts(fmt::format("restitution='{}' contact_time='0.002'", kRestitution)),
            start("upper", {-at, 0, 1.01 * bars.thick + 1e-3}, {0, 0, -1}), 1e-3, Vector3::Zero());
        run_until(simulation, 0.02 + bars.thick);
        const double square = bars.shape.find("box") == std::string::npos ? 0 : bars.thick / 2;
        const double nearer = speed_after(kRestitution, std::max(0.0, at - square)),
                     farther = speed_after(kRestitution, at + square), speed = simulation.momentum().z() / kBarMass;
        EXPECT_GT(speed, farther - 0.02 * (1 + kRestitution)) << bars.shape << at << " " << y;
        EXPECT_LT(speed, nearer + 0.02 * (1 + kRestitution)) << bars.shape << at << " " << y;
        const Energies energies = simulation.energies();
        EXPECT_NEAR(energies.total() + energies.dissipated, 0.5 * kBarMass, 1e-9) << bars.shape << at << " " << y;
      }
}

// A rod that slides level over another one, on a slide without friction of its own, is braked by mu g, though the point
// that touches moves along it. The barrel of its side bends the normal by kBarrel R x / H^2.
TEST(ContactOfEdges, RodSlidesOverAnother) {
  constexpr double kFriction = 0.2, kSpeed = 0.6;
  Simulation simulation = simulation_of(
      rail("along", "carriage", "1 0 0") + body("carriage", 1e-3) +
          joint("up", "prismatic", "carriage", "upper", "<axis xyz='0 0 1'/>" + kFarLimits) +
          rods(0.02, 0.1).parts(fmt::format("friction='{}' restitution='0'", kFriction)),
      fmt::format("<initial joint='along' position='-0.15' velocity='{}'/><initial joint='up' position='0.02'/>",
                  kSpeed),
      1e-3);
  run_until(simulation, 0.1);  // until it presses evenly
  const double begin = simulation.momentum().x(), mass = kBarMass + 1e-3;
  run_until(simulation, 0.25);
  EXPECT_NEAR(begin - simulation.momentum().x(), kFriction * kBarMass * kG * 0.15, 1e-4 * mass * kSpeed);
}

// A rod that lies across another one at its middle rests there, as deep as its weight presses it, at any angle.
TEST(ContactOfEdges, RodRestsOnAnother) {
  for (const double angle : {0.0, 0.7, 1.4}) {
    Simulation simulation = simulation_of(floating("upper") + rods(0.02, 0).parts("friction='0.5' restitution='0.1'"),
                                          start("upper", {0, 0, 0.07}, Vector3::Zero()) +
                                              fmt::format("<initial joint='of_upper/rz' position='{}'/>", angle),
                                          1e-3);
    run_until(simulation, 1);
    EXPECT_NEAR(simulation.link_pose(1).position.z(), 0.02, kG * std::pow(0.01 / kPi, 2)) << angle;
    EXPECT_NEAR(simulation.momentum().norm(), 0, 1e-6) << angle;
  }
}

}  // namespace
}  // namespace flexarm::test::touching
