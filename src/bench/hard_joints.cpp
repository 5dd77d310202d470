// Hard cases of single joints: couplings, stops, friction, efforts.
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

std::string couple(const std::string& attributes) {
  return "<couple " + attributes + "/> ";
}

void add_couplings(std::vector<HardCase>& cases) {
  HardGroup group(cases, "screw");
  constexpr double kInertia = 0.01;  // kg m^2; the mass is 1 kg, and a torque of 1 N m acts for 1 s
  for (const double pitch : {1e-6, 1e-3, 1.0, 1e3}) {
    const double angle = 0.5 / (kInertia + pitch * pitch);
    group.add(fmt::format("pitch {:g} m/rad", pitch),
              scene(joint("screw", "floating", "world", "nut", Vector3::Zero(),
                          axis({0, 0, 1}) + couple(fmt::format("kind=\"screw\" pitch=\"{}\"", pitch))) +
                        body("nut", 1, kInertia),
                    effort("screw", "1")),
              1e-3, 1, coordinate_at("screw", angle, angle, 0.01));
  }
  for (const double pitch : {1e-3, 1.0})
    group.add(
        fmt::format("on a beam, pitch {:g} m/rad", pitch),
        scene(joint("clamp", "fixed", "world", "rod") + beam("rod", {10, 0, 0}, circle(0.05), 20) +
                  joint("screw", "floating", "rod", "nut", Vector3::Zero(),
                        axis({1, 0, 0}) + fmt::format("<slide start=\"1\" rotation=\"screw\" pitch=\"{}\"/>", pitch)) +
                  body("nut", 1, kInertia),
              gravity(kDown) + effort("screw/1", "1")),
        0.01, 1);
  group.add("worm of ratio 1e-6",
            scene(joint("worm", "floating", "world", "wheel", Vector3::Zero(),
                        axis({0, 0, 1}) + "<axis2 xyz=\"1 0 0\"/> " + couple("kind=\"worm\" ratio=\"1e-6\"")) +
                      body("wheel", 1, kInertia),
                  effort("worm", "1")),
            1e-3, 1, coordinate_at("worm", 50, 50, 0.01));
  group.add("cam with a steep flank, 10 turns/s",
            scene(joint("cam", "floating", "world", "follower", Vector3::Zero(),
                        axis({0, 0, 1}) +
                            "<couple kind=\"cam\" direction=\"1 0 0\"> <profile kind=\"table\" theta=\"0 1 1.02 3 5\" "
                            "r=\"0 0 0.02 0.02 0\"/> </couple>") +
                      body("follower", 1, kInertia),
                  initial("cam", 0, 62.8)),
            1e-3, 0.5);
}

std::string limits(double lower, double upper, double effort = 0) {
  return fmt::format("<limit lower=\"{}\" upper=\"{}\" effort=\"{}\" velocity=\"0\"/> ", lower, upper, effort);
}

/// Measures how far a stop gives way, relative to a tenth of the range.
Bound stop_holds(const std::string& coordinate, double lower, double upper) {
  return {"stop gives way by a tenth of the range", [=](const Simulation& s) {
            const double q = position_of(s, coordinate);
            return std::max(q - upper, lower - q) / (0.1 * (upper - lower));
          }};
}

/// Stops against which gravity or an effort presses.
void add_pressed_stops(HardGroup& group) {
  const auto falling = [](double lower, double upper, double start, const std::string& simulation) {
    return scene(joint("rail", "prismatic", "world", "ball", Vector3::Zero(), axis({0, 0, 1}) + limits(lower, upper)) +
                     body("ball", 1, 0.01),
                 gravity(kDown) + initial("rail", start, 0) + simulation);
  };
  HardCase& zeno = group.add("ball bounces until it rests (Zeno)", falling(0, 2, 1, ""), 1e-3, 5);
  zeno.target = coordinate_at("rail", 0, 1, 0.01);
  zeno.bound = stop_holds("rail", 0, 2);
  group.add("gap of 1e-6 m between two stops", falling(-1e-6, 1e-6, 0, ""), 1e-3, 1);
  group.add_bounded("pressed against its stop by 1 MN", falling(0, 2, 0, effort("rail", "-1e6*min(10*t, 1)")), 1e-3, 1,
                    stop_holds("rail", 0, 2));
  group.add_bounded(
      "arm at its stop grows from 0.1 to 3 m",
      scene(joint("hinge", "revolute", "world", "sleeve", Vector3::Zero(), axis({0, 1, 0}) + limits(-0.5, 0.5)) +
                body("sleeve", 0.1, 1e-3) +
                joint("boom", "prismatic", "sleeve", "weight", Vector3::Zero(), axis({1, 0, 0}) + limits(0, 5)) +
                body("weight", 10, 0.01),
            gravity(kDown) + motion("boom", "0.1 + 1.45*(1 - cos(_pi*min(t, 2)/2))")),
      1e-3, 3, stop_holds("hinge", -0.5, 0.5));
}

void add_stops(std::vector<HardCase>& cases) {
  HardGroup group(cases, "stop");
  for (const double rate : {1.0, 10.0, 100.0, 1000.0})
    group.add_bounded(
        fmt::format("arm hits its stop at {:g} rad/s", rate),
        scene(joint("hinge", "revolute", "world", "arm", Vector3::Zero(), axis({0, 1, 0}) + limits(-0.5, 0.5)) +
                  body("arm", 1, 0.1, {0.5, 0, 0}),
              initial("hinge", 0, rate)),
        1e-3, 1, stop_holds("hinge", -0.5, 0.5));
  group.add_bounded(
      "arm between stops 1 mrad apart, 200 rad/s, steps of 10 ms",
      scene(joint("hinge", "revolute", "world", "arm", Vector3::Zero(), axis({0, 1, 0}) + limits(-5e-4, 5e-4)) +
                body("arm", 1, 0.1, {0.5, 0, 0}),
            initial("hinge", 0, 200)),
      1e-2, 0.2, stop_holds("hinge", -5e-4, 5e-4));
  group.add_bounded(
      "beam hits its stop at 20 rad/s",
      scene(joint("hinge", "revolute", "world", "arm", Vector3::Zero(), axis({0, 1, 0}) + limits(-0.5, 0.5)) +
                beam("arm", {1, 0, 0}, circle(0.01), 8),
            initial("hinge", 0, 20)),
      1e-3, 0.5, stop_holds("hinge", -0.5, 0.5));
  for (const double speed : {0.1, 10.0, 1000.0})
    group.add_bounded(
        fmt::format("carriage hits its stop at {:g} m/s", speed),
        scene(joint("rail", "prismatic", "world", "carriage", Vector3::Zero(), axis({1, 0, 0}) + limits(-0.5, 0.5)) +
                  body("carriage", 1, 0.01),
              initial("rail", 0, speed)),
        1e-3, std::max(1.0, 1 / speed), stop_holds("rail", -0.5, 0.5));
  add_pressed_stops(group);
}

std::string friction(const std::string& law, double effort, double coefficient = 0) {
  return fmt::format("<dynamics damping=\"0\" friction=\"{}\"/> <friction law=\"{}\" coefficient=\"{}\"/> ", effort,
                     law, coefficient);
}

/// A block of 1 kg that is dragged over the floor by a leaf spring whose other end moves at a constant speed.
std::string dragged_block(const std::string& law, double speed) {
  return scene(joint("drive", "prismatic", "world", "hand", {0, 0, 1}, axis({1, 0, 0}) + limits(-1e3, 1e3)) +
                   body("hand", 0.1, 1e-4) + joint("grip", "fixed", "hand", "leaf") +
                   beam("leaf", {0, 0, -1}, circle(0.003), 4) + joint("foot", "fixed", "leaf", "block", {0, 0, -1}) +
                   body("block", 1, 0.01) +
                   loop_joint("floor", "prismatic", "world", "leaf", Vector3::Zero(), {0, 0, -1},
                              axis({1, 0, 0}) + limits(-1e3, 1e3) + friction(law, 1)),
               motion("drive", fmt::format("{}*t*t/(0.1 + t)", speed)));
}

void add_friction(std::vector<HardCase>& cases) {
  HardGroup group(cases, "friction");
  for (const std::string law : {"smooth", "coulomb"})
    for (const double speed : {1e-6, 1e-3, 1.0})
      group.add(fmt::format("stick-slip at {:g} m/s, {}", speed, law), dragged_block(law, speed), 0.01, 5);
  // A block on a slope of 30 degrees.
  const double slope = kPi / 6, along = kGravity * std::sin(slope), across = kGravity * std::cos(slope);
  for (const double coefficient : {0.3, 0.6}) {
    const double acceleration = std::max(0.0, along - coefficient * across);
    group.add(fmt::format("block on a slope, coefficient {:g}", coefficient),
              scene(joint("slope", "prismatic", "world", "block", Vector3::Zero(),
                          axis({std::cos(slope), 0, -std::sin(slope)}) + limits(-100, 100) +
                              friction("coulomb", 0, coefficient)) +
                        body("block", 1, 0.01),
                    gravity(kDown)),
              0.01, 1, coordinate_at("slope", acceleration / 2, along / 2, 0.01));
  }
  for (const std::string law : {"smooth", "coulomb"})
    group.add(
        "friction of 1e12 N m on a turning arm, " + law,
        scene(joint("hinge", "continuous", "world", "arm", Vector3::Zero(), axis({0, 0, 1}) + friction(law, 1e12)) +
                  body("arm", 1, 0.1),
              initial("hinge", 0, 10)),
        0.01, 0.5, coordinate_at("hinge", 0, 0.1, 1));
}

void add_efforts(std::vector<HardCase>& cases) {
  HardGroup group(cases, "effort");
  const auto carriage = [](const std::string& history) {
    return scene(
        joint("rail", "prismatic", "world", "carriage", Vector3::Zero(), axis({1, 0, 0}) + limits(-1e12, 1e12)) +
            body("carriage", 1, 0.01),
        effort("rail", history));
  };
  group.add("1e12 N on 1 kg for a step, then none", carriage("t < 0.0015 ? 1e12 : 0"), 1e-3, 0.1);
  const auto arm = [](const std::string& links, const std::string& history) {
    return scene(joint("hinge", "continuous", "world", "arm", Vector3::Zero(), axis({0, 1, 0})) + links,
                 effort("hinge", history));
  };
  for (const double torque : {1e6, 1e12})
    group.add(fmt::format("{:g} N m on 0.1 kg m^2 for a step, then none", torque),
              arm(body("arm", 1, 0.1), fmt::format("t < 0.0015 ? {} : 0", torque)), 1e-3, 0.1);
  for (const double torque : {1e3, 1e4, 1e5})
    group.add(fmt::format("{:g} N m on a beam for a step, then none", torque),
              arm(beam("arm", {1, 0, 0}, circle(0.01), 8), fmt::format("t < 0.0015 ? {} : 0", torque)), 1e-3, 0.1);
  group.add("joint damping of 1e9",
            scene(joint("hinge", "continuous", "world", "arm", Vector3::Zero(),
                        axis({0, 1, 0}) + "<dynamics damping=\"1e9\" friction=\"0\"/>") +
                      beam("arm", {1, 0, 0}, circle(0.01), 8),
                  gravity(kDown)),
            1e-3, 0.2);
  for (const double time : {1.0, 1e3})
    group.add(fmt::format("structural damping of {:g} s", time),
              scene(joint("clamp", "fixed", "world", "arm") +
                        beam("arm", {1, 0, 0}, circle(0.01), 8,
                             fmt::format("<damping stiffness_proportional=\"{}\"/>", time)),
                    gravity(kDown)),
              0.01, 1);
}

/// Angular acceleration with which the faster of two coupled wheels turns by 0.1 rad in the last step.
double gentle(double ratio, double step, double until) {
  return 0.1 / (std::max(ratio, 1.0) * until * step);
}

void add_mimics(std::vector<HardCase>& cases) {
  HardGroup group(cases, "mimic");
  constexpr double kStep = 1e-3, kUntil = 0.1;
  const Vector3 up(0, 0, 1);
  for (const double ratio : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const double acceleration = gentle(ratio, kStep, kUntil), angle = acceleration * kUntil * kUntil / 2;
    group.add(fmt::format("ratio {:g}", ratio),
              scene(joint("slow", "continuous", "world", "arm", Vector3::Zero(), axis(up)) + body("arm", 1, 1) +
                        joint("fast", "continuous", "world", "hand", {1, 0, 0},
                              axis(up) + fmt::format("<mimic joint=\"slow\" multiplier=\"{}\"/>", ratio)) +
                        body("hand", 1, 1),
                    effort("slow", fmt::format("{}", acceleration * (1 + ratio * ratio)))),
              kStep, kUntil, coordinate_at("slow", angle, angle, 0.01));
  }
  std::string train = joint("gear0", "continuous", "world", "wheel0", Vector3::Zero(), axis(up)) + body("wheel0", 1, 1);
  double inertia = 1, ratio = 1;
  for (int i = 1; i < 5; ++i) {
    train += joint(fmt::format("gear{}", i), "continuous", "world", fmt::format("wheel{}", i), Vector3(i, 0, 0),
                   axis(up) + fmt::format("<mimic joint=\"gear{}\" multiplier=\"-10\" offset=\"0.1\"/>", i - 1)) +
             body(fmt::format("wheel{}", i), 1, 1);
    ratio *= 10;
    inertia += ratio * ratio;
  }
  const double acceleration = gentle(ratio, kStep, kUntil), angle = acceleration * kUntil * kUntil / 2;
  group.add("train of four gears of ratio 10",
            scene(train, effort("gear0", fmt::format("{:g}", acceleration * inertia))), kStep, kUntil,
            coordinate_at("gear0", angle, angle, 0.01));
}

}  // namespace

void add_joint_cases(std::vector<HardCase>& cases) {
  add_couplings(cases);
  add_stops(cases);
  add_friction(cases);
  add_efforts(cases);
  add_mimics(cases);
}

}  // namespace flexarm::bench
