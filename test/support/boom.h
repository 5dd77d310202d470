#pragma once
/// A boom that a cylinder lifts, as a scene and in closed form.

#include <array>
#include <cmath>
#include <functional>

#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {

/// Barrel and rod of a cylinder; without masses by default.
struct BoomParts {
  double barrel_mass = 0, rod_mass = 0;
};
constexpr double kPartLength = 0.25, kBarrelRadius = 0.03;  // of a part with a mass; the rod is thin [m]

/// The boom turns about -y at the world's origin. Its angle is `angle` at the start. `cylinder`: children of
/// <cylinder>; `simulation`: children of <simulation>.
inline scene::SceneDescription boom_scene(double angle, const std::string& cylinder, const std::string& simulation,
                                          const BoomParts& parts = {}) {
  std::string masses;
  if (parts.barrel_mass > 0)
    masses += fmt::format("<barrel mass='{}' length='{}' radius='{}'/>", parts.barrel_mass, kPartLength, kBarrelRadius);
  if (parts.rod_mass > 0) masses += fmt::format("<rod mass='{}' length='{}'/>", parts.rod_mass, kPartLength);
  return scene_of(fmt::format(R"(<robot name='boom'>
  <link name='world'/>
  {}
  <joint name='hinge' type='continuous'><parent link='world'/><child link='boom'/><axis xyz='0 -1 0'/></joint>
  <cylinder name='lift' from='world' from_at='0.3 0 -0.3' to='boom' to_at='0.3 0 0'>{}{}</cylinder>
  <simulation><integrator scheme='em' step='1e-3'/>
    {}{}
  </simulation>
</robot>)",
                              body("boom", 10, {0.01, 1, 1}, {0.5, 0, 0}), masses, cylinder,
                              angle == 0 ? "" : fmt::format("<initial joint='hinge' position='{}'/>", angle),
                              simulation));
}

/// The same boom as a system with one degree of freedom, its angle.
struct BoomOnParts : BoomParts {
  static constexpr double kGravity = 9.81, kMass = 10, kInertia = 1, kCentre = 0.5, kArm = 0.3;

  static double derivative(const std::function<double(double)>& f, double at) {
    constexpr double h = 1e-3;  // fourth order: errors of 1e-12
    return (8 * (f(at + h) - f(at - h)) - f(at + 2 * h) + f(at - 2 * h)) / (12 * h);
  }
  static double length(double angle) {
    return std::hypot(kArm * std::cos(angle) - kArm, kArm * std::sin(angle) + kArm);
  }
  /// d length / d angle: the lever of the cylinder.
  static double lever(double angle) {
    return kArm * kArm * (std::sin(angle) + std::cos(angle)) / length(angle);  // (p x way) / length
  }
  /// Angle of the cylinder to the x axis.
  static double slope(double angle) { return std::atan2(kArm * std::sin(angle) + kArm, kArm * std::cos(angle) - kArm); }
  static double angle_at(double length) {  // law of cosines
    const double k = kArm * kArm;
    return std::acos((3 * k - length * length) / (2 * std::sqrt(2.0) * k)) - 0.25 * std::acos(-1.0);
  }

  double mass(double angle) const {
    const double turn = derivative(slope, angle), l = kPartLength, r = kBarrelRadius;
    const double barrel = barrel_mass * (l * l / 3 + r * r / 4) * turn * turn;
    const double reach = length(angle) - 0.5 * l;
    const double rod = rod_mass * (std::pow(lever(angle), 2) + (reach * reach + l * l / 12) * turn * turn);
    return kInertia + kMass * kCentre * kCentre + barrel + rod;
  }
  double potential(double angle) const {
    const double rise = std::sin(slope(angle));
    return kGravity * (kMass * kCentre * std::sin(angle) + barrel_mass * 0.5 * kPartLength * rise +
                       rod_mass * (length(angle) - 0.5 * kPartLength) * rise);
  }
  /// Force of the cylinder with which the boom moves in this way.
  double force(double angle, double rate, double acceleration) const {
    const double change = derivative([this](double a) { return mass(a); }, angle);
    const double weight = derivative([this](double a) { return potential(a); }, angle);
    return (mass(angle) * acceleration + 0.5 * change * rate * rate + weight) / lever(angle);
  }
  double acceleration(double angle, double rate, double force) const {
    return (force - this->force(angle, rate, 0)) * lever(angle) / mass(angle);
  }
};

/// Angle and rate after `end` [s], by the classical Runge-Kutta method. `force`: of the cylinder, by time, length and
/// rate of the length.
inline std::array<double, 2> boom_after(double end, const BoomOnParts& boom, double angle,
                                        const std::function<double(double, double, double)>& force) {
  using Pair = std::array<double, 2>;
  const auto rates = [&](double t, const Pair& y) -> Pair {
    const double push = force(t, boom.length(y[0]), boom.lever(y[0]) * y[1]);
    return {y[1], boom.acceleration(y[0], y[1], push)};
  };
  const auto along = [](const Pair& y, double h, const Pair& k) -> Pair { return {y[0] + h * k[0], y[1] + h * k[1]}; };
  const int steps = 2000;
  const double h = end / steps;
  Pair y{angle, 0};
  for (int n = 0; n < steps; ++n) {
    const double t = n * h;
    const Pair a = rates(t, y), b = rates(t + h / 2, along(y, h / 2, a)), c = rates(t + h / 2, along(y, h / 2, b)),
               d = rates(t + h, along(y, h, c));
    for (int i = 0; i < 2; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return y;
}

}  // namespace flexarm::test
