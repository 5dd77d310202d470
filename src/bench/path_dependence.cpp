#include "bench/path_dependence.h"

#include <algorithm>
#include <vector>

#include "bench/scenes.h"
#include "math/pi.h"
#include "math/quadrature.h"
#include "study_schemes/referenced_rotation.h"

namespace flexarm::bench {
namespace {

constexpr int kNodes = 3, kPoints = 2;

using NodeVectors = std::array<Vector3, kNodes>;
using NodeRotations = std::array<Quaternion, kNodes>;
using Points = std::array<InterpolatedRotation<double>, kPoints>;

/// Rotations of the nodes at the fraction `part`, in [0, 1], of a curved path.
NodeRotations target(double part) {
  NodeRotations out;
  for (int i = 0; i < kNodes; ++i) {
    const Vector3 along(0.7 + 0.3 * i, -0.4 * i, 0.5 * i), aside(0.3 * i, 0.5, -0.2);
    out[i] = so3::exp_quaternion(Vector3(part * along + std::sin(kPi * part) * aside));
  }
  return out;
}

/// Nodes and stiffness points of a straight element of length 2, initially undeformed.
class Element {
 public:
  Element(Interpolation interpolation, RotationUpdate update) : interpolation_(interpolation), update_(update) {
    nodes_.fill(Quaternion::Identity());
    total_.fill(Vector3::Zero());
    point_total_.fill(Vector3::Zero());
    points_.fill({Matrix3::Identity(), Vector3::Zero()});
    begin_increment();
  }

  void begin_increment() {
    begin_nodes_ = nodes_;
    begin_points_ = points_;
    increment_.fill(Vector3::Zero());
  }
  /// Makes one Newton iterate that takes the nodes to the target.
  void iterate(const NodeRotations& target) {
    NodeVectors spin;
    for (int i = 0; i < kNodes; ++i) spin[i] = so3::log(target[i] * nodes_[i].conjugate());
    if (update_ == RotationUpdate::Additive) {
      for (int i = 0; i < kNodes; ++i) {
        const Vector3 total_change = so3::log(target[i]) - total_[i],
                      change = so3::log(target[i] * begin_nodes_[i].conjugate()) - increment_[i];
        total_[i] += total_change;
        increment_[i] += change;
        nodes_[i] = interpolation_ == Interpolation::Incremental ? so3::exp_quaternion(increment_[i]) * begin_nodes_[i]
                    : interpolation_ == Interpolation::Total     ? so3::exp_quaternion(total_[i])
                                                                 : so3::exp_quaternion(spin[i]) * nodes_[i];
      }
    } else {
      for (int i = 0; i < kNodes; ++i) {
        nodes_[i] = so3::exp_quaternion(spin[i]) * nodes_[i];
        total_[i] = so3::log(nodes_[i]);
        increment_[i] = so3::log(nodes_[i] * begin_nodes_[i].conjugate());
      }
    }
    for (int k = 0; k < kPoints; ++k) update_point(k, spin);
  }

  const Points& points() const { return points_; }

 private:
  void update_point(int k, const NodeVectors& spin) {
    const ShapeFunctions<kNodes> functions = lagrange<kNodes>(GaussLegendre<kPoints>::points[k]);
    const NodalValues<kNodes>&shape = functions.values, &slope = functions.derivatives;
    GeneralisedShapeFunctions<kNodes> unused;
    const auto from = [&](const NodeVectors& vectors, const InterpolatedRotation<double>& reference) {
      return ReferencedRotations<kNodes>(RotationParameters::Unscaled, vectors)
          .evaluate(shape, slope, reference, unused);
    };
    switch (interpolation_) {
      case Interpolation::Local:
        points_[k] = LocalRotations<kNodes>(nodes_).evaluate(shape, slope);
        return;
      case Interpolation::Total:
        points_[k] = from(total_, {Matrix3::Identity(), Vector3::Zero()});
        return;
      case Interpolation::Incremental:
        points_[k] = from(increment_, begin_points_[k]);
        return;
      case Interpolation::Iterative:
        points_[k] = from(spin, points_[k]);
        if (update_ == RotationUpdate::Spin) return;
        // Curvature by (5.5)_2; rotation by the sum of total rotation vectors.
        Vector3 point_spin = Vector3::Zero();
        for (int i = 0; i < kNodes; ++i) point_spin += shape[i] * spin[i];
        point_total_[k] += so3::inverse_tangent(point_total_[k]) * point_spin;
        points_[k].rotation = so3::exp(point_total_[k]);
        return;
    }
  }

  Interpolation interpolation_;
  RotationUpdate update_;
  NodeRotations nodes_, begin_nodes_;
  NodeVectors total_, increment_;
  Points points_, begin_points_;
  std::array<Vector3, kPoints> point_total_;
};

Points reached(Interpolation interpolation, RotationUpdate update, int increments, int iterates) {
  Element element(interpolation, update);
  for (int n = 0; n < increments; ++n) {
    element.begin_increment();
    for (int k = 1; k <= iterates; ++k) element.iterate(target((n + static_cast<double>(k) / iterates) / increments));
  }
  return element.points();
}

PathDifference difference(const Points& a, const Points& b) {
  PathDifference out;
  double largest = 0;
  for (int k = 0; k < kPoints; ++k) {
    out.rotation = std::max(out.rotation, so3::log(Matrix3(a[k].rotation.transpose() * b[k].rotation)).norm());
    out.curvature = std::max(out.curvature, (a[k].curvature - b[k].curvature).norm());
    largest = std::max(largest, a[k].curvature.norm());
  }
  out.curvature /= largest;
  return out;
}

PathDifference largest_of(const PathDifference& a, const PathDifference& b) {
  return {std::max(a.rotation, b.rotation), std::max(a.curvature, b.curvature)};
}

}  // namespace

PathDifference PathDependence::largest() const {
  return largest_of(by_increments, by_iterates);
}

PathDependence path_dependence(Interpolation interpolation, RotationUpdate update) {
  const auto points = [&](int increments, int iterates) {
    return reached(interpolation, update, increments, iterates);
  };
  const Points direct = points(1, 1);
  return {largest_of(difference(direct, points(2, 1)), difference(direct, points(8, 1))),
          difference(direct, points(1, 4))};
}

Measured<double> static_path_dependence(const Variant& variant) {
  std::vector<Vector3> tips;
  for (const int load_steps : {1, 4, 16}) {
    Simulation cantilever = simulation(loaded_cantilever(), variant, 1e-3);
    const StepResult result = cantilever.solve_static(load_steps);
    if (!result.converged) return {Failure{0, result.reason}, 0};
    tips.push_back(cantilever.probe(0).pose.position);
  }
  return {{}, std::max((tips[0] - tips[2]).norm(), (tips[1] - tips[2]).norm())};
}

}  // namespace flexarm::bench
