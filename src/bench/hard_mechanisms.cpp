// Hard cases of mechanisms: mass ratios, massless links, dead points, loops, distance, scales.
#include <cmath>

#include <fmt/format.h>

#include "bench/hard_group.h"
#include "bench/urdf.h"
#include "math/pi.h"

namespace flexarm::bench {
namespace {

using namespace urdf;

const Vector3 kDown(0, 0, -9.81);
const std::string kSpherical = "<release kind=\"spherical\"/>";

std::string hinge(const std::string& name, const std::string& parent, const std::string& child, const Vector3& at,
                  const Vector3& about = Vector3::UnitY()) {
  return joint(name, "continuous", parent, child, at, axis(about));
}

std::string rail(const std::string& name, const std::string& parent, const std::string& child) {
  return joint(name, "prismatic", parent, child, Vector3::Zero(),
               axis({1, 0, 0}) + "<limit lower=\"-1e3\" upper=\"1e3\" effort=\"0\" velocity=\"0\"/>");
}

std::string about_y() {
  return axis({0, 1, 0});
}

void add_mass_ratios(std::vector<HardCase>& cases) {
  HardGroup group(cases, "mass ratio");
  for (const double ratio : {1e-12, 1e-6, 1e6, 1e12})
    group.add(fmt::format("double pendulum, lower mass {:g} times the upper", ratio),
              scene(hinge("upper", "world", "arm", Vector3::Zero()) + body("arm", 1, 0.1, {0.5, 0, 0}) +
                        hinge("lower", "arm", "hand", {1, 0, 0}) + body("hand", ratio, 0.1 * ratio, {0.5, 0, 0}),
                    gravity(kDown)),
              2e-3, 1);
  for (const double mass : {1e-12, 1e-6, 1e6, 1e12}) {
    // From 1e6 kg on, the bending of the beam of 1 kg does not matter: the tip accelerates by 0.1 m/s^2.
    HardCase& hard = group.add(
        fmt::format("beam of 1 kg, tip body of {:g} kg pushed", mass),
        scene(joint("clamp", "fixed", "world", "beam") + beam("beam", {1, 0, 0}, rod(1e5, 1, 1), 8) +
                  joint("tip", "fixed", "beam", "ball", {1, 0, 0}) + body("ball", mass, 1e-3 * mass),
              load("ball", Vector3::Zero(), {0, 0, 0.1 * std::max(mass, 1.0)}) + probe("ball", Vector3::Zero())),
        0.01, 1);
    hard.target = mass < 1 ? probe_by_step(0.0025, 1, 0.01) : probe_at({1, 0, 0.05}, 0.05, 0.05);
  }
  for (const double mass : {1e6, 1e12})
    group.add_free(
        fmt::format("satellite of {:g} kg turns with an arm of 1 kg", mass),
        scene(joint("free", "floating", "world", "satellite") + body("satellite", mass, mass) +
                  joint("root", "fixed", "satellite", "arm", {1, 0, 0}) + beam("arm", {2, 0, 0}, rod(1e5, 1, 1), 8),
              initial_field("satellite", Vector3::Zero(), {0.1, 0, 1})),
        0.01, 2);
  std::string chain, parent = "world";
  for (int i = 0; i < 10; ++i) {
    const std::string link = fmt::format("link{}", i);
    const double mass = i % 2 == 0 ? 1e-6 : 1;
    chain += hinge(fmt::format("joint{}", i), parent, link, {i == 0 ? 0.0 : 0.1, 0, 0}) +
             body(link, mass, 1e-3 * mass, {0.05, 0, 0});
    parent = link;
  }
  group.add("chain of masses 1e-6 and 1 kg in turn falls", scene(chain, gravity(kDown)), 1e-3, 0.5);
}

/// A body in two massless rings, which turn about z, y and z.
void add_gimbals(HardGroup& group) {
  const auto gimbal = [](double nutation, const std::string& rates) {
    return scene(hinge("first", "world", "outer", Vector3::Zero(), {0, 0, 1}) + massless("outer") +
                     hinge("second", "outer", "inner", Vector3::Zero(), {0, 1, 0}) + massless("inner") +
                     hinge("third", "inner", "end", Vector3::Zero(), {0, 0, 1}) +
                     body("end", 1, Vector3(0.1, 0.15, 0.2), {0, 0, 0.1}),
                 gravity(kDown) + initial("second", nutation, 1) + rates);
  };
  group.add("gimbal of massless rings", gimbal(1, initial("third", 0, 20)), 2e-3, 1);
  group.add("gimbal that passes close to its lock", gimbal(-0.5, initial("first", 0, 1e-3)), 2e-3, 1);
  group.add_unsound("gimbal locked at the start", gimbal(0, ""), 2e-3, 0.5);
}

void add_massless(std::vector<HardCase>& cases) {
  HardGroup group(cases, "massless link");
  const auto chain = [](int massless_links, double bend, const std::string& end) {
    std::string links, positions, parent = "world";
    for (int i = 0; i <= massless_links; ++i) {
      const std::string link = i == massless_links ? "end" : fmt::format("link{}", i), name = fmt::format("joint{}", i);
      links += hinge(name, parent, link, {i == 0 ? 0.0 : 1.0, 0, 0}) + (i == massless_links ? end : massless(link));
      if (i > 0) positions += initial(name, bend, 0);
      parent = link;
    }
    return scene(links, gravity(kDown) + positions);
  };
  const std::string weight = body("end", 1, 0.1, {0.5, 0, 0}), point = body("end", 1, 0.0, {1, 0, 0});
  group.add("one, bent, then a body", chain(1, 1, weight), 2e-3, 0.5);
  group.add("one, straight, then a body", chain(1, 0, weight), 2e-3, 0.5);
  group.add("one, bent, then a point mass", chain(1, 1, point), 2e-3, 0.3);
  group.add("two, bent, then a body", chain(2, 0.7, weight), 2e-3, 0.3);
  group.add_unsound("one, straight, then a point mass", chain(1, 0, point), 2e-3, 0.3);
  group.add_unsound("four, bent, then a body", chain(4, 0.5, weight), 2e-3, 0.3);
  const std::string spin = gravity(kDown) + initial("first", 0, 1);
  group.add_unsound("two coinciding axes, nothing between",
                    scene(hinge("first", "world", "ring", Vector3::Zero()) + massless("ring") +
                              hinge("second", "ring", "end", Vector3::Zero()) + weight,
                          spin),
                    2e-3, 0.5);
  group.add_unsound("hinge through a point mass",
                    scene(hinge("first", "world", "end", Vector3::Zero()) + body("end", 1, 0.0), spin), 2e-3, 0.5);
  group.add_unsound("free link without mass", scene(joint("free", "floating", "world", "end") + massless("end")), 2e-3,
                    0.5);
  group.add("massless link with a motion",
            scene(hinge("first", "world", "crank", Vector3::Zero()) + massless("crank") +
                      hinge("second", "crank", "end", {1, 0, 0}) + weight,
                  gravity(kDown) + motion("first", "5*t*t/(1+t)")),
            2e-3, 1);
  group.add("massless carriage with a pendulum",
            scene(rail("track", "world", "carriage") + massless("carriage") +
                      hinge("second", "carriage", "end", Vector3::Zero()) + weight,
                  gravity(kDown)),
            2e-3, 1);
  add_gimbals(group);
}

/// A four-bar linkage in the plane y = 0 with rigid links on continuous joints; the loop joint is between coupler and
/// rocker.
std::string four_bar(const Vector3& crank, const Vector3& coupler, const Vector3& foot, const Vector3& rocker,
                     const std::string& simulation) {
  const auto link = [](const std::string& name, const Vector3& to) { return body(name, 1, 0.05, to / 2); };
  return scene(hinge("crank", "world", "crank", Vector3::Zero()) + link("crank", crank) +
                   hinge("knee", "crank", "coupler", crank) + link("coupler", coupler) +
                   hinge("foot", "world", "rocker", foot) + link("rocker", rocker) +
                   loop_joint("hip", "continuous", "rocker", "coupler", rocker, coupler, about_y()),
               simulation);
}

std::string slider_crank(const std::string& simulation, bool has_flexible_rod) {
  const Vector3 rod_end(0.6, 0, 0);
  return scene(hinge("crank", "world", "crank", Vector3::Zero()) + body("crank", 1, 0.05, {0.1, 0, 0}) +
                   hinge("knee", "crank", "rod", {0.2, 0, 0}) +
                   (has_flexible_rod ? beam("rod", rod_end, circle(0.005), 6) : body("rod", 1, 0.05, rod_end / 2)) +
                   joint("bore", "prismatic", "world", "piston", {0.8, 0, 0},
                         axis({1, 0, 0}) + "<limit lower=\"-5\" upper=\"5\" effort=\"0\" velocity=\"0\"/>") +
                   body("piston", 1, 0.05) +
                   loop_joint("pin", "continuous", "piston", "rod", Vector3::Zero(), rod_end, about_y()),
               simulation);
}

void add_dead_points(std::vector<HardCase>& cases) {
  HardGroup group(cases, "dead point");
  const std::string turning = "2*_pi*10*t*t/(0.1 + t)";  // up to 10 turns/s
  group.add_unsound("parallelogram started flat", four_bar({1, 0, 0}, {2, 0, 0}, {2, 0, 0}, {1, 0, 0}, gravity(kDown)),
                    2e-3, 0.5);
  // Crank and coupler are in line: here the rocker reverses, while the crank may go on.
  const Vector3 crank(0.2, 0, 0), coupler(0.6, 0, 0), foot(0.6, 0, -0.4), rocker(0.2, 0, 0.4);
  group.add("four-bar started where its rocker turns back", four_bar(crank, coupler, foot, rocker, gravity(kDown)),
            2e-3, 1);
  group.add("four-bar, rocker driven at its turning point",
            four_bar(crank, coupler, foot, rocker, gravity(kDown) + effort("foot", "5*t")), 2e-3, 0.5);
  group.add("crank-rocker turns through its dead points",
            four_bar(crank, coupler, foot, rocker, motion("crank", turning)), 1e-3, 0.5);
  group.add_unsound(
      "four-bar with two motions",
      four_bar({0, 0, 0.5}, {0.6, 0, 0}, {0.6, 0, 0}, {0, 0, 0.5}, motion("foot", "0") + motion("crank", "t")), 2e-3,
      2);
  group.add_unsound("triple rocker driven beyond its reach",
                    four_bar({0, 0, 0.8}, {0.6, 0, 0}, {0.6, 0, 0.2}, {0, 0, 0.6}, motion("crank", "3*t*t/(1+t)")),
                    2e-3, 2);
  group.add("slider-crank turns through its dead points", slider_crank(motion("crank", turning), false), 1e-3, 0.5);
  group.add("slider-crank with a flexible rod turns through its dead points",
            slider_crank(motion("crank", turning), true), 1e-3, 0.5);
  group.add("slider-crank started at its dead point, piston pushed",
            slider_crank(load("piston", Vector3::Zero(), {-50, 0, 1e-3}) + gravity(kDown), false), 1e-3, 1);
}

void add_loops(std::vector<HardCase>& cases) {
  HardGroup group(cases, "loop");
  const auto bar = [](const std::string& name, const Vector3& to) { return body(name, 1, 0.05, to / 2); };
  // Each rocker beyond the second makes the loop overconstrained.
  const auto parallelogram = [&](int rockers) {
    std::string links = hinge("foot0", "world", "rocker0", Vector3::Zero()) + bar("rocker0", {0, 0, 1}) +
                        hinge("head0", "rocker0", "coupler", {0, 0, 1}) + bar("coupler", {2, 0, 0});
    for (int i = 1; i < rockers; ++i) {
      const std::string name = fmt::format("rocker{}", i);
      const Vector3 place(2.0 * i / (rockers - 1), 0, 0);
      links += hinge(fmt::format("foot{}", i), "world", name, place) + bar(name, {0, 0, 1}) +
               loop_joint(fmt::format("head{}", i), "continuous", name, "coupler", {0, 0, 1}, place, about_y());
    }
    return scene(links, gravity(kDown) + initial("foot0", 0, 1));
  };
  group.add("parallelogram", parallelogram(2), 2e-3, 1);
  group.add("parallelogram with a third rocker", parallelogram(3), 2e-3, 1);
  group.add("parallelogram with five rockers", parallelogram(5), 2e-3, 1);
  const auto door = [&](int hinges) {
    std::string links = hinge("hinge0", "world", "door", Vector3::Zero(), {0, 0, 1}) + body("door", 10, 1, {0.5, 0, 1});
    for (int i = 1; i < hinges; ++i)
      links += loop_joint(fmt::format("hinge{}", i), "continuous", "world", "door", {0, 0, 0.5 * i}, {0, 0, 0.5 * i},
                          axis({0, 0, 1}));
    return scene(links, gravity(kDown) + initial("hinge0", 0, 1));
  };
  group.add("door on two hinges", door(2), 2e-3, 0.5, coordinate_at("hinge0", 0.5, 0.5, 1e-3));
  group.add("door on four hinges", door(4), 2e-3, 0.5, coordinate_at("hinge0", 0.5, 0.5, 1e-3));
  for (const double ea : {1e4, 1e9})
    group.add(
        fmt::format("free ring of EA = {:g} N thrown", ea),
        scene(joint("free", "floating", "world", "ring") +
                  beam_along(
                      "ring",
                      "<arc to=\"1 0 1\" center=\"0 0 1\"/> <arc to=\"0 0 2\" center=\"0 0 1\"/> <arc to=\"-1 0 1\" "
                      "center=\"0 0 1\"/> <arc to=\"0 0 0\" center=\"0 0 1\"/>",
                      rod(ea, 1, 1), 16) +
                  loop_joint("weld", "fixed", "ring", "ring", Vector3::Zero(), Vector3::Zero()),
              load("ring", Vector3::Zero(), {5, 2, 0}, "t < 0.5 ? 1 : 0")),
        0.01, 2);
  group.add("portal of three stiff beams",
            scene(joint("foot", "fixed", "world", "left") + beam("left", {0, 0, 1}, rod(1e10, 1, 1), 4) +
                      joint("corner", "fixed", "left", "top", {0, 0, 1}) + beam("top", {1, 0, 0}, rod(1e10, 1, 1), 4) +
                      joint("other_corner", "fixed", "top", "right", {1, 0, 0}) +
                      beam("right", {0, 0, -1}, rod(1e10, 1, 1), 4) +
                      loop_joint("other_foot", "fixed", "world", "right", {1, 0, 0}, {0, 0, -1}),
                  load("left", {0, 0, 1}, {20, 5, 0}, "sin(5*t)")),
            0.01, 1);
  group.add_unsound("gap of 1 mm in a loop",
                    scene(hinge("foot", "world", "left", Vector3::Zero()) + bar("left", {0, 0, 1}) +
                          hinge("other_foot", "world", "right", {1, 0, 0}) + bar("right", {0, 0, 1}) +
                          loop_joint("head", "continuous", "left", "right", {0.501, 0, 1}, {-0.5, 0, 1}, about_y())),
                    2e-3, 0.5);
}

/// A pendulum whose joint "hinge" has this distance from the world's origin [m].
std::string pendulum(double distance, const std::string& link, const std::string& simulation = "") {
  return scene(hinge("hinge", "world", "arm", distance * Vector3(0.6, 0, 0.8)) + link, gravity(kDown) + simulation);
}

void add_distant(std::vector<HardCase>& cases) {
  HardGroup group(cases, "distant");
  const std::string rigid = body("arm", 1, 0.1, {0.5, 0, 0}), flexible = beam("arm", {1, 0, 0}, circle(0.005), 4),
                    finger = body("arm", 0.1, 1e-5, {0.02, 0, 0});
  const std::tuple<const char*, std::string, std::vector<double>> arms[] = {
      {"rigid pendulum", rigid, {1e3, 1e6, 1e9}},
      {"flexible pendulum", flexible, {1e3, 1e6, 1e9}},
      {"finger of 0.1 kg", finger, {2e4}}};
  for (const auto& [name, arm, distances] : arms)
    for (const double distance : distances)
      group.add(fmt::format("{} at {:g} m", name, distance), pendulum(distance, arm), 2e-3, 0.5,
                coordinate_by_run("hinge", pendulum(0, arm), 2e-3, 1, 1e-3));
  for (const double distance : {1e3, 1e6, 1e9})
    group.add_free(
        fmt::format("free beam turns at {:g} m", distance),
        scene(joint("free", "floating", "world", "beam", {distance, 0, 0}) + beam("beam", {1, 0, 0}, circle(0.01), 4),
              initial_field("beam", Vector3::Zero(), {1, 2, 10})),
        2e-3, 0.5);
  group.add_free("free beam at 1e6 m/s",
                 scene(joint("free", "floating", "world", "beam") + beam("beam", {1, 0, 0}, circle(0.01), 4),
                       initial_field("beam", {1e6, 0, 0}, {1, 2, 10})),
                 2e-3, 0.5);
}

void add_scales(std::vector<HardCase>& cases) {
  HardGroup group(cases, "scale");
  const auto cantilever = [](double length, const std::string& section, double force) {
    return scene(joint("clamp", "fixed", "world", "beam") + beam("beam", {length, 0, 0}, section, 8),
                 load("beam", {length, 0, 0}, {0, 0, force}) + probe("beam", {length, 0, 0}));
  };
  group.add("silicon beam of 0.1 mm", cantilever(1e-4, circle(1e-6, 1.7e11, 2330), 1e-5), 1e-7, 2e-5,
            probe_by_step(2.5e-8, 1e-4, 0.02));
  group.add_free(
      "tether of 100 km, turning",
      scene(joint("free", "floating", "world", "tether") + beam("tether", {1e5, 0, 0}, circle(1e-3, 1e11, 1500), 10),
            initial_field("tether", Vector3::Zero(), {0, 0.002, 0.001})),
      1, 200);
  for (const double step : {1e-6, 1e-9})
    group.add("steps of " + fmt::format("{:g}", step) + " s", cantilever(1, circle(0.01), 100), step, 200 * step);
  group.add("pendulum, 1e6 steps", pendulum(0, body("arm", 1, 0.1, {0.5, 0, 0})), 1e-5, 10,
            coordinate_by_run("hinge", "", 1e-4, 1, 1e-3));
}

}  // namespace

void add_mechanism_cases(std::vector<HardCase>& cases) {
  add_mass_ratios(cases);
  add_massless(cases);
  add_dead_points(cases);
  add_loops(cases);
  add_distant(cases);
  add_scales(cases);
}

}  // namespace flexarm::bench
