// Tests which coordinates of loops explicit schemes make dependent, and where they find none.
#include "integrators/dependent_rates.h"

#include <gtest/gtest.h>

#include "building/model_builder.h"
#include "joints/kinematics.h"
#include "math/least_squares.h"
#include "math/pi.h"
#include "math/picked.h"
#include "schemes/explicit_tableau.h"
#include "support/loops.h"

namespace flexarm {
namespace {

using namespace test;
using scene::JointKind;

/// A driven crank, which turns a rod whose end slides along x. It starts with the crank at 1 rad and the rod at 0.3 rad
/// below the horizontal. All lengths are multiples of `unit` [m].
SceneBuilder slider_crank(double unit) {
  SceneBuilder b;
  const auto along = [&](double angle) { return Vector3(std::cos(angle), 0, -std::sin(angle)); };
  const auto moments = [&] { return Matrix3(0.1 * unit * unit * Matrix3::Identity()); };
  b.body("crank", 1, {0.2 * unit, 0, 0}, moments());
  b.body("rod", 1, {0.2 * unit, 0, 0}, moments());
  b.body("slider", 1, Vector3::Zero(), moments());
  b.joint("foot", JointKind::Continuous, "world", "crank", Vector3::Zero(), Vector3::UnitY());
  b.joint("knee", JointKind::Continuous, "crank", "rod", {0.5 * unit, 0, 0}, Vector3::UnitY());
  b.joint("track", JointKind::Prismatic, "world", "slider", unit * (0.5 * along(1) + 0.4 * along(0.3)),
          Vector3::UnitX());
  b.scene.motions.push_back({"foot", TimeFunction::parse("1+t"), {}});
  b.scene.initial_joints.push_back({"knee", -0.7, 0, {}});
  close_loop(b, "pin", JointKind::Spherical, "rod", "slider");
  return b;
}

/// A slider_crank() whose rod has been turned, with its loop closed.
class Turned {
 public:
  explicit Turned(double unit) : model(build_model(slider_crank(unit).scene)), dof(model), unit_(unit) {}

  /// `angle`: of the rod against the normal of its track.
  Configuration configuration(double angle) const {
    const double rod = kPi / 2 + angle, height = 0.5 * std::sin(1) + 0.4 * std::sin(0.3),
                 crank = std::asin((height - 0.4 * std::sin(rod)) / 0.5);
    Eigen::VectorXd motion = Eigen::VectorXd::Zero(dof.scalar_count);
    motion[scalar_of("foot")] = crank - 1;
    motion[scalar_of("knee")] = rod - crank + 0.7;
    motion[scalar_of("track")] =
        unit_ * (0.5 * (std::cos(crank) - std::cos(1)) + 0.4 * (std::cos(rod) - std::cos(0.3)));
    return moved(model, dof, initial_configuration(model), motion);
  }
  /// Number of coordinates that can follow from the others, by the rule of the build.
  std::size_t rank(const Configuration& there) const {
    const Eigen::MatrixXd jacobian = closure_jacobian({model, dof, there}, Constraints::WithMultipliers);
    const std::vector<int> columns = {scalar_of("knee"), scalar_of("track")};
    return independent_rows(picked_columns(jacobian, columns), kIndependent).size();
  }

  Model model;
  DegreesOfFreedom dof;

 private:
  int scalar_of(const std::string& name) const {
    for (const Coordinate& coordinate : model.coordinates)
      if (coordinate.name == name) return dof.scalar_of(coordinate);
    throw std::out_of_range(name);
  }
  double unit_;
};

// Where the rod stands across its track, rod and slider can move without the crank, and do not follow from it. Steps
// find this by the rule of the build, in any unit of length.
TEST(DependentRates, FindDeadPointsByTheRuleOfRank) {
  for (const double unit : {1e-4, 1.0, 1e4}) {
    const Turned mechanism(unit);
    ASSERT_EQ(multiplier_count(mechanism.model), 2);
    ArticulatedBodies bodies(mechanism.model);
    DependentRates dependent(mechanism.model, bodies, rk4_tableau());
    std::vector<double> rates(static_cast<std::size_t>(bodies.rate_count()), 0.0);
    for (const double angle : {0.5, 1e-2, 1e-5, -1e-5, 1e-8, -1e-8}) {
      Configuration there = mechanism.configuration(angle);
      const bool is_regular = std::abs(angle) > 1e-6;
      EXPECT_EQ(mechanism.rank(there), is_regular ? 2u : 1u) << unit << " " << angle;
      EXPECT_EQ(dependent.begin(0, 1e-3, there.released, rates.data(), bodies), is_regular) << unit << " " << angle;
    }
  }
}

}  // namespace
}  // namespace flexarm
