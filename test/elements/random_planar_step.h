#pragma once
/// A random step of an element that moves in a plane, for tests of planar kernels.

#include "elements/kernel_checks.h"
#include "elements/planar_element.h"
#include "model/plane.h"

namespace flexarm::test {

/// Tolerance between planar and three-dimensional kernels: round-off of some hundred terms, relative to the largest
/// one.
constexpr double kPlanarRoundOff = 1e-13;

/// A random step of a curved element with a full section, in a plane of random orientation.
template <int Nodes>
struct RandomPlanarStep {
  RandomPlanarStep(RandomSource& random, double size) : size(size) {
    const Matrix3 axes = random.rotation(3.0).toRotationMatrix();
    plane.first = axes.col(0), plane.second = axes.col(1), plane.normal = axes.col(2);
    height = random.number();
    plane.frames.assign(Nodes, random.rotation(3.0));
    basis = plane.strain_basis(0);
    RandomStep<Nodes> any(random, 0.1);  // only its shape functions are used
    element = any.element;
    const Eigen::Matrix<double, 6, 3> rest = basis_out_of_plane();
    for (auto& point : element.stiffness_points) {
      point.stiffness = basis * random.positive_definite<3>() * basis.transpose();
      point.stiffness += rest * random.positive_definite<3>() * rest.transpose();
      point.reference_strain = basis * random.vector();
    }
    const Vector3 normal = plane.material_normal(0);
    const Matrix3 across = Matrix3::Identity() - normal * normal.transpose();
    for (auto& point : element.mass_points)
      point.inertia =
          across * point.inertia * across + normal.dot(point.inertia * normal) * normal * normal.transpose();
    for (int i = 0; i < Nodes; ++i) {
      begin_angle[i] = 2 + 0.4 * random.number();
      end_angle[i] = begin_angle[i] + size * (1 + 0.5 * random.number());
      begin[i] = {1.5 * i / (Nodes - 1) + 0.1 * random.number(), 0.3 * random.number()};
      end[i] = begin[i] + size * in_order(random);
      velocity[i] = in_order(random);
    }
  }

  /// Basis of the strains out of the plane, in columns.
  Eigen::Matrix<double, 6, 3> basis_out_of_plane() const {
    Eigen::Matrix<double, 6, 3> rest = Eigen::Matrix<double, 6, 3>::Zero();
    rest.col(0).template head<3>() = plane.material_normal(0);
    rest.col(1).template tail<3>() = basis.col(0).template head<3>();
    rest.col(2).template tail<3>() = basis.col(1).template head<3>();
    return rest;
  }
  Vector3 in_space(const Vector2& v, double height = 0) const {
    return v[0] * plane.first + v[1] * plane.second + height * plane.normal;
  }
  Quaternion turned(double angle) const { return so3::exp_quaternion(Vector3(angle * plane.normal)) * plane.frames[0]; }
  PlanarPose pose(const Vector2& position, double angle) const {
    return plane.pose(0, in_space(position, height), turned(angle));
  }
  /// Moves node i along one of {dx, dy, spin}.
  void move(int i, int component, double by) {
    if (component == 2)
      end_angle[i] += by;
    else
      end[i][component] += by;
  }
  static Vector2 in_order(RandomSource& random) {
    const double x = random.number(), y = random.number();
    return {x, y};
  }

  double size;
  PlaneOfMotion plane;
  double height;
  Eigen::Matrix<double, 6, 3> basis;
  BeamElement<Nodes> element;
  std::array<double, Nodes> begin_angle, end_angle;
  std::array<Vector2, Nodes> begin, end, velocity;
};

/// Compares forces and tangent of both kernels, and expects no component out of the plane. `slope`: largest possible
/// entry of the tangent.
template <int Nodes>
void expect_same_in_plane(const PlaneOfMotion& plane, const ElementSystem<Nodes>& space,
                          const std::array<Vector3, Nodes>& forces, const planar::BlockSystem<Nodes>& in_plane,
                          double tolerance, double tangent_tolerance) {
  for (int i = 0; i < Nodes; ++i) {
    const Vector6 expected = space.residual.template segment<6>(6 * i);
    EXPECT_LE(largest(plane.projected(expected) - forces[i]), tolerance);
    EXPECT_LE(largest(expected - plane.expanded(plane.projected(expected))), tolerance);
    for (int j = 0; j < Nodes; ++j) {
      const Matrix6 block = space.tangent.template block<6, 6>(6 * i, 6 * j);
      for (int c = 0; c < 3; ++c) {
        const Vector6 column = block * plane.expanded(Vector3(Vector3::Unit(c)));
        EXPECT_LE(largest(plane.projected(column) - in_plane.tangent[i][j].col(c).template head<3>()),
                  tangent_tolerance);
        EXPECT_LE(largest(column - plane.expanded(plane.projected(column))), tangent_tolerance);
      }
    }
  }
}

/// Compares the tangent with differences of forces. kernel(step, with_tangent, forces) returns the system and sets its
/// forces.
template <int Nodes, class Step, class Kernel>
void expect_consistent_planar_tangent(const Step& step, const Kernel& kernel) {
  std::array<Vector3, Nodes> forces;
  const planar::BlockSystem<Nodes> system = kernel(step, true, forces);
  double scale = 1;
  for (const auto& row : system.tangent)
    for (const auto& block : row) scale = std::max(scale, largest(block));
  const double size = std::min(1.0, step.size);
  for (int j = 0; j < Nodes; ++j)
    for (int c = 0; c < 3; ++c) {
      using Column = Eigen::Matrix<double, 3 * Nodes, 1>;
      const Column expected = difference(
          [&](double h) {
            Step moved = step;
            moved.move(j, c, h);
            std::array<Vector3, Nodes> at;
            kernel(moved, false, at);
            return Column(Eigen::Map<Column>(at[0].data()));
          },
          difference_step * size);
      for (int i = 0; i < Nodes; ++i)
        EXPECT_LE(largest(expected.template segment<3>(3 * i) - system.tangent[i][j].col(c).template head<3>()),
                  difference_tolerance / size * scale);
    }
}

}  // namespace flexarm::test
