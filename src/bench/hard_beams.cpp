// Hard cases of single beams: stiffness, slenderness, steps, loads.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/hard_group.h"
#include "bench/urdf.h"
#include "math/pi.h"

namespace flexarm::bench {
namespace {

using namespace urdf;

const Vector3 kTip = Vector3::UnitX();
/// Period of the first bending mode of a cantilever with EI = mass per length = length = 1 [s].
constexpr double kPeriod = 2 * kPi / 3.516015;
/// Euler load of this cantilever [N].
constexpr double kEulerLoad = kPi * kPi / 4;

/// A cantilever along x from the world's origin, 1 m, 8 elements.
std::string cantilever(const std::string& section, const std::string& simulation, const std::string& damping = "") {
  return scene(joint("clamp", "fixed", "world", "beam") + beam("beam", kTip, section, 8, damping),
               simulation + probe("beam", kTip));
}

std::string unit_cantilever(double ea, const std::string& simulation) {
  return cantilever(rod(ea, 1, 1), simulation);
}

std::string exponent(double value) {
  return fmt::format("1e{:.0f}", std::log10(value));
}

void add_stiffness_ratios(std::vector<HardCase>& cases) {
  HardGroup group(cases, "stiffness ratio");
  for (const double ratio : {1e1, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12})
    group.add("EA L^2/EI = " + exponent(ratio), unit_cantilever(ratio, load("beam", kTip, {0, 0, 1})), 0.02, 1,
              probe_by_step(0.005, 1, 0.02));
  for (const double ratio : {1e-6, 1e-3, 1e3, 1e6}) {
    const std::string section = fmt::format(
        "<section ea=\"1e5\" ga2=\"4e4\" ga3=\"4e4\" gj=\"{}\" ei2=\"1\" ei3=\"1\" mass=\"1\" j1=\"2e-5\" j2=\"1e-5\" "
        "j3=\"1e-5\"/>",
        ratio);
    group.add("GJ/EI = " + exponent(ratio),
              cantilever(section,
                         load("beam", kTip, {0, 0, 1}) + moment("beam", kTip, {std::min(0.5 * ratio, 1.0), 0, 0}, "t")),
              0.02, 1);
  }
  for (const double ratio : {1e-4, 1e4}) {
    const std::string section = fmt::format(
        "<section ea=\"1e8\" ga2=\"{0}\" ga3=\"{0}\" gj=\"1\" ei2=\"1\" ei3=\"1\" mass=\"1\" j1=\"2e-6\" j2=\"1e-6\" "
        "j3=\"1e-6\"/>",
        1e8 * ratio);
    group.add("GA/EA = " + exponent(ratio), cantilever(section, load("beam", kTip, {0, 1, 1})), 0.02, 1,
              probe_by_step(0.005, 1, 0.02));
  }
}

void add_slenderness(std::vector<HardCase>& cases) {
  HardGroup group(cases, "slenderness");
  const auto rod_that_falls = [](const std::string& section, const std::string& damping) {
    return scene(joint("clamp", "fixed", "world", "beam") + beam("beam", kTip, section, 10, damping),
                 gravity({0, 0, -9.81}) + probe("beam", kTip));
  };
  for (const double slenderness : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6})
    group.add("L/r = " + exponent(slenderness) + ", falls", rod_that_falls(circle(1 / slenderness), ""), 0.005, 1);
  for (const double slenderness : {1e3, 1e5})
    group.add("L/r = " + exponent(slenderness) + ", damped, falls",
              rod_that_falls(circle(1 / slenderness), "<damping stiffness_proportional=\"1e-3\"/>"), 0.005, 1);
  for (const double ratio : {1e1, 1e2, 1e3, 1e4}) {
    const std::string strip = fmt::format(
        "<rectangle width=\"0.1\" height=\"{}\"/> <material young=\"2e11\" poisson=\"0.3\" density=\"7800\"/>",
        0.1 / ratio);
    group.add("strip of aspect ratio " + exponent(ratio) + ", falls", rod_that_falls(strip, ""), 0.005, 0.5);
  }
}

void add_long_steps(std::vector<HardCase>& cases) {
  HardGroup group(cases, "long steps");
  for (const double force : {1.0, 10.0})
    for (const double periods : {0.05, 0.25, 1.0, 5.0, 20.0})
      group.add(fmt::format("tip force {:g} EI/L^2, step of {:g} periods", force, periods),
                unit_cantilever(1e5, load("beam", kTip, {0, 0, force})), periods * kPeriod, 30 * periods * kPeriod);
}

/// Beck's column: a follower force of the magnitude `force` EI/L^2, and a small pulse. From 20.05 on, the column
/// flutters.
void add_beck(HardGroup& group, double force) {
  constexpr double kFlutterLoad = 20.05, kPulse = 1e-3;  // EI/L^2; N s
  constexpr double kPulseEnergy =
      5 * kPulse * kPulse / (2 * 0.25);  // at the tip, the modal mass of each mode is a quarter of the beam's mass
  HardCase& hard = group.add(fmt::format("Beck's column, P = {:g} EI/L^2", force),
                             unit_cantilever(1e5, load("beam", kTip, {-force, 0, 0}, "1", "follower") +
                                                      load("beam", kTip, {0, 0, 10 * kPulse}, "0:1 0.095:1 0.105:0")),
                             0.01, 10);
  const double end = hard.until - hard.step / 2;
  if (force < kFlutterLoad)
    hard.bound = Bound{"deflection above a tenth of the length",
                       [](const Simulation& s) { return std::abs(s.probe(0).pose.position.z()) / 0.1; }};
  else
    hard.bound = Bound{"does not flutter: at the end less than a hundred times the energy of the first pulse",
                       [end](const Simulation& s) {
                         const Energies e = s.energies();
                         return s.time() < end ? 0 : 100 * kPulseEnergy / (e.kinetic + e.strain);
                       }};
}

void add_columns(std::vector<HardCase>& cases) {
  HardGroup group(cases, "column");
  const auto column = [](double load_ratio, double lateral) {
    const double force = load_ratio * kEulerLoad;
    return unit_cantilever(1e5, load("beam", kTip, {-force, 0, lateral * force}));
  };
  for (const double ratio : {0.9, 1.1, 2.0, 5.0, 20.0, 100.0})
    group.add(fmt::format("hit by {:g} times its Euler load", ratio), column(ratio, 1e-3), 0.005, 1);
  group.add("hit by 100 times its Euler load, steps of 0.5 ms", column(100, 1e-3), 5e-4, 0.5);
  group.add("hit by 5 times its Euler load, lateral force 1e-9 of it", column(5, 1e-9), 0.005, 2);
  for (const double force : {18.0, 19.5, 21.0, 25.0, 100.0}) add_beck(group, force);
}

void add_blows(std::vector<HardCase>& cases) {
  HardGroup group(cases, "blow");
  for (const double force : {1e3, 1e4, 1e5}) {
    const std::string pulse = cantilever(rod(1e7, 0.1, 0.1), load("beam", kTip, {0, 0, force}, "t < 0.0015 ? 1 : 0"));
    group.add(fmt::format("pulse of one step, {:g} N on 0.1 kg", force), pulse, 1e-3, 0.1);
    group.add(fmt::format("pulse of one step, {:g} N on 0.1 kg, refined", force), refined(pulse), 1e-3, 0.1);
  }
  for (const double g : {1e3, 1e4, 1e6})
    group.add("gravity of " + exponent(g) + " m/s^2", cantilever(circle(0.01), gravity({0, 0, -g})), 1e-3, 0.1);
  group.add("follower force of 1000 EI/L^2 across the tip",
            unit_cantilever(1e5, load("beam", kTip, {0, 0, 1000}, "min(t, 1)", "follower")), 0.002, 0.5);
  // Each half of an element is bent by half of this angle, and rotation vectors are singular at 2 pi.
  const auto slowly_bent = [](double bend, const std::string& damping) {
    return scene(joint("clamp", "fixed", "world", "beam") + beam("beam", kTip, rod(1e5, 1, 1), 2, damping),
                 moment("beam", kTip, {0, 2 * bend * kPi, 0}, "(1 - cos(_pi*min(t, 20)/20))/2") + probe("beam", kTip));
  };
  for (const double bend : {1.5, 1.9, 2.5, 4.5})
    group.add(fmt::format("two elements, slowly bent through {:g} pi each", bend), slowly_bent(bend, ""), 0.02, 20)
        .is_sound = bend < 4;
  // The beam becomes a circle. The error is that of elements which turn by up to a radian. Without damping, it would
  // buckle and swing.
  for (const double bend : {2.5, 4.5}) {
    const double angle = 2 * bend * kPi;
    group.add(fmt::format("two elements, slowly bent through {:g} pi each, damped, refined", bend),
              refined(slowly_bent(bend, "<damping stiffness_proportional=\"3e-3\"/>")), 0.02, 20,
              probe_at({std::sin(angle) / angle, 0, -(1 - std::cos(angle)) / angle}, 1, 0.01));
  }
  group.add("bent far, then let go",
            cantilever(rod(2e5, 2, 0.5), load("beam", kTip, {0, 6, 10}, "t < 0.5 ? sin(3.14159265*t)^2 : 0")), 0.01, 2);
}

}  // namespace

void add_beam_cases(std::vector<HardCase>& cases) {
  add_stiffness_ratios(cases);
  add_slenderness(cases);
  add_long_steps(cases);
  add_columns(cases);
  add_blows(cases);
}

}  // namespace flexarm::bench
