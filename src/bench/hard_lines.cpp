// Hard cases of lines: slack and snaps, stiff lines, large tensions, pulleys, drums, friction, many points.
#include <cmath>

#include <fmt/format.h>

#include "bench/hard_group.h"
#include "bench/urdf.h"
#include "math/pi.h"

namespace flexarm::bench {
namespace {

using namespace urdf;

constexpr double kGravity = 9.81;
const Vector3 kDown(0, 0, -kGravity);

std::string via(const std::string& link, const Vector3& at = Vector3::Zero(), const std::string& more = "") {
  return fmt::format("<via link=\"{}\" at=\"{}\" {}/> ", link, triple(at), more);
}
std::string pulley(const std::string& link, const Vector3& at, double radius, const std::string& more) {
  return fmt::format("<pulley link=\"{}\" at=\"{}\" axis=\"0 1 0\" radius=\"{}\" {}/> ", link, triple(at), radius,
                     more);
}
/// A line; `law`: attributes.
std::string line(const std::string& law, const std::string& guides) {
  return fmt::format("<tendon name=\"line\" {}> {}</tendon>\n", law, guides);
}

/// A carriage of a mass on a rail along x, whose coordinate is called `rail`.
std::string carriage(double mass) {
  return joint("rail", "prismatic", "world", "carriage", Vector3::Zero(),
               axis({1, 0, 0}) + "<limit lower=\"-1e6\" upper=\"1e6\" effort=\"0\" velocity=\"0\"/>") +
         body("carriage", mass, mass);
}

/// A body on a hinge about y, hanging down by its length; `hinge` is its coordinate.
std::string pendulum(double mass, double length) {
  return joint("hinge", "continuous", "world", "bob", Vector3::Zero(), axis({0, 1, 0})) +
         body("bob", mass, 0.01 * mass, {0, 0, -length});
}

std::string ball(double mass) {
  return joint("flight", "floating", "world", "ball") + body("ball", mass, 0.01 * mass);
}
/// Initial position and velocity of the ball.
std::string thrown(const Vector3& at, const Vector3& velocity) {
  std::string out;
  for (int k = 0; k < 3; ++k)
    out += fmt::format("<initial joint=\"flight/{}\" position=\"{:.17g}\"/>\n", "xyz"[k], at[k]);
  return out + initial_field("ball", velocity, Vector3::Zero()) + probe("ball", Vector3::Zero());
}

void add_snaps(std::vector<HardCase>& cases) {
  HardGroup group(cases, "line");
  const Vector3 velocity(1, 2, 3);
  group.add("slack for ever",
            scene(ball(1) + line("ea=\"1e6\" rest_length=\"100\"", via("world") + via("ball")),
                  thrown({1, 0, 0}, velocity) + gravity(kDown)),
            1e-2, 2, probe_at(Vector3(1, 0, 0) + 2 * velocity + 2 * kDown, 10, 1e-6));
  // The carriage comes with 10 m/s to the end of a line of 1 m, is held for half a period, and goes back.
  for (const double ea : {1e3, 1e5, 1e7}) {
    const double half_period = kPi * std::sqrt(1 / ea), until = 0.2;
    group.add(fmt::format("taut at 10 m/s, EA = {:g} N", ea),
              scene(carriage(1) + line(fmt::format("ea=\"{}\" rest_length=\"1\"", ea), via("world") + via("carriage")),
                    initial("rail", 0.5, 10)),
              1e-3, until, coordinate_at("rail", 1 - 10 * (until - 0.05 - half_period), 1, 0.02));
  }
  for (const double ea : {1e4, 1e8}) {
    HardCase& hard =
        group.add(fmt::format("a body bounces on its line, EA = {:g} N", ea),
                  scene(ball(1) + line(fmt::format("ea=\"{}\" rest_length=\"1\"", ea), via("world") + via("ball")),
                        thrown({0.1, 0, 0}, Vector3::Zero()) + gravity(kDown)),
                  2e-3, 5);
    hard.bound = Bound{"the line is longer than the fall lets it be", [ea](const Simulation& s) {
                         const double fall = 1 + std::sqrt(2 * kGravity * 1.1 / ea) + 4 * kGravity / ea;
                         return s.tip_pose(1).position.norm() / (fall * 1.05);
                       }};
  }
  // A stiff line is as a rod.
  for (const double ea : {1e6, 1e12})
    group.add(fmt::format("pendulum on a line of EA = {:g} N", ea),
              scene(ball(1) + line(fmt::format("ea=\"{}\"", ea), via("world") + via("ball")),
                    thrown({0.2, 0, -std::sqrt(1 - 0.04)}, Vector3::Zero()) + gravity(kDown)),
              5e-3, 2, probe_by_step(5e-4, 0.2, 0.03));
  // A carriage of 1000 kg is pulled by 1e6 N from 0.1 s on.
  group.add(
      "tension steps to 1e6 N",
      scene(carriage(1000) + line("tension=\"t &lt; 0.1 ? 0 : 1e6\"", via("world", {1e3, 0, 0}) + via("carriage")), ""),
      5e-3, 0.2, coordinate_at("rail", 0.5 * 1e3 * 0.01, 5, 0.01));
  group.add(
      "tension of 1e6 N on 1 kg, on and off",
      scene(carriage(1) + line("tension=\"sin(100*t) &gt; 0 ? 1e6 : 0\"", via("world", {1e6, 0, 0}) + via("carriage")),
            ""),
      1e-3, 0.1);
}

void add_geometry(std::vector<HardCase>& cases) {
  HardGroup group(cases, "line");
  // The line through the hinge has no lever.
  const std::string swing = gravity(kDown) + initial("hinge", 1, 0);
  group.add("coinciding points on a hinge",
            scene(pendulum(1, 0.5) + line("tension=\"1000\"", via("world", {1, 0, 0}) + via("world") + via("bob") +
                                                                  via("bob", {0, 0, -0.5})),
                  swing),
            2e-3, 1, coordinate_by_run("hinge", scene(pendulum(1, 0.5), swing), 2e-3, 1, 1e-3));
  group.add_unsound("a line without length",
                    scene(pendulum(1, 0.5) + line("ea=\"1000\"", via("world") + via("bob")), swing), 2e-3, 0.5);
  group.add_unsound(
      "a line to a guide that comes through its pulley",
      scene(carriage(1) + line("ea=\"10\"", via("world", {0.6, 0, 1}) +
                                                pulley("world", {0.5, 0, 0}, 0.1, "side=\"left\"") + via("carriage")),
            initial("rail", 0, 1)),
      2e-3, 1);
  group.add_unsound(
      "a line that is wound up whole",
      scene(carriage(1) + line("ea=\"10\" rest_length=\"1-t\"", via("world") + via("carriage")), motion("rail", "1")),
      2e-3, 2);
  // The peg, a pulley below the pivot, catches the line and lets it go once a swing.
  HardCase& peg = group.add(
      "pendulum on a line that a peg catches",
      scene(ball(1) +
                line("ea=\"1e5\"",
                     via("world") + pulley("world", {0.02, 0, -0.5}, 0.02, "side=\"right\" wrap=\"0\"") + via("ball")),
            thrown({-0.6, 0, -0.8}, Vector3::Zero()) + gravity(kDown)),
      2e-3, 5);
  peg.bound = Bound{"the ball rises higher than it was",
                    [](const Simulation& s) { return s.tip_pose(1).position.z() <= -0.79 ? 0 : 2; }};
  // A drum of 0.1 m lets the line out: 1 N m on 0.1 kg m^2 and a carriage of 1 kg behind it.
  group.add("drum turns a hundred times",
            scene(joint("drum", "continuous", "world", "drum", {0, 0, 0.1}, axis({0, 1, 0})) + body("drum", 1, 0.1) +
                      carriage(1) +
                      line("ea=\"1e4\" rest_length=\"100\"",
                           pulley("drum", Vector3::Zero(), 0.1, "grips=\"true\" side=\"right\"") + via("carriage")),
                  initial("rail", 100, 0) + effort("drum", "1")),
            5e-3, 10, coordinate_at("rail", 100 - 0.5 * (0.1 / (0.1 + 0.01)) * 100, 100, 0.01));
}

void add_many(std::vector<HardCase>& cases) {
  HardGroup group(cases, "line");
  for (const double friction : {0.01, 1.0, 1000.0}) {
    std::string guides = via("world", {-1, 0, 0});
    for (int i = 0; i < 20; ++i)
      guides += via("world", {0.1 * i, 0, i % 2 == 0 ? 0.1 : 0.0}, fmt::format("friction=\"{}\"", friction));
    group.add(fmt::format("friction {:g} at twenty points", friction),
              scene(joint("rail", "prismatic", "world", "carriage", {2, 0, 0},
                          axis({1, 0, 0}) + "<limit lower=\"-9\" upper=\"9\" effort=\"0\" velocity=\"0\"/>") +
                        body("carriage", 1, 1) + line("ea=\"1e5\"", guides + via("carriage")),
                    effort("rail", "200*sin(5*t)")),
              2e-3, 2);
  }
  // Tension T at the distance d bends a beam to the curvature T d/EI and shortens its line by T/EA: a closed form.
  // Between points at angles a of an arc of radius R the line is a chord, whose distance is larger by R a^2/12 in the
  // mean.
  for (const int count : {20, 200, 1000}) {
    const double ei = 1, ea = 1e4, offset = 0.01, tension = 300, length = 1;
    const double curvature = tension * offset / ei, stretch = 1 - tension / ea, angle = curvature * length;
    group.add_static(fmt::format("a beam bent by half a turn by a line through {} points", count),
                     scene(joint("clamp", "fixed", "world", "rod") + beam("rod", {length, 0, 0}, rod(ea, ei, 1), 20) +
                               line(fmt::format("tension=\"{}\"", tension),
                                    fmt::format("<vias link=\"rod\" from=\"0 0 {0}\" to=\"{1} 0 {0}\" count=\"{2}\"/>",
                                                offset, length, count)),
                           probe("rod", {length, 0, 0})),
                     20,
                     probe_at(stretch / curvature * Vector3(std::sin(angle), 0, 1 - std::cos(angle)), 1,
                              1e-3 + 2 * std::pow(angle / (count - 1), 2) / (12 * curvature * offset)));
  }
  group.add("a beam whipped by a line through 60 points",
            scene(joint("clamp", "fixed", "world", "rod") + beam("rod", {1, 0, 0}, rod(1e4, 1, 0.1), 20) +
                      line("tension=\"200*(t &lt; 0.05 ? 1 : 0)\"",
                           "<vias link=\"rod\" from=\"0 0 0.01\" to=\"1 0 0.01\" count=\"60\"/>"),
                  gravity(kDown)),
            2e-3, 0.3);
}

}  // namespace

void add_line_cases(std::vector<HardCase>& cases) {
  add_snaps(cases);
  add_geometry(cases);
  add_many(cases);
}

}  // namespace flexarm::bench
