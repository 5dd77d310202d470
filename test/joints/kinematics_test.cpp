// Tests the kinematics of mechanisms in a configuration against closed forms and finite differences.
#include "joints/kinematics.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "integrators/mechanism.h"
#include "math/least_squares.h"
#include "support/closed_ring.h"

namespace flexarm {
namespace {

using namespace test;
using Eigen::VectorXd;
using scene::JointKind;

void add_link(SceneBuilder& b, const std::string& name, const std::string& hinge, const std::string& parent,
              const Vector3& origin, double start) {
  b.body(name, 1, {0.2, 0, 0}, 0.1 * Matrix3::Identity());
  b.joint(hinge, JointKind::Continuous, parent, name, origin, Vector3::UnitY());
  if (start != 0) b.scene.initial_joints.push_back({hinge, start, 0, {}});
}

/// A crank of 0.5 m on the origin, a rocker of 0.4 m on the ground beside it, and a coupler between their ends. Angles
/// [rad]: of the crank, of the coupler against it, of the rocker.
SceneBuilder four_bar(const Vector3& angles, double ground, double rocker) {
  SceneBuilder b;
  add_link(b, "crank", "foot", "world", Vector3::Zero(), angles[0]);
  add_link(b, "coupler", "knee", "crank", {0.5, 0, 0}, angles[1]);
  add_link(b, "rocker", "toe", "world", {ground, 0, 0}, angles[2]);
  close_loop(b, "pin", JointKind::Spherical, "coupler", "rocker", {rocker, 0, 0});
  return b;
}

/// A model with its numbering.
struct Numbered {
  explicit Numbered(const SceneBuilder& b) : Numbered(build_model(b.scene)) {}
  explicit Numbered(Model built) : model(std::move(built)), dof(model) {}
  int scalar(const std::string& coordinate) const {
    for (const Coordinate& c : model.coordinates)
      if (c.name == coordinate) return dof.scalar_of(c);
    throw std::out_of_range(coordinate);
  }
  Kinematics start() const { return {model, dof, initial_configuration(model)}; }
  Kinematics after(const VectorXd& motion) const {
    return {model, dof, moved(model, dof, initial_configuration(model), motion)};
  }
  Eigen::MatrixXd jacobian(const VectorXd& motion, Constraints which) const {
    return closure_jacobian(after(motion), which);
  }
  VectorXd no_motion() const { return VectorXd::Zero(dof.scalar_count); }

  Model model;
  DegreesOfFreedom dof;
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a[0] * b[1] - a[1] * b[0];
}

// The rates of crank, coupler and rocker follow from the velocities of the coupler's ends.
TEST(Kinematics, OfAFourBarLinkage) {
  const double first = 1, third = 1.2, ground = 0.9, length = 0.4;
  const Numbered n(four_bar({first, -0.7, third}, ground, length));
  const auto along = [](double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
  const Eigen::Vector2d crank = 0.5 * along(first), rocker = length * along(third),
                        coupler = Eigen::Vector2d(ground, 0) + rocker - crank;
  VectorXd rates = n.no_motion();
  rates[n.scalar("foot")] = 1;
  rates[n.scalar("knee")] = -cross(crank, rocker) / cross(coupler, rocker) - 1;
  rates[n.scalar("toe")] = cross(crank, coupler) / cross(rocker, coupler);
  const Eigen::MatrixXd all = n.jacobian(n.no_motion(), Constraints::All);
  EXPECT_EQ(all.rows(), 3);
  EXPECT_LT((all * rates).norm(), 1e-14) << "no rate of a gap";
  const Eigen::MatrixXd kept = n.jacobian(n.no_motion(), Constraints::WithMultipliers);
  EXPECT_EQ(kept.rows(), 2) << "in the plane";
  EXPECT_EQ(independent_rows(kept.transpose(), kIndependent).size(), 2u) << "coordinates that follow the third one";
}

// Whoever counts multipliers counts the rows of the Jacobian, and the last unknowns.
TEST(Kinematics, MultipliersAreTheLastUnknownsInTheOrderOfTheirConstraints) {
  SceneBuilder b = four_bar({1, -0.7, 1.2}, 0.9, 0.4);
  add_link(b, "arm", "shoulder", "world", {0, 2, 0}, 0.3);
  add_link(b, "hand", "wrist", "arm", {0.3, 0, 0}, -1);
  add_link(b, "leg", "ankle", "world", {0.6, 2, 0}, 1.1);
  close_loop(b, "clasp", JointKind::Spherical, "hand", "leg", {0.2, 0, 0});
  const Numbered n(b);
  std::vector<const ClosureConstraint*> constraints;
  for_each_constraint(n.model, Constraints::WithMultipliers,
                      [&](const auto&, const ClosureConstraint& constraint) { constraints.push_back(&constraint); });
  ASSERT_EQ(n.model.closures.size(), 2u);
  ASSERT_EQ(multiplier_count(n.model), static_cast<int>(constraints.size()));
  std::size_t next = 0;
  int equation = n.dof.unknowns - multiplier_count(n.model);
  for_each_multiplier(n.model, n.dof, [&](int closure, int constraint, int own) {
    EXPECT_EQ(&n.model.closures[closure].constraints[constraint], constraints[next++]);
    EXPECT_EQ(own, equation++);
  });
  EXPECT_EQ(equation, n.dof.unknowns);
}

// If all links are in line, the crank may go on with the rocker, or against it.
TEST(Kinematics, OfAParallelogramAtItsDeadPoint) {
  const Numbered n(four_bar({1, -1, 1}, 0.7, 0.5));
  const auto rank_at = [&](double angle) {
    VectorXd motion = n.no_motion();
    motion[n.scalar("foot")] = motion[n.scalar("toe")] = angle - 1;
    motion[n.scalar("knee")] = 1 - angle;
    return independent_rows(n.jacobian(motion, Constraints::WithMultipliers).transpose(), kIndependent).size();
  };
  for (const double angle : {1.0, 0.1, 1e-4, -1e-4, -2.0}) EXPECT_EQ(rank_at(angle), 2u) << angle;
  for (const double angle : {0.0, 1e-9, -1e-9}) EXPECT_EQ(rank_at(angle), 1u) << angle;
}

// A crank and a slider, of any size: constraints and coordinates count in units of the mechanism.
TEST(Kinematics, OfLoopsDoesNotDependOnTheUnitOfLength) {
  std::vector<Eigen::MatrixXd> jacobians;
  for (const double unit : {1e-3, 1.0, 1e3}) {
    SceneBuilder b;
    add_link(b, "crank", "foot", "world", Vector3::Zero(), 1);
    add_link(b, "rod", "knee", "crank", {0.5 * unit, 0, 0}, -1.3);
    b.body("slider", 1, Vector3::Zero(), 0.1 * Matrix3::Identity());
    b.joint("track", JointKind::Prismatic, "world", "slider", {0.4 * unit, 0, 0.1 * unit}, Vector3::UnitX());
    close_loop(b, "pin", JointKind::Spherical, "rod", "slider", {0.1 * unit, 0, 0});
    for (scene::LinkDescription& link : b.scene.links)
      if (link.inertial) link.inertial->center_of_mass *= unit;
    const Numbered n(b);
    const Eigen::MatrixXd all = n.jacobian(n.no_motion(), Constraints::WithMultipliers);
    Eigen::MatrixXd own(all.rows(), 3);
    own << all.col(n.scalar("foot")), all.col(n.scalar("knee")), all.col(n.scalar("track"));
    jacobians.push_back(own);
  }
  for (const Eigen::MatrixXd& jacobian : jacobians) EXPECT_LT((jacobian - jacobians[1]).norm(), 1e-12);
}

// A planet on a crank turns against it by a ratio; both are one motion.
TEST(Kinematics, OfACrankWithAFollower) {
  const double ratio = -2.5;
  SceneBuilder b;
  add_link(b, "crank", "foot", "world", Vector3::Zero(), 0.3);
  add_link(b, "planet", "gear", "crank", {0.5, 0, 0}, 0);
  b.scene.joints.back().mimic = scene::Mimic{"foot", ratio, 0.1};
  const Numbered n(b);
  VectorXd motion = n.no_motion();
  motion[n.scalar("foot")] = 1;
  n.start().complete(motion);
  EXPECT_EQ(motion[n.scalar("gear")], ratio);
  const Attachment& planet = n.model.links.back().frame;
  const Vector3 arm = 0.5 * Vector3(std::cos(0.3), 0, -std::sin(0.3)), spin = (1 + ratio) * Vector3::UnitY(),
                offset = n.model.nodes[planet.node].rotation * planet.offset.position;
  const Vector6 node = motion.segment<6>(n.dof.first[planet.node]);
  EXPECT_LT((node.tail<3>() - spin).norm(), 1e-14);
  EXPECT_LT((node.head<3>() + spin.cross(offset) - Vector3::UnitY().cross(arm)).norm(), 1e-14) << "of its axis";
  const Configuration later = moved(n.model, n.dof, initial_configuration(n.model), 0.4 * motion);
  EXPECT_NEAR(later.released[n.model.coordinates[1].joint].displacement[0], 0.1 + ratio * 0.7, 1e-14);
}

/// Checks the motions of all nodes, and the rates of all constraints, along every motion that a model can make by one
/// scalar.
void expect_derivatives(const Numbered& n) {
  const Kinematics start = n.start();
  const Eigen::MatrixXd jacobian = closure_jacobian(start, Constraints::All);
  const VectorXd scales = scalar_scales(n.model, n.dof);
  const int others = n.dof.scalar_count - multiplier_count(n.model);  // multipliers are the last scalars
  for (int scalar = 0; scalar < others; ++scalar) {
    if (n.dof.equation[scalar] < 0) continue;
    const VectorXd unit = VectorXd::Unit(n.dof.scalar_count, scalar);
    VectorXd motion = unit;
    start.complete(motion);
    const VectorXd change = difference([&](double h) {
      const Kinematics there = n.after(h * unit);
      VectorXd ways = n.no_motion();
      for (int i = 0; i < n.dof.node_count; ++i) {
        const NodePose &from = n.model.nodes[i], &to = there.nodes()[i];
        ways.segment<6>(n.dof.first[i]) << to.position - from.position,
            so3::log(Quaternion(to.orientation * from.orientation.conjugate()));
      }
      return ways;
    });
    for (int i = 0; i < n.dof.node_count; ++i)
      EXPECT_LT((motion - change).segment<6>(n.dof.first[i]).norm(), 10 * difference_tolerance) << scalar << ", " << i;
    if (jacobian.rows() == 0) continue;
    const VectorXd rates = difference([&](double h) {
      const Kinematics there = n.after(h * unit);
      VectorXd values(jacobian.rows());
      int row = 0;
      for_each_constraint(n.model, Constraints::All, [&](const auto& closure, const auto& constraint) {
        values[row++] = closure_value(closure, constraint, closure_poses(closure, there.nodes())) /
                        constraint_scale(n.model, constraint);
      });
      return values;
    });
    EXPECT_LT((jacobian.col(scalar) - scales[scalar] * rates).norm(), 10 * difference_tolerance) << scalar;
  }
}

TEST(Kinematics, OfEveryJointIsTheDerivativeOfPoses) {
  expect_derivatives(Numbered(build_model(every_joint_scene(false))));
}

TEST(Kinematics, OfLoopsInSpace) {
  for (const JointKind kind : {JointKind::Fixed, JointKind::Spherical, JointKind::Universal})
    expect_derivatives(Numbered(free_ring(kind)));
}

// A loop over a beam, and one with a coordinate that follows another.
TEST(Kinematics, OfLoopsWithBeamsAndFollowers) {
  SceneBuilder geared = four_bar({1, -0.7, 1.2}, 0.9, 0.4);
  add_link(geared, "arm", "elbow", "rocker", {0.2, 0, 0}, 0.4);
  geared.scene.loop_joints.clear();
  geared.scene.joints[2].mimic = scene::Mimic{"foot", -0.8, 0};
  geared.scene.initial_joints.erase(geared.scene.initial_joints.begin() + 2);
  close_loop(geared, "pin", JointKind::Spherical, "coupler", "arm", {0.3, 0, 0});
  expect_derivatives(Numbered(geared));
  SceneBuilder bent = free_ring(JointKind::Spherical);
  bent.beam("flag", {Vector3(0.5, 0.1, 0)}, test::section(40, 20, 6, 8, 1.4, 0.2, 0.1), 1, 2);
  bent.joint("root", JointKind::Continuous, "left_end", "flag", Vector3(0.1, 0, 0));
  bent.body("tip", 0.2, Vector3::Zero(), 0.01 * Matrix3::Identity());
  bent.joint("tip", JointKind::Spherical, "flag", "tip", {0.5, 0.1, 0});
  close_loop(bent, "stay", JointKind::Spherical, "trunk", "tip", {0.1, 0.2, 0});
  expect_derivatives(Numbered(bent));
}

}  // namespace
}  // namespace flexarm
