#pragma once
/// A loop of rigid links with one degree of freedom: its scene and its exact motion.

#include <cmath>
#include <string>

#include <Eigen/Core>

#include "support/scene_builder.h"

namespace flexarm::test {

constexpr double kCrank = 0.2, kRod = 0.5;                            // m
constexpr double kCrankMass = 1, kCrankCentre = 0.1;                  // kg, m
constexpr double kCrankInertia = 0.01 + 1 * 0.1 * 0.1;                // about the axis [kg m^2]
constexpr double kRodMass = 0.8, kRodCentre = 0.25, kRodTurn = 0.02;  // kg, m, kg m^2 about the centre
constexpr double kSlider = 1.5, kAngle = 0.7;                         // kg, rad

/// A crank that moves a slider by a rod. The pin between rod and slider closes the loop.
inline SceneBuilder slider_crank(const std::string& scheme = "auto") {
  SceneBuilder b;
  b.scene.integrator = with_scheme(b.scene.integrator, scheme);
  b.body("crank", 1, {0.1, 0, 0}, 0.01 * Matrix3::Identity());
  b.body("rod", kRodMass, {kRodCentre, 0, 0}, kRodTurn * Matrix3::Identity());
  b.body("slider", kSlider, {0, 0, 0}, 0.001 * Matrix3::Identity());
  b.joint("a", scene::JointKind::Continuous, "world", "crank");
  b.joint("b", scene::JointKind::Continuous, "crank", "rod", {kCrank, 0, 0});
  b.joint("s", scene::JointKind::Prismatic, "world", "slider", {0, 0, 0}, {1, 0, 0});
  const double rod = std::asin(-kCrank * std::sin(kAngle) / kRod);
  b.scene.initial_joints = {
      {"a", kAngle, 0, {}}, {"b", rod - kAngle, 0, {}}, {"s", kCrank * std::cos(kAngle) + kRod * std::cos(rod), 0, {}}};
  scene::JointDescription pin;
  pin.name = "pin";
  pin.kind = scene::JointKind::Continuous;
  pin.parent = "rod";
  pin.child = "slider";
  pin.origin.position = {kRod, 0, 0};
  pin.axis = {0, 0, 1};
  b.scene.loop_joints.push_back(pin);
  b.probe("pin", "slider", {0, 0, 0});
  b.probe("rod", "rod", {kRodCentre, 0, 0});
  return b;
}

/// Positions of the rod and its centre, with their first two derivatives with respect to the crank's angle a:
///   kCrank sin a + kRod sin p = 0.
struct SliderCrank {
  double p, p1, p2;
  explicit SliderCrank(double a) : a(a) {
    p = std::asin(-kCrank * std::sin(a) / kRod);
    p1 = -kCrank * std::cos(a) / (kRod * std::cos(p));
    p2 = (kCrank * std::sin(a) + kRod * std::sin(p) * p1 * p1) / (kRod * std::cos(p));
  }
  /// Position of the rod's point at the distance c from the crank's pin.
  Eigen::Vector2d point(double c) const {
    return {kCrank * std::cos(a) + c * std::cos(p), kCrank * std::sin(a) + c * std::sin(p)};
  }
  Eigen::Vector2d first(double c) const {
    return {-kCrank * std::sin(a) - c * std::sin(p) * p1, kCrank * std::cos(a) + c * std::cos(p) * p1};
  }
  Eigen::Vector2d second(double c) const {
    const double turn = c * p1 * p1, bend = c * p2;
    return {-kCrank * std::cos(a) - turn * std::cos(p) - bend * std::sin(p),
            -kCrank * std::sin(a) - turn * std::sin(p) + bend * std::cos(p)};
  }
  double a;
};

/// Returns d/dt {a, a'} from M(a) a'' + M'(a) a'^2 / 2 = torque - dV/da, with `gravity` in the direction -y [m/s^2].
inline Eigen::VectorXd crank_rates(const Eigen::VectorXd& y, double torque, double gravity = 0) {
  const SliderCrank s(y[0]);
  const Eigen::Vector2d centre = s.first(kRodCentre), pin = s.first(kRod);
  const double mass =
      kCrankInertia + kRodMass * centre.squaredNorm() + kRodTurn * s.p1 * s.p1 + kSlider * pin[0] * pin[0];
  const double half_slope =
      kRodMass * centre.dot(s.second(kRodCentre)) + kRodTurn * s.p1 * s.p2 + kSlider * pin[0] * s.second(kRod)[0];
  const double weight = gravity * (kCrankMass * kCrankCentre * std::cos(y[0]) + kRodMass * centre[1]);
  return Eigen::Vector2d(y[1], (torque - weight - half_slope * y[1] * y[1]) / mass);
}

}  // namespace flexarm::test
