// Hard cases of sliders: many borders between elements, fast arrival at ends, sliders that leave their line.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/hard_group.h"
#include "bench/urdf.h"

namespace flexarm::bench {
namespace {

using namespace urdf;

constexpr double kLength = 10;  // of the rail [m]

std::string slide(double start, const std::string& more = "") {
  return fmt::format("<slide start=\"{}\" rotation=\"fixed\" {}/>", start, more);
}

/// A steel rail between two clamps, and on it a rider of 1 kg on the joint "ride".
std::string rail(int elements, const std::string& how, const std::string& simulation, double mass = 1) {
  return scene(joint("clamp", "fixed", "world", "rail") + beam("rail", {kLength, 0, 0}, circle(0.05), elements) +
                   loop_joint("other_clamp", "fixed", "world", "rail", {kLength, 0, 0}, {kLength, 0, 0}) +
                   joint("ride", "floating", "rail", "rider", Vector3::Zero(), how) + body("rider", mass, 0.01 * mass),
               simulation);
}

void add_crossings(HardGroup& group) {
  constexpr double kStart = 0.05, kEnd = 9.85;
  for (const double speed : {0.1, 3.0, 50.0, 200.0}) {
    const double until = (kEnd - kStart) / speed;
    group.add(fmt::format("over 98 borders at {:g} m/s", speed),
              rail(100, slide(kStart), initial("ride", kStart, speed)), until / 100, until,
              coordinate_at("ride", kEnd, kLength, 1e-3));
  }
  for (const double speed : {1.0, 3.0, 10.0, 50.0, 200.0}) {
    const double until = 9 / speed;  // gravity accelerates the rider where the rail sags
    group.add(fmt::format("10 kg over 90 borders at {:g} m/s, under gravity", speed),
              rail(100, slide(kStart), gravity({0, 0, -9.81}) + initial("ride", kStart, speed), 10), until / 200, until,
              coordinate_by_run("ride", "", until / 800, kLength, 0.02));
  }
  group.add("driven to and fro over 90 borders",
            rail(100, slide(5), gravity({0, 0, -9.81}) + motion("ride", "5 + 4.5*sin(2*_pi*t)*t*t/(1+t*t)")), 5e-3, 2);
  for (const double mass : {1e-9, 1e6})
    group.add(fmt::format("rider of {:g} kg over 20 borders", mass),
              rail(20, slide(0.1), initial("ride", 0.1, 10), mass), 5e-3, 0.9,
              coordinate_at("ride", 9.1, kLength, 1e-3));
}

void add_ends(HardGroup& group) {
  for (const int elements : {40, 100})
    for (const double speed : {0.1, 1.0, 3.0, 8.0, 20.0, 50.0, 200.0}) {
      constexpr double kRestitution = 0.3;
      const double run_up = std::min(0.2 * speed, 4.0), hit = run_up / speed, element = kLength / elements;
      HardCase& hard =
          group.add(fmt::format("stop at the end, {:g} m/s, elements of {:g} m", speed, element),
                    rail(elements, slide(kLength - run_up), initial("ride", kLength - run_up, speed)), 1e-3, 2 * hit);
      hard.target = coordinate_at("ride", kLength - kRestitution * run_up, kRestitution * run_up, 0.1);
      hard.bound = Bound{"gives way by a tenth of the last element", [element](const Simulation& s) {
                           return (position_of(s, "ride") - kLength) / (0.1 * element);
                         }};
    }
  // 9.95 m at 3 m/s, and back with the remaining velocity until 4 s.
  group.add("over 40 elements at 3 m/s to the stop", rail(40, slide(0.05), initial("ride", 0.05, 3)), 5e-3, 4,
            coordinate_at("ride", kLength - 0.3 * (3 * 4 - 9.95), kLength, 0.01));
  HardCase& pressed =
      group.add("pressed against its stop by 1 MN", rail(40, slide(10), effort("ride", "1e6*min(10*t, 1)")), 1e-3, 0.3);
  pressed.bound = Bound{"gives way by a tenth of the last element",
                        [](const Simulation& s) { return (position_of(s, "ride") - kLength) / 0.025; }};
  for (const double speed : {10.0, 100.0}) {
    HardCase& hard = group.add(
        fmt::format("leaves its line at {:g} m/s", speed),
        rail(40, slide(9, "on_end=\"free\""), initial("ride", 9, speed) + probe("rider", Vector3::Zero())), 1e-3, 0.2);
    hard.target = probe_at({9 + 0.2 * speed, 0, 0}, 0.2 * speed, 0.01);
  }
  HardCase& past = group.add(
      "leaves its line at 200 m/s, over 20 elements in a step",
      rail(100, slide(9, "on_end=\"free\""), initial("ride", 9, 200) + probe("rider", Vector3::Zero())), 1e-2, 0.2);
  past.target = probe_at({49, 0, 0}, 40, 0.01);
  group.add_unsound("passes an end that is an error", rail(40, slide(9, "on_end=\"error\""), initial("ride", 9, 10)),
                    1e-3, 0.2);
  group.add_unsound("driven beyond the end", rail(40, slide(9), motion("ride", "9 + 10*t*t")), 1e-3, 0.5);
}

void add_others(HardGroup& group) {
  group.add("initial velocity without a position", rail(20, slide(0.8), "<initial joint=\"ride\" velocity=\"2\"/>\n"),
            1e-3, 0.5, coordinate_at("ride", 1.8, 1, 1e-3));
  group.add("starts at rest on a border", rail(20, slide(5), gravity({0, 0, -9.81})), 5e-3, 1);
  group.add("starts at rest at the end", rail(20, slide(10), gravity({0, 0, -9.81})), 5e-3, 1);
  group.add_free("arm on a free beam",
                 scene(joint("free", "floating", "world", "line") + beam("line", {0, 3, 1}, rod(1e3, 20, 0.1), 8) +
                           joint("ride", "floating", "line", "arm", Vector3::Zero(), "<slide start=\"3\"/>") +
                           body("arm", 1, 0.05, {0.3, 0, 0}),
                       initial_field("arm", {0, -9, -3}, {0, 0, 4})),
                 1e-3, 0.2);
  group.add("along a quarter of a circle at 30 m/s",
            scene(joint("clamp", "fixed", "world", "rail") +
                      beam_along("rail", "<arc to=\"3 0 3\" center=\"0 0 3\"/>", circle(0.05), 20) +
                      joint("ride", "floating", "rail", "rider", Vector3::Zero(), slide(0.1)) + body("rider", 1, 0.01),
                  initial("ride", 0.1, 30)),
            1e-3, 0.14);
  for (const auto& [where, until] : {std::pair{"", 0.9}, {" to its end", 1.2}})
    group.add(fmt::format("falls along a hanging cable{}", where),
              scene(joint("hook", "floating", "world", "cable", Vector3::Zero(), "<release kind=\"spherical\"/>") +
                        beam("cable", {0, 0, -5}, circle(0.002), 50) +
                        joint("ride", "floating", "cable", "rider", Vector3::Zero(), "<slide start=\"0.02\"/>") +
                        body("rider", 1, 0.01),
                    gravity({0.5, 0, -9.81})),
              2e-3, until);
}

}  // namespace

void add_slider_cases(std::vector<HardCase>& cases) {
  HardGroup group(cases, "slider");
  add_crossings(group);
  add_ends(group);
  add_others(group);
}

}  // namespace flexarm::bench
