// Tests beams in contact against closed forms and an elastica.
#include <algorithm>
#include <cmath>
#include <vector>

#include "math/pi.h"
#include "reference/contact_scenes.h"

namespace flexarm::test::touching {
namespace {

/// A round bar that bends in planes along and across the world's y axis.
std::string rod(const std::string& line, double radius, const std::string& material, int elements) {
  return round_beam("rod", line, radius, "<orientation y='0 1 0'/>" + material, elements);
}

// ---------------------------------------------------------------- a cable over a cylinder

/// A cable that slides over half of a fixed cylinder. ratio(): tension at the pulled end over that at the other end, on
/// which 10 N hang. The cable's undeformed shape is the bent one, and it is thin, so that its bending needs no tension.
struct Capstan {
  static constexpr double kRadius = 0.1, kCable = 2e-4, kEnds = 0.05, kLine = kRadius + kCable;
  static double ratio(int elements, double friction) {
    const double young = 1e4 / (kPi * kCable * kCable), turn = 2 * kLine;
    const std::string material = fmt::format(
        "<material young='{:.17g}' poisson='0.3' density='3e4'/><damping stiffness_proportional='5e-4'/>", young);
    const std::string line = fmt::format(
        "<line to='0 0 {0}'/><arc to='-{1} 0 {2}' center='-{1} 0 {0}'/><arc to='-{3} 0 {0}' center='-{1} 0 {0}'/>"
        "<line to='-{3} 0 0'/>",
        kEnds, kLine, kEnds + kLine, turn);
    const std::string parts =
        joint("pull", "prismatic", "world", "hook",
              fmt::format("<origin xyz='{} 0 -{}'/><axis xyz='0 0 -1'/>", kLine, kEnds) + kFarLimits) +
        body("hook", 0.01, Vector3::Constant(1e-6)) + joint("clamp", "fixed", "hook", "rod") +
        rod(line, kCable, material, elements) +
        fixed("post", fmt::format("<cylinder radius='{}' length='0.1'/>", kRadius),
              fmt::format("<origin rpy='{:.17g} 0 0'/>", kPi / 2)) +
        contact_of("rod", "post", fmt::format("friction='{}' stiffness='1e7'", friction));
    const std::string motion = fmt::format(
        "<motion joint='pull' position='0:0:0 0.1:0:0 0.2:5e-4:0.01 1:8.5e-3:0.01'/>"
        "<load link='rod' at='-{} 0 0' force='0 0 -10' history='0:0 0.05:1'/>",
        turn);
    Simulation simulation = simulation_of(parts, motion, 1e-3, Vector3::Zero());
    run_until(simulation, 0.4);
    double pulled = 0, held = 0;
    const std::size_t cable = 2;
    for (int i = 0; i < 100; ++i) {
      EXPECT_TRUE(simulation.step().converged);
      pulled += simulation.section(cable, 0).resultant[0];
      held += simulation.section(cable, 2 * kEnds + kPi * kLine).resultant[0];
    }
    return pulled / held;
  }
  /// Exponent of the tension per radian for a cable of finite thickness. Friction acts on the cable's surface, at the
  /// distance e = (radius of the cable) / (radius of its line) from the line, relative to this radius. Equilibrium
  /// along the line: T' = f + Q, across it: Q' + T = n. The moment is constant, so Q = -e f; f = mu n. With T ~ exp(a
  /// angle): n (1 + e mu a) = T and a = mu (1 - e) / (1 + e mu a).
  static double exponent(double friction) {
    const double e = kCable / kLine;
    return (std::sqrt(1 + 4 * e * friction * friction * (1 - e)) - 1) / (2 * e * friction);
  }
};

// Vibrations that friction excites leave some 0.1 % in the mean over 0.1 s; the tolerance is 1 %.
TEST(ContactOfBeams, CableOverACylinderHoldsByEuler) {
  constexpr double kFriction = 0.3;
  const double expected = std::exp(kPi * Capstan::exponent(kFriction));
  EXPECT_NEAR(expected, std::exp(kPi * kFriction), 3e-3 * expected) << "a thin cable is nearly Euler's";
  for (const int elements : {12, 24, 48})
    EXPECT_NEAR(Capstan::ratio(elements, kFriction) / expected, 1, elements < 48 ? 0.01 : 3e-3) << elements;
}

// ---------------------------------------------------------------- a cantilever on a plane

/// A cantilever made of a round bar with radius 4 mm, E = 7e9, 2700 kg/m^3. It is clamped level at a height over a
/// plane, and its outer part lies on the plane by its weight.
struct Laid {
  double length, height, stiffness;
  static constexpr double kRadius = 0.004, kBending = 7e9 * kPi / 4 * kRadius * kRadius * kRadius * kRadius;
  static constexpr double kWeight = 2700 * kPi * kRadius * kRadius * kG;  // per length [N/m]
  struct Result {
    double shear, moment, touch;  // shear and moment at the clamp; arc length at which it first touches
  };
  Result solve(int elements) const {
    Simulation simulation = simulation_of(rod(fmt::format("<line to='{} 0 0'/>", length), kRadius,
                                              "<material young='7e9' poisson='0.3' density='2700'/>", elements) +
                                              joint("clamp", "fixed", "world", "rod") +
                                              fmt::format("<ground name='low' offset='{:.17g}'/>", -height - kRadius) +
                                              contact_of("rod", "low", fmt::format("stiffness='{}'", stiffness)),
                                          "", 1e-3);
    EXPECT_TRUE(simulation.solve_static(4).converged);
    std::vector<BeamPoint> points;
    simulation.beam_points(1, 3, points);  // the stations
    const auto touch = std::find_if(points.begin(), points.end(),
                                    [&](const BeamPoint& point) { return point.pose.position.z() < -height; });
    EXPECT_NE(touch, points.end());
    return {std::abs(points.front().resultant[2]), std::abs(points.front().resultant[4]), touch->arc_length};
  }
};

// Small deflections: w = q/(24 EI) (x^4 - 8/3 a x^3 + 2 a^2 x^2), w(a) = height, without moment at the lift-off a.
// There the plane presses with the force q a/3. The clamp carries 2/3 q a and q a^2/6.
TEST(ContactOfBeams, CantileverIsLaidOnAPlane) {
  const Laid laid{1, 1e-3, 1e8};
  const double a = std::pow(72 * Laid::kBending * laid.height / Laid::kWeight, 0.25);
  const auto coarse = laid.solve(40), fine = laid.solve(80);
  for (const auto& seen : {coarse, fine}) {
    EXPECT_NEAR(seen.shear, 2 * Laid::kWeight * a / 3, 1e-3 * seen.shear);
    EXPECT_NEAR(seen.moment, Laid::kWeight * a * a / 6, 2e-3 * seen.moment);
  }
  // The reaction of the plane at the lift-off, from the equilibrium of the free part.
  EXPECT_NEAR(Laid::kWeight * a - fine.shear, Laid::kWeight * a / 3, 1e-3 * Laid::kWeight * a);
}

// Large deflections: EI theta'' = -(V - q s) cos theta, z' = sin theta. Conditions at the clamp: theta = z = 0; at the
// lift-off: theta = theta' = 0, z = height. Unknowns are the length a and the shear V at the clamp; there is no force
// along the plane. scipy.integrate.solve_bvp with the tolerance 1e-10 gives a = 2.19665864 m, V = 1.95606164 N, EI
// theta'(0) = 1.06032959 N m.
TEST(ContactOfBeams, ElasticaIsLaidOnAPlane) {
  constexpr double kLiftOff = 2.19665864, kShear = 1.95606164, kMoment = 1.06032959;
  for (const double stiffness : {1e6, 1e8}) {
    const Laid laid{3, 0.3, stiffness};
    const auto coarse = laid.solve(40), fine = laid.solve(80);
    EXPECT_NEAR(fine.shear, kShear, 1e-4 * kShear) << stiffness;
    EXPECT_NEAR(fine.moment, kMoment, 2e-4 * kMoment) << stiffness;
    EXPECT_GT(observed_order(coarse.moment - kMoment, fine.moment - kMoment), 1.8) << "of elements of order 2";
    // An elastic plane is a foundation, on which w = B exp(-b x) sin(b x) with b^4 = k'/(4 EI). It carries the shear Q
    // together with the moment Q/b. So the bar, whose moment vanishes at the lift-off, has this moment at the distance
    // 1/b before it. The tolerance is (1/b)^2 over the length, and the distance of two stations.
    const double before = std::pow(4 * Laid::kBending / (stiffness / laid.length), 0.25);
    EXPECT_NEAR(fine.touch, kLiftOff - before, 3.0 / 80 / 8 + before * before / kLiftOff) << stiffness;
  }
}

// ---------------------------------------------------------------- an elastic rod hits a wall

// A rod with E = 1e9, 1000 kg/m^3 and radius 20 mm hits a wall end-on with v. The wall feels the force Z v, Z = c A
// rho, until the wave returns from the far end, at 2 L/c. Then the rod leaves with v, and without internal motion. With
// the stiffness k of its end (time r = Z/k), the force is Z v (1 - exp(-t/r)) before the return. After it, with s = t -
// 2 L/c, it is Z v (-1 + 2 (1 + s/r) exp(-s/r)), which ends at s = 1.678 r. The middle of this impulse is r later than
// L/c, and its size is 2 m v (1 - 0.052 r c/(2 L)).
TEST(ContactOfBeams, RodThatHitsAWallEndOnFeelsItsWave) {
  constexpr double kSpeed = 0.1, kRadius = 0.02, kVelocity = 1e3, kWave = 2 / kVelocity;
  const double impedance = kVelocity * 1000 * kPi * kRadius * kRadius, force = impedance * kSpeed;
  struct Hit {
    int elements;
    double stiffness;  // of the whole tube
    double end_share;  // half of the distance of two stations, over the length
    double ripple;     // relative ripple behind the front, because the mesh disperses it
  };
  for (const Hit& hit : {Hit{20, 5e9, 0.5 / 60, 0.02}, Hit{40, 1e10, 0.5 / 80, 0.01}}) {
    Simulation simulation = simulation_of(
        rod("<line to='0 0 1'/>", kRadius, "<material young='1e9' poisson='0' density='1000'/>", hit.elements) +
            floating("rod") + kFloor +
            contact_of("rod", "floor", fmt::format("restitution='1' stiffness='{}'", hit.stiffness)),
        start("rod", {0, 0, kRadius + 1e-9}, {0, 0, -kSpeed}), kWave / 320, Vector3::Zero());
    const double rise = impedance / (hit.stiffness * hit.end_share), energy = simulation.energies().total();
    const double whole = 2 * simulation.mass() * kSpeed;
    double impulse = 0, first_moment = 0, mean = 0, squares = 0, end = 0;
    int count = 0;
    for (int i = 0; i < 480; ++i) {
      const double before = simulation.momentum().z(), time = simulation.time() + 0.5 * simulation.step_size();
      ASSERT_TRUE(simulation.step().converged);
      const double change = simulation.momentum().z() - before, pressed = change / simulation.step_size() / force;
      impulse += change;
      first_moment += change * time;
      if (pressed > 1e-3) end = time;
      if (time < 0.2 * kWave || time > 0.8 * kWave) continue;
      ++count;
      mean += pressed;
      squares += (pressed - 1) * (pressed - 1);
    }
    EXPECT_NEAR(mean / count, 1, 1e-3) << hit.elements;
    EXPECT_LT(std::sqrt(squares / count), hit.ripple) << hit.elements;
    EXPECT_NEAR(impulse / whole, 1 - 0.052 * rise / kWave, 1e-3) << hit.elements;
    EXPECT_NEAR(first_moment / impulse, 0.5 * kWave + rise, 1e-3 * kWave) << hit.elements;
    EXPECT_NEAR(end, kWave + 1.678 * rise, 0.01 * kWave) << hit.elements;
    EXPECT_NEAR(simulation.energies().total(), energy, 1e-9 * energy);
    EXPECT_EQ(simulation.energies().dissipated, 0);
  }
}

// ---------------------------------------------------------------- bounces

// Every iteration has new factors, so that the residual is solved to round-off.
TEST(ContactOfBeams, AHundredHitsOfABeamKeepItsEnergy) {
  Simulation simulation =
      simulation_of(rod("<line to='1 0 0'/>", 0.01, "<material young='5e9' poisson='0.3' density='2000'/>", 6) +
                        floating("rod") + kFloor + contact_of("rod", "floor", "restitution='1' stiffness='1e6'"),
                    start("rod", {0, 0, 0.03}, {0, 0, 0}) + "<initial joint='of_rod/ry' position='0.01'/>", 2e-4,
                    {0, 0, -kG}, full_newton());
  const double begin = simulation.energies().total();
  ASSERT_LT(simulation.energies().strain, 1e-20) << "it starts outside";
  int hits = 0;
  bool touched = false;
  std::vector<BeamPoint> points;
  while (hits < 100 && simulation.time() < 5) {
    ASSERT_TRUE(simulation.step().converged);
    points.clear();
    simulation.beam_points(1, 3, points);
    const bool touches = std::any_of(points.begin(), points.end(),
                                     [](const BeamPoint& point) { return point.pose.position.z() < 0.01; });
    hits += touches && !touched;
    touched = touches;
    ASSERT_NEAR(simulation.energies().total(), begin, 1e-10 * begin) << hits;
  }
  EXPECT_EQ(hits, 100);
  EXPECT_EQ(simulation.energies().dissipated, 0);
}

}  // namespace
}  // namespace flexarm::test::touching
