// Hard cases of fast and sudden motions: spins, whips, snap-through.
#include <cmath>

#include <fmt/format.h>

#include "bench/hard_group.h"
#include "bench/urdf.h"
#include "math/pi.h"

namespace flexarm::bench {
namespace {

using namespace urdf;

/// Position over time with a smooth start: after `ramp` seconds the rate is constant. Rate and acceleration are
/// continuous.
std::string spun_up(double rate, double ramp) {
  return fmt::format("t < {1} ? {0}/2*(t - {1}/_pi*sin(_pi*t/{1})) : {0}*(t - {1}/2)", rate, ramp);
}

void add_spun_hubs(HardGroup& group) {
  const std::pair<const char*, Vector3> axes[] = {
      {"across it", {0, 0, 1}}, {"along it", {1, 0, 0}}, {"oblique", {1, 1, 1}}};
  for (const auto& [name, direction] : axes)
    for (const double turns : {1.0, 20.0, 100.0})
      group.add(fmt::format("beam spun up to {:g} turns/s, {}", turns, name),
                scene(joint("hub", "continuous", "world", "beam", Vector3::Zero(), axis(direction)) +
                          beam("beam", {1, 0, 0}, circle(0.02), 8),
                      motion("hub", spun_up(2 * kPi * turns, 0.2)) + probe("beam", {1, 0, 0})),
                1e-3, 0.4, probe_by_step(2.5e-4, 1, 0.05));
}

void add_free_spins(HardGroup& group) {
  const auto spinning_beam = [](const std::string& root, double turns, const Vector3& direction) {
    return scene(joint("root", root, "world", "beam", Vector3::Zero(), axis({0, 0, 1})) +
                     beam("beam", {1, 0, 0}, circle(0.01), 8),
                 initial_field("beam", Vector3::Zero(), 2 * kPi * turns * direction));
  };
  group.add("hinged beam at 20 turns/s, steps of 0.02 s", spinning_beam("continuous", 20, {0, 0, 1}), 0.02, 1);
  for (const double step : {1e-3, 0.02}) {
    group.add_free(fmt::format("free beam at 20 turns/s, steps of {:g} s", step),
                   spinning_beam("floating", 20, {0, 0, 1}), step, 200 * step);
    group.add_free(fmt::format("free beam at 20 turns/s, oblique, steps of {:g} s", step),
                   spinning_beam("floating", 20, {0.6, 0, 0.8}), step, 200 * step);
  }
  group.add_free("free beam at 100 turns/s", spinning_beam("floating", 100, {0, 0, 1}), 1e-3, 0.2);
  for (const double turns : {1.0, 100.0}) {
    const std::string top =
        scene(joint("free", "floating", "world", "top") + body("top", 1, Vector3(0.01, 0.02, 0.025)),
              initial_field("top", Vector3::Zero(), 2 * kPi * turns * Vector3(1e-3, 1, 1e-3)));
    for (const double step : {1e-3, 0.01})
      group.add_free(fmt::format("free body about its middle axis, {:g} turns/s, steps of {:g} s", turns, step), top,
                     step, 500 * step);
  }
  group.add("top on its point at 100 turns/s",
            scene(joint("point", "floating", "world", "top", Vector3::Zero(), "<release kind=\"spherical\"/>") +
                      body("top", 1, Vector3(0.001, 0.001, 0.002), {0, 0, 0.1}),
                  gravity({0, 0, -9.81}) + initial("point/rx", 0.3, 0) + initial("point/rz", 0, 628)),
            1e-3, 1);
  group.add_free("needle of inertia 1e-12 at 100 turns/s",
                 scene(joint("free", "floating", "world", "needle") + body("needle", 1e-3, Vector3(1e-12, 1e-6, 1e-6)),
                       initial_field("needle", Vector3::Zero(), {628, 0.1, 0})),
                 1e-3, 1);
}

const std::string kHinge = joint("hinge", "continuous", "world", "arm", Vector3::Zero(), axis({0, 0, 1}));
const std::string kArm = body("arm", 1, 0.1, {0.5, 0, 0});
constexpr double kTurnStep = 0.01;

void add_free_turns(HardGroup& group) {
  for (const double angle : {0.1, 1.0, 3.0, 2 * kPi}) {
    const double rate = angle / kTurnStep;
    group.add(fmt::format("free hinge, {:.3g} rad a step", angle), scene(kHinge + kArm, initial("hinge", 0, rate)),
              kTurnStep, 1, coordinate_at("hinge", rate, rate, 0.05));
  }
}

/// A joint is brought to a constant rate within half a second; the published velocity must be this rate.
void add_driven_turns(HardGroup& group) {
  const auto drive = [&](const std::string& what, const std::string& links, const std::string& simulation,
                         const std::string& driven, double angle) {
    const double rate = angle / kTurnStep, ramp = 0.5;
    group.add_bounded(fmt::format("driven {}, {:.3g} rad a step", what, angle),
                      scene(links, simulation + motion(driven, spun_up(rate, ramp))), kTurnStep, 1,
                      Bound{"published velocity off by 5 %", [=](const Simulation& s) {
                              const double t = s.time(),
                                           expected = t < ramp ? rate / 2 * (1 - std::cos(kPi * t / ramp)) : rate;
                              return std::abs(s.velocity(*s.find_coordinate(driven)) - expected) / (0.05 * rate);
                            }});
  };
  const std::string elbow =
      joint("elbow", "continuous", "arm", "hand", {1, 0, 0}, axis({0, 1, 0})) + body("hand", 0.1, 1e-3);
  for (const double angle : {kPi / 2, kPi, 6.0, 2 * kPi, 3 * kPi}) {
    drive("body", kHinge + kArm, "", "hinge", angle);
    drive("beam", kHinge + beam("arm", {1, 0, 0}, circle(0.01), 8), "", "hinge", angle);
    drive("elbow of a swinging arm", kHinge + kArm + elbow, initial("hinge", 0, 1), "elbow", angle);
  }
}

void add_spins(std::vector<HardCase>& cases) {
  HardGroup group(cases, "spin");
  add_spun_hubs(group);
  add_free_spins(group);
  add_free_turns(group);
  add_driven_turns(group);
}

/// A whip of five pieces, each thinner than the one before; its handle swings to and fro.
std::string tapered_whip(int elements, const std::string& damping = "") {
  std::string links = joint("handle", "continuous", "world", "piece0", Vector3::Zero(), axis({0, 1, 0}));
  const double radii[] = {0.01, 0.006, 0.004, 0.002, 0.001};
  for (int i = 0; i < 5; ++i) {
    links += beam(fmt::format("piece{}", i), {0.4, 0, 0}, circle(radii[i], 1e8, 900), elements, damping);
    if (i > 0)
      links += joint(fmt::format("splice{}", i), "fixed", fmt::format("piece{}", i - 1), fmt::format("piece{}", i),
                     {0.4, 0, 0});
  }
  return scene(links, motion("handle", "t < 0.3 ? 1 - cos(2*_pi*t/0.3) : 0"));
}

/// A thin beam that is stretched by a heavy ball and whipped by a force at its middle.
std::string stretched_whip(const std::string& pull) {
  return scene(joint("root", "floating", "world", "beam", Vector3::Zero(), "<release kind=\"spherical\"/>") +
                   beam("beam", {1, 0, 0},
                        "<section ea=\"1e5\" ga2=\"4e4\" ga3=\"4e4\" gj=\"0.08\" ei2=\"0.1\" ei3=\"0.1\" mass=\"0.1\" "
                        "j1=\"2e-7\" j2=\"1e-7\" j3=\"1e-7\"/>",
                        8) +
                   joint("tip", "fixed", "beam", "ball", {1, 0, 0}) + body("ball", 1, 1e-3),
               load("ball", Vector3::Zero(), {500, 0, 0}, pull) +
                   load("beam", {0.5, 0, 0}, {0, 60, 40}, "0:0 0.1:0 0.15:1 0.25:0"));
}

void add_whips(std::vector<HardCase>& cases) {
  HardGroup group(cases, "whip");
  // Four elements per piece are far too few: the last elements are wound up by more than two turns each.
  const std::string damping = "<damping stiffness_proportional=\"1e-3\"/>";
  for (const double step : {2e-3, 5e-4}) {
    const std::string name = fmt::format("tapered, four elements a piece, steps of {:g} s", step);
    group.add_unsound(name, tapered_whip(4), step, 0.6);
    group.add(name + ", refined", refined(tapered_whip(4)), step, 0.6);
  }
  group.add_unsound("tapered, four elements a piece, damped", tapered_whip(4, damping), 2e-3, 0.6);
  group.add("tapered, four elements a piece, damped, refined", refined(tapered_whip(4, damping)), 2e-3, 0.6);
  group.add("tapered, 16 elements a piece, through its crack", tapered_whip(16), 5e-4, 0.25);
  group.add("tapered, four elements a piece, through its crack, refined", refined(tapered_whip(4)), 5e-4, 0.25);
  group.add("tapered, 12 elements a piece, damped", tapered_whip(12, damping), 2e-3, 0.6);
  for (const double step : {0.003, 0.007, 0.014}) {
    group.add(fmt::format("released, steps of {:g} s", step), stretched_whip("0:0 0.05:1 0.3:1 0.31:0"), step, 1);
    group.add(fmt::format("pulled again, steps of {:g} s", step), stretched_whip("0:0 0.05:1 0.3:1 0.31:0 0.5:0 0.6:1"),
              step, 1);
  }
  const std::string root =
      joint("root", "floating", "world", "thread", Vector3::Zero(), "<release kind=\"spherical\"/>");
  for (const double radius : {1e-3, 1e-4})
    group.add(fmt::format("thread of radius {:g} m falls", radius),
              scene(root + beam("thread", {1, 0, 0}, circle(radius), 20), gravity({0, 0, -9.81})), 2e-3, 0.6);
  group.add("thread with 1 kg at its end falls",
            scene(root + beam("thread", {1, 0, 0}, circle(1e-3), 20) +
                      joint("knot", "fixed", "thread", "ball", {1, 0, 0}) + body("ball", 1, 1e-3),
                  gravity({0, 0, -9.81})),
            2e-3, 1);
  for (const double step : {0.1, 0.5})
    group.add(
        fmt::format("flying spaghetti, steps of {:g} s", step),
        scene(joint("free", "floating", "world", "beam") +
                  beam("beam", {6, 0, 8},
                       "<section ea=\"1e4\" ga2=\"1e4\" ga3=\"1e4\" gj=\"500\" ei2=\"500\" ei3=\"500\" mass=\"1\" "
                       "j1=\"20\" j2=\"10\" j3=\"10\"/>",
                       10),
              load("beam", Vector3::Zero(), {8, 0, 0}, "t < 2.5 ? 1 : 0") +
                  moment("beam", Vector3::Zero(), {0, 80, -200}, "t < 2.5 ? 1 : 0")),
        step, 15);
}

/// Two hinged beams that lean against each other, 0.05 m high over a span of 2 m, pushed down at the apex.
std::string shallow_truss(double force) {
  const std::string about_y = axis({0, 1, 0});
  return scene(joint("left_foot", "continuous", "world", "left", Vector3::Zero(), about_y) +
                   joint("right_foot", "continuous", "world", "right", {2, 0, 0}, about_y) +
                   beam("left", {1, 0, 0.05}, rod(1e5, 10, 1), 4) + beam("right", {-1, 0, 0.05}, rod(1e5, 10, 1), 4) +
                   loop_joint("apex", "continuous", "left", "right", {1, 0, 0.05}, {-1, 0, 0.05}, about_y),
               load("left", {1, 0, 0.05}, {0, 0, -force}, "min(t, 1)") + probe("left", {1, 0, 0.05}));
}

/// An arc of a circle with radius 2.6 m and length 2 m, clamped at both ends, pushed down beside its crown.
std::string shallow_arch(double force) {
  return scene(joint("foot", "fixed", "world", "arch") +
                   beam_along("arch", "<arc to=\"2 0 0\" center=\"1 0 -2.4\"/>", rod(1e5, 10, 1), 8) +
                   loop_joint("other_foot", "fixed", "world", "arch", {2, 0, 0}, {2, 0, 0}),
               load("arch", {1, 0, 0.2}, {0, 0.001 * force, -force}, "min(t, 1)"));
}

/// A strip on edge, pushed down at its tip by `ratio` times the load for lateral buckling.
std::string strip_on_edge(double ratio) {
  constexpr double kStiff = 1e4, kSoft = 1, kTorsion = 1;
  const double critical = 4.013 * std::sqrt(kSoft * kTorsion);  // Prandtl 1899, for a tall strip
  return scene(joint("clamp", "fixed", "world", "strip") +
                   beam("strip", {1, 0, 0},
                        fmt::format("<section ea=\"1e7\" ga2=\"4e6\" ga3=\"4e6\" gj=\"{}\" ei2=\"{}\" ei3=\"{}\" "
                                    "mass=\"1\" j1=\"1e-3\" j2=\"1e-3\" j3=\"1e-7\"/>",
                                    kTorsion, kStiff, kSoft),
                        8),
               load("strip", {1, 0, 0}, {0, 1e-3 * critical, -ratio * critical}, "min(t, 1)"));
}

void add_snaps(std::vector<HardCase>& cases) {
  HardGroup group(cases, "snap-through");
  for (const double force : {20.0, 200.0, 2000.0})
    group.add(fmt::format("shallow truss, {:g} N", force), shallow_truss(force), 0.005, 1.5);
  for (const double force : {100.0, 1000.0, 1e4})
    group.add(fmt::format("clamped arch, {:g} N", force), shallow_arch(force), 0.005, 1.5);
  for (const double ratio : {0.8, 1.5, 5.0, 50.0})
    group.add(fmt::format("strip on edge, {:g} times its lateral buckling load", ratio), strip_on_edge(ratio), 0.01, 3);
  group.add("beam buckled by its moving end, then thrown over",
            scene(joint("foot", "fixed", "world", "beam") + beam("beam", {1, 0, 0}, rod(1e5, 1, 1), 8) +
                      loop_joint("end", "prismatic", "world", "beam", {1, 0, 0}, {1, 0, 0},
                                 axis({1, 0, 0}) + "<limit lower=\"-1\" upper=\"1\" effort=\"0\" velocity=\"0\"/>"),
                  motion("end", "-0.05*(t < 1 ? (1 - cos(_pi*t))/2 : 1)") +
                      load("beam", {0.5, 0, 0}, {0, 0, 1}, "0:0 0.1:1 0.5:1 1:0 1.5:0 2:-60 2.5:0")),
            0.01, 3);
}

}  // namespace

void add_motion_cases(std::vector<HardCase>& cases) {
  add_spins(cases);
  add_whips(cases);
  add_snaps(cases);
}

}  // namespace flexarm::bench
