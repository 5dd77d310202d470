/// Tests cantilevers under tip force and tip moment in space: convergence to the mesh-free solution, on straight,
/// pre-twisted and curved centrelines, and with full section matrices.

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "math/pi.h"
#include "math/so3.h"
#include "reference_cantilever.h"
#include "reference_shooting.h"

namespace flexarm::test {
namespace {

/// A blade, whose bending stiffnesses differ by a factor of nine, so that twist matters.
scene::DirectSection blade() {
  scene::DirectSection s = section(2e3, 8e2, 1.5, 1, 1, 0.1, 0.1);
  s.ei3 = 9;
  return s;
}

/// A symmetric positive definite section matrix with all couplings: extension-torsion, bending-torsion, shear-bending.
Matrix6 coupled() {
  Matrix6 c = stiffness_matrix(blade());
  const auto couple = [&](int i, int j, double share) { c(i, j) = c(j, i) = share * std::sqrt(c(i, i) * c(j, j)); };
  couple(0, 3, 0.3);
  couple(0, 4, -0.2);
  couple(3, 4, 0.35);
  couple(3, 5, -0.15);
  couple(1, 5, 0.25);
  couple(2, 3, 0.2);
  couple(4, 5, 0.3);
  return c;
}

/// Inertia about the reference line, with the centre of mass at `center` in the section.
Matrix6 inertia(const Vector3& center) {
  const double mass = 1.3;
  Matrix6 m = Matrix6::Zero();
  m.topLeftCorner<3, 3>() = mass * Matrix3::Identity();
  m.topRightCorner<3, 3>() = -mass * so3::hat(center);
  m.bottomLeftCorner<3, 3>() = mass * so3::hat(center);
  m.bottomRightCorner<3, 3>() =
      Matrix3(Vector3(0.3, 0.1, 0.2).asDiagonal()) - mass * so3::hat(center) * so3::hat(center);
  return m;
}

Cantilever loaded(const scene::CentrelinePiece& piece, const scene::Section& section) {
  Cantilever cantilever;
  cantilever.pieces = {piece};
  cantilever.section = section;
  cantilever.force = {-0.3, 0.7, 1.1};
  cantilever.moment = {0.4, -0.5, 0.8};
  return cantilever;
}

const scene::CentrelinePiece kStraight = line({2, 0, 0});
const scene::CentrelinePiece kTwisted = line({2, 0, 0}, kPi / 2);
const scene::CentrelinePiece kCurved = arc({1.5, 1.5, 0}, {0, 1.5, 0});
const scene::CentrelinePiece kCurvedAndTwisted = arc({1.5, 1.5, 0}, {0, 1.5, 0}, kPi / 3);

struct SpatialCase {
  const char* name;
  Cantilever cantilever;
  Matrix6 stiffness;
};
std::ostream& operator<<(std::ostream& out, const SpatialCase& c) {
  return out << c.name;
}

class SpatialCantilever : public testing::TestWithParam<SpatialCase> {};

TEST_P(SpatialCantilever, PositionAndRotationConvergeWithOrderTwoP) {
  const SpatialCase& c = GetParam();
  const Pose exact = shooting_tip(c.cantilever, c.stiffness);
  const int coarsest[] = {0, 32, 12, 6};
  for (int order = 1; order <= 3; ++order) {
    double positions[2], rotations[2];
    for (int k = 0; k < 2; ++k) {
      const Pose tip = static_tip(c.cantilever, coarsest[order] << k, order);
      positions[k] = (tip.position - exact.position).norm();
      rotations[k] = tip.orientation.angularDistance(exact.orientation);
    }
    std::printf("%s order %d: %.2e %.2e  %.2e %.2e\n", c.name, order, positions[0], positions[1], rotations[0],
                rotations[1]);
    EXPECT_NEAR(observed_order(positions[0], positions[1]), 2 * order, kOrderTolerance) << "order " << order;
    EXPECT_NEAR(observed_order(rotations[0], rotations[1]), 2 * order, kOrderTolerance) << "order " << order;
  }
  // The finest quartic mesh reaches the accuracy of the mesh-free solution.
  const Pose finest = static_tip(c.cantilever, 16, 4);
  EXPECT_LT((finest.position - exact.position).norm(), 1e-9);
  EXPECT_LT(finest.orientation.angularDistance(exact.orientation), 1e-9);
}

std::vector<SpatialCase> spatial_cases() {
  const Matrix6 diagonal = stiffness_matrix(blade());
  const scene::Section centred = scene::MatrixSection{coupled(), inertia(Vector3::Zero())};
  const scene::Section offset = scene::MatrixSection{coupled(), inertia({0, 0.06, -0.04})};
  return {{"straight", loaded(kStraight, blade()), diagonal},
          {"twisted", loaded(kTwisted, blade()), diagonal},
          {"curved", loaded(kCurved, blade()), diagonal},
          {"curved_and_twisted", loaded(kCurvedAndTwisted, blade()), diagonal},
          {"straight_coupled", loaded(kStraight, centred), coupled()},
          {"twisted_coupled", loaded(kTwisted, centred), coupled()},
          {"curved_coupled", loaded(kCurved, centred), coupled()},
          // Without gravity, the centre of mass has no influence: the same solution about the reference line.
          {"straight_coupled_offset", loaded(kStraight, offset), coupled()},
          {"curved_and_twisted_coupled_offset", loaded(kCurvedAndTwisted, offset), coupled()}};
}

INSTANTIATE_TEST_SUITE_P(Tip, SpatialCantilever, testing::ValuesIn(spatial_cases()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace flexarm::test
