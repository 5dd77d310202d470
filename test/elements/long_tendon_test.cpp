// Tests the tangents of tendons over many nodes, which consist of pieces and groups of auxiliary variables.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "elements/random_element.h"
#include "elements/tendon.h"
#include "math/pi.h"
#include "support/node_poses.h"
#include "support/whole_step.h"

namespace flexarm::test {
namespace {

constexpr int kNodes = 8;

/// A line over points on seven nodes, one of them in the world and two on one node; node 7 is a winch's.
TendonPlan long_plan() {
  TendonPlan plan;
  for (int i = 0; i < 7; ++i) plan.guides.push_back({{i, {0.02 * i, 0.03, 0.05 - 0.01 * i}}});
  plan.guides.insert(plan.guides.begin() + 3, TendonGuide{{2, {0.3, 0.02, 0.05}}});
  plan.guides.insert(plan.guides.begin() + 5, TendonGuide{{-1, {4, 0.2, 0.4}}});
  plan.law = {800, 5};
  return plan;
}

TendonGuide circle_of(int node, double sense, bool grips, double wrap) {
  return {{node, {0.1, 0.05, 0}, Vector3::UnitX(), Vector3::UnitZ(), 0.08, sense}, grips, wrap};
}

struct LongPoses {
  std::vector<NodePose> begin, end;
};

LongPoses long_poses() {
  RandomSource random(3);
  LongPoses out;
  for (int i = 0; i < kNodes; ++i) {
    const Vector3 position = Vector3(i, 0, 0) + 0.3 * random.vector(), turn = 0.4 * random.vector();
    out.begin.push_back(turned_node(position, turn));
    out.end.push_back(turned_node(position + 0.03 * random.vector(), turn + 0.05 * random.vector()));
  }
  return out;
}

struct LongCase {
  std::string name;
  TendonPlan plan;
  int rank;
};

std::vector<LongCase> long_cases(const std::vector<NodePose>& begin) {
  const TendonPlan plan = long_plan();
  std::vector<LongCase> cases = {{"over points", plan, 1}};
  cases.push_back({"of given tension", plan, 0});
  cases.back().plan.has_tension = true;
  cases.push_back({"with a winch", plan, 2});
  const Vector3 way(0.6, 0, 0.8);
  cases.back().plan.winches = {{7, way, way.dot(begin[7].position), 0}};
  cases.push_back({"with a winch that stands still", plan, 1});
  cases.back().plan.winches = {{-1, way, 0.05, 0.02}};
  cases.push_back({"between drums", plan, 2});
  cases.back().plan.guides.front() = circle_of(0, 1, true, 0);
  cases.back().plan.guides.back() = circle_of(6, -1, true, 0);
  cases.push_back({"over pulleys, beside one of which it passes", plan, 1});
  cases.back().plan.guides[1] = circle_of(1, 1, false, 0);
  cases.back().plan.guides[2] = circle_of(2, -1, false, 0);
  cases.back().plan.guides[6] = circle_of(4, 1, false, 2 * kPi);
  cases.push_back({"with friction", plan, 3});
  for (const int guide : {2, 3, 4, 5, 7}) cases.back().plan.guides[guide].friction = 0.02 * guide;
  cases.push_back({"with friction on pulleys, a grip and a winch", plan, 3});
  cases.back().plan.winches = {{7, way, way.dot(begin[7].position), 0}};
  cases.back().plan.guides[2] = circle_of(2, -1, true, 0);
  cases.back().plan.guides[4] = circle_of(3, -1, false, 0);
  cases.back().plan.guides[4].friction = 0.05;
  cases.back().plan.guides[7].friction = 0.02;
  cases.push_back({"over a pulley that grips", plan, 2});
  cases.back().plan.guides[2] = circle_of(2, -1, true, 0);
  return cases;
}

ForceStep long_step(const LongPoses& poses, const std::vector<Vector6>& velocities, const FunctionStep& function) {
  ForceStep step{poses.begin, poses.end, velocities};
  step.duration = 0.02;
  step.functions = &function;
  return step;
}

// In steps in which the line is taut, becomes slack or taut, or is slack. Both forms are sums of the same terms in
// another order, so that they agree to round-off, of the factors where their product cancels.
TEST(LongTendons, HaveTheSameTangentInPieces) {
  const LongPoses poses = long_poses();
  const std::vector<Vector6> velocities(kNodes, 0.2 * Vector6::Ones());
  for (const LongCase& tested : long_cases(poses.begin)) {
    const Tendon tendon("", tested.plan, {0}, poses.begin);
    const ForcePieces& pieces = tendon.pieces();
    ASSERT_FALSE(pieces.pairs.empty()) << tested.name;
    EXPECT_EQ(pieces.rank, tested.rank) << tested.name;
    const double length = tendon.length_at_start();
    for (const double stretch : {0.05, 1e-3, -0.05})
      for (const bool at_end : {false, true}) {
        const FunctionStep function = tested.plan.has_tension
                                          ? FunctionStep{20, 25, 22}
                                          : FunctionStep{length * (1 - stretch), length * (1 - 0.9 * stretch), length};
        std::vector<double> memory(tendon.memory_size(), 0.0);
        tendon.start(state_at(poses.begin), &function.begin, memory.data());
        ForceStep step = long_step(poses, velocities, function);
        step.at_end = at_end;
        step.memory = memory.data();
        std::vector<double> memories[2] = {memory, memory};
        const auto nodes = tendon.reach().size();
        const auto size = static_cast<Eigen::Index>(6 * nodes);
        Eigen::VectorXd residuals[2] = {Eigen::VectorXd(size), Eigen::VectorXd(size)};
        Eigen::MatrixXd tangent(size, size);
        std::vector<double> numbers(PieceTangent::size(pieces), std::nan(""));
        ForceAction whole{{residuals[0].data(), size}, {tangent.data(), size, size}};
        ForceAction parts{{residuals[1].data(), size}, {nullptr, 0, 0}, PieceTangent::in(numbers.data(), pieces)};
        step.new_memory = memories[0].data();
        evaluate_step(tendon, step, whole);
        step.new_memory = memories[1].data();
        evaluate_step(tendon, step, parts);
        EXPECT_EQ(residuals[0], residuals[1]) << tested.name;
        EXPECT_EQ(memories[0], memories[1]) << tested.name;
        EXPECT_EQ(whole.dissipated, parts.dissipated) << tested.name;
        if (stretch > 0.01 || tested.plan.has_tension) {
          EXPECT_GT(tangent.norm(), 1) << tested.name;
        }
        const double factors = parts.pieces.left.norm() * parts.pieces.right.norm();
        EXPECT_LE((parts.pieces.sum(pieces, nodes) - tangent).norm(), 1e-14 * (tangent.norm() + factors))
            << tested.name;
      }
  }
}

TEST(LongTendons, OverFewNodesHaveOneMatrix) {
  const LongPoses poses = long_poses();
  TendonPlan plan = long_plan();
  plan.guides.resize(5);
  EXPECT_TRUE(Tendon("", plan, {0}, poses.begin).pieces().pairs.empty());
}

}  // namespace
}  // namespace flexarm::test
