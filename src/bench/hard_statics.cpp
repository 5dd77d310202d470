// Hard equilibria.
#include <cmath>

#include <fmt/format.h>

#include "bench/hard_group.h"
#include "bench/urdf.h"
#include "math/pi.h"

namespace flexarm::bench {
namespace {

using namespace urdf;

const Vector3 kTip = Vector3::UnitX();
const Vector3 kDown(0, 0, -9.81);

std::string cantilever(double ea, int elements, const std::string& simulation) {
  return scene(joint("clamp", "fixed", "world", "beam") + beam("beam", kTip, rod(ea, 1, 1), elements),
               simulation + probe("beam", kTip));
}

/// Height of the tip of a clamped column of length 1 under `ratio` > 1 times its Euler load: Euler's elastica.
double height_of_elastica(double ratio) {
  double low = 0, high = 1;  // modulus k of K(k) = pi/2 sqrt(ratio)
  for (int i = 0; i < 60; ++i) {
    const double k = (low + high) / 2;
    (std::comp_ellint_1(k) < kPi / 2 * std::sqrt(ratio) ? low : high) = k;
  }
  return 2 * std::comp_ellint_2(low) / std::comp_ellint_1(low) - 1;
}

void add_buckled(HardGroup& group) {
  constexpr double kRatio = 3, kLoad = kRatio * kPi * kPi / 4;
  for (const double lateral : {0.0, 1e-3}) {
    HardCase& hard = group.add_static(
        lateral == 0 ? "straight column, 3 Euler loads" : "column, 3 Euler loads, a thousandth of it across",
        cantilever(1e5, 8, load("beam", kTip, {-kLoad, 0, lateral * kLoad})), 20);
    hard.target = Target{"Euler's elastica",
                         [](const Simulation& s) { return Vector3(s.probe(0).pose.position.x(), 0, 0); },
                         1,
                         0.02,
                         Vector3(height_of_elastica(kRatio), 0, 0),
                         "",
                         0};
  }
  const std::string about_y = axis({0, 1, 0});
  group.add_static(
      "shallow truss, pushed through",
      scene(joint("left_foot", "continuous", "world", "left", Vector3::Zero(), about_y) +
                joint("right_foot", "continuous", "world", "right", {2, 0, 0}, about_y) +
                beam("left", {1, 0, 0.05}, rod(1e5, 10, 1), 4) + beam("right", {-1, 0, 0.05}, rod(1e5, 10, 1), 4) +
                loop_joint("apex", "continuous", "left", "right", {1, 0, 0.05}, {-1, 0, 0.05}, about_y),
            load("left", {1, 0, 0.05}, {0, 0, -200})),
      10);
}

void add_bent_far(HardGroup& group) {
  for (const auto& [turns, elements] : {std::pair{1, 8}, {3, 16}, {10, 40}})
    group.add_static(fmt::format("rolled up {} times", turns),
                     cantilever(1e5, elements, moment("beam", kTip, {0, 2 * kPi * turns, 0})), 20 * turns,
                     probe_at(Vector3::Zero(), 1, 0.02));
  // One and a half turns: tip and clamp are at opposite points of a circle.
  group.add_static("two elements, each bent through 1.5 pi", cantilever(1e5, 2, moment("beam", kTip, {0, 3 * kPi, 0})),
                   40, probe_at({0, 0, -2 / (3 * kPi)}, 1, 0.1));
  for (const double force : {1e3, 1e5})
    group.add_static(fmt::format("tip force of {:g} EI/L^2", force),
                     cantilever(1e10, 16, load("beam", kTip, {0, 0, -force})), 20, probe_at({0, 0, -1}, 1, 0.1));
  for (const double ea : {1e8, 1e12}) {
    HardCase& hard = group.add_static(fmt::format("tip force of 10 EI/L^2, EA L^2/EI = {:g}", ea),
                                      cantilever(ea, 8, load("beam", kTip, {0, 0, -10})), 10);
    hard.target = probe_by_step(hard.step, 1, 0.01);
    hard.target->scene = cantilever(1e4, 8, load("beam", kTip, {0, 0, -10}));
  }
}

void add_hinged(HardGroup& group) {
  const auto hinge = [](const std::string& name, const std::string& parent, const std::string& child, double at) {
    return joint(name, "continuous", parent, child, {at, 0, 0}, axis({0, 1, 0}));
  };
  const std::string arm = hinge("hinge", "world", "arm", 0) + body("arm", 1, 0.1, {0.5, 0, 0});
  group.add_static("horizontal pendulum", scene(arm, gravity(kDown)), 10, coordinate_at("hinge", kPi / 2, 1, 0.01));
  group.add_static("horizontal double pendulum",
                   scene(arm + hinge("elbow", "arm", "hand", 1) + body("hand", 1, 0.1, {0.5, 0, 0}), gravity(kDown)),
                   10, coordinate_at("hinge", kPi / 2, 1, 0.01));
  group.add_static("hinged beam that stands up falls",
                   scene(hinge("hinge", "world", "beam", 0) + beam("beam", {0, 0, 1}, circle(0.01), 4),
                         gravity(kDown) + probe("beam", {0, 0, 1})),
                   10, probe_at({0, 0, -1}, 1, 0.01));
  group.add_static("rider on a sagging cable",
                   scene(joint("clamp", "fixed", "world", "cable") + beam("cable", {4, 0, 0}, circle(0.004), 16) +
                             loop_joint("other_clamp", "fixed", "world", "cable", {4, 0, 0}, {4, 0, 0}) +
                             joint("ride", "floating", "cable", "rider", Vector3::Zero(),
                                   "<slide start=\"1.3\" rotation=\"spherical\"/>") +
                             body("rider", 5, 0.01, {0, 0, -0.1}),
                         gravity(kDown)),
                   10, coordinate_at("ride/s", 2, 4, 0.01));
  const auto carriage = [](const std::string& simulation) {
    return scene(joint("track", "prismatic", "world", "carriage", Vector3::Zero(),
                       axis({1, 0, 0}) + "<limit lower=\"-1e3\" upper=\"1e3\" effort=\"0\" velocity=\"0\"/>") +
                     body("carriage", 1, 0.01),
                 simulation);
  };
  group.add_static("carriage that nothing pushes", carriage(""), 10, coordinate_at("track", 0, 1, 0.01));
  HardCase& free =
      group.add_static("free beam that is pulled",
                       scene(joint("free", "floating", "world", "beam") + beam("beam", kTip, circle(0.01), 4),
                             load("beam", kTip, {1, 0, 0})),
                       10);
  free.is_sound = false;
}

}  // namespace

void add_static_cases(std::vector<HardCase>& cases) {
  HardGroup group(cases, "equilibrium");
  add_buckled(group);
  add_bent_far(group);
  add_hinged(group);
}

}  // namespace flexarm::bench
