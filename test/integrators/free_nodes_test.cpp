// Compares the update of nodes in packs of four with the update of single nodes.
#include "integrators/free_nodes.h"

#include <limits>

#include <gtest/gtest.h>

#include "elements/random_element.h"
#include "integrators/mechanism.h"
#include "math/cayley.h"

namespace flexarm {
namespace {

using namespace test;

/// Error of unit quaternions and of matrices made of them: some ten operations on numbers up to 1.
constexpr double kRoundOff = 10 * std::numeric_limits<double>::epsilon();

NodePose moved(const NodePose& from, const Vector3& displacement, const Quaternion& turn) {
  const Quaternion orientation = (turn * from.orientation).normalized();
  return {from.position + displacement, orientation, orientation.toRotationMatrix()};
}

void expect_equal(const NodePose& actual, const NodePose& expected) {
  EXPECT_EQ(actual.position, expected.position);
  EXPECT_LE((actual.orientation.coeffs() - expected.orientation.coeffs()).norm(), kRoundOff);
  EXPECT_LE((actual.rotation - expected.rotation).norm(), kRoundOff);
}

class FreeNodesOf : public ::testing::Test {
 protected:
  const Model model_ = build_model(every_joint_scene(true));
  const DegreesOfFreedom dof_{model_};
  RandomSource random_;
  std::vector<NodePose> begin_ = model_.nodes;

  /// Random increments with rotations of up to pi, outside of the range of the series that packs use.
  Eigen::VectorXd increment() {
    Eigen::VectorXd out(dof_.unknowns);
    for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = 1.8 * random_.number();
    return out;
  }
  template <class Turn>
  void expect_moved(const Eigen::VectorXd& increment, const std::vector<NodePose>& end, const Turn& turn) const {
    for (int i = 0; i < dof_.node_count; ++i) {
      SCOPED_TRACE(i);
      if (dof_.slave_joint[i] >= 0) {
        expect_equal(end[i], begin_[i]);
        continue;
      }
      const Vector6 own = increment.segment<6>(dof_.equation[dof_.first[i]]);
      expect_equal(end[i], moved(begin_[i], own.head<3>(), turn(Vector3(own.tail<3>()))));
    }
  }
};

TEST_F(FreeNodesOf, AMechanismTakeNewtonsUpdates) {
  const Eigen::VectorXd update = increment();
  std::vector<NodePose> end = begin_;
  FreeNodes(dof_).update(update, end);
  expect_moved(update, end, [](const Vector3& spin) { return so3::exp_quaternion(spin); });
}

TEST_F(FreeNodesOf, AMechanismAreAdvancedByIncrementsThatAreFoundAgain) {
  const Eigen::VectorXd made = increment();
  std::vector<NodePose> end = begin_;
  FreeNodes(dof_).advance(begin_, made, end);
  expect_moved(made, end, [](const Vector3& rotation) { return cayley::quaternion(rotation); });

  std::vector<Vector3> increments(end.size());
  set_increments(begin_, end, increments);
  for (int i = 0; i < dof_.node_count; ++i) {
    const Vector3 expected = dof_.slave_joint[i] >= 0 ? Vector3(Vector3::Zero())
                                                      : Vector3(made.segment<3>(dof_.equation[dof_.first[i]] + 3));
    EXPECT_LE((increments[i] - expected).norm(), kRoundOff * (1 + expected.squaredNorm()));
  }
}

// The increment must be exactly zero. This also holds where fused multiply-add would make b a - a b differ from zero.
TEST_F(FreeNodesOf, AMechanismThatStandsHaveNoIncrements) {
  for (NodePose& pose : begin_) pose.orientation = random_.rotation(3);
  std::vector<Vector3> increments(begin_.size(), Vector3::Ones());
  set_increments(begin_, begin_, increments);
  for (const Vector3& increment : increments) EXPECT_EQ(increment, Vector3(Vector3::Zero()));
}

TEST(DegreesOfFreedom, RunsAreAllUnknownsInTheirOrder) {
  for (const bool floating : {false, true}) {
    const DegreesOfFreedom dof(build_model(every_joint_scene(floating)));
    std::vector<int> equation(dof.scalar_count, -1);
    for (const auto& run : dof.runs)
      for (int k = 0; k < run.count; ++k) equation[run.scalar + k] = run.equation + k;
    EXPECT_EQ(equation, dof.equation);
  }
}

}  // namespace
}  // namespace flexarm
