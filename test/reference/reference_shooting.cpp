// Reference solutions of static beams by a shooting method; see reference_shooting.h.
#include "reference_shooting.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

#include "support/dense_solution.h"

namespace flexarm::test {
namespace {

/// Undeformed line of one piece: the frame at its root, and its curvature in section axes.
struct ReferenceLine {
  double length = 0, curvature = 0, twist_rate = 0;
  Matrix3 root = Matrix3::Identity();

  explicit ReferenceLine(const scene::CentrelinePiece& piece) {
    Vector3 tangent = piece.to.normalized();
    Vector3 normal = std::abs(tangent.y()) < 0.9 ? Vector3::UnitZ() : Vector3::UnitX();
    length = piece.to.norm();
    if (piece.kind == scene::CentrelinePiece::Kind::Arc) {
      const double radius = piece.center.norm();
      const Vector3 inwards = piece.center / radius;
      tangent = (piece.to - piece.to.dot(inwards) * inwards).normalized();
      normal = tangent.cross(inwards);
      length = radius * 2 * std::asin(piece.to.norm() / (2 * radius));
      curvature = 1 / radius;
    }
    twist_rate = piece.twist / length;
    root << tangent, normal.cross(tangent), normal;
  }

  /// Undeformed section at the end: rotation of the arc about its axis, then twist about the tangent.
  Matrix3 tip() const {
    const Eigen::AngleAxisd turn(curvature * length, Vector3::UnitZ()), twist(twist_rate * length, Vector3::UnitX());
    return root * (turn * twist).toRotationMatrix();
  }

  /// Upsilon_0: the arc rotates about the third axis of the untwisted section.
  Vector3 upsilon(double s) const {
    const double angle = twist_rate * s;
    return {twist_rate, curvature * std::sin(angle), curvature * std::cos(angle)};
  }
};

struct SectionState {
  Vector3 position;
  Eigen::Vector4d quaternion;  // w, x, y, z
  Vector3 moment;

  SectionState operator+(const SectionState& o) const {
    return {position + o.position, quaternion + o.quaternion, moment + o.moment};
  }
  SectionState operator*(double f) const { return {f * position, f * quaternion, f * moment}; }
};

class Shooting {
 public:
  Shooting(const ReferenceLine& line, const Matrix6& stiffness, const Vector3& force, int steps)
      : line_(line), compliance_(solution(stiffness, Matrix6::Identity())), force_(force), steps_(steps) {}

  SectionState integrate(const Vector3& root_moment) const {
    const Quaternion q(line_.root);
    SectionState y{Vector3::Zero(), {q.w(), q.x(), q.y(), q.z()}, root_moment};
    const double h = line_.length / steps_;
    for (int i = 0; i < steps_; ++i) {
      const double s = i * h;
      const SectionState k1 = slope(s, y), k2 = slope(s + h / 2, y + k1 * (h / 2)),
                         k3 = slope(s + h / 2, y + k2 * (h / 2)), k4 = slope(s + h, y + k3 * h);
      y = y + (k1 + k2 * 2 + k3 * 2 + k4) * (h / 6);
    }
    return y;
  }

 private:
  SectionState slope(double s, const SectionState& y) const {
    const Quaternion q = Quaternion(y.quaternion[0], y.quaternion[1], y.quaternion[2], y.quaternion[3]);
    const Matrix3 rotation = q.normalized().toRotationMatrix();
    Vector6 stress;
    stress << rotation.transpose() * force_, rotation.transpose() * y.moment;
    const Vector6 strain = compliance_ * stress;
    const Vector3 tangent = rotation * (Vector3::UnitX() + strain.head<3>());
    const Vector3 upsilon = line_.upsilon(s) + strain.tail<3>();
    const Quaternion rate = q * Quaternion(0, upsilon.x() / 2, upsilon.y() / 2, upsilon.z() / 2);
    return {tangent, {rate.w(), rate.x(), rate.y(), rate.z()}, -tangent.cross(force_)};
  }

  ReferenceLine line_;
  Matrix6 compliance_;
  Vector3 force_;
  int steps_;
};

}  // namespace

Pose shooting_tip(const Cantilever& cantilever, const Matrix6& stiffness, int steps) {
  const ReferenceLine line(cantilever.pieces.front());
  constexpr int kIncrements = 10;
  Vector3 root_moment = Vector3::Zero();
  SectionState tip;
  for (int increment = 1; increment <= kIncrements; ++increment) {
    const double factor = double(increment) / kIncrements;
    const Shooting shooting(line, stiffness, factor * cantilever.force, steps);
    const double scale = factor * (cantilever.moment.norm() + line.length * cantilever.force.norm());
    bool converged = false;
    for (int iteration = 0; iteration < 20 && !converged; ++iteration) {
      tip = shooting.integrate(root_moment);
      const Vector3 residual = tip.moment - factor * cantilever.moment;
      converged = residual.norm() < 1e-13 * scale;
      if (converged) break;
      Matrix3 jacobian;
      const double step = 1e-6 * scale;
      for (int k = 0; k < 3; ++k)
        jacobian.col(k) = (shooting.integrate(root_moment + step * Vector3::Unit(k)).moment - tip.moment) / step;
      root_moment -= jacobian.inverse() * residual;
    }
    if (!converged) throw std::runtime_error("shooting did not converge");
  }
  const Quaternion orientation(tip.quaternion[0], tip.quaternion[1], tip.quaternion[2], tip.quaternion[3]);
  return {tip.position, orientation.normalized() * Quaternion(line.tip()).conjugate()};
}

Matrix6 stiffness_matrix(const scene::DirectSection& s) {
  Vector6 diagonal;
  diagonal << s.ea, s.ga2, s.ga3, s.gj, s.ei2, s.ei3;
  return diagonal.asDiagonal();
}

}  // namespace flexarm::test
