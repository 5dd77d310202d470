// Tests tendons as force elements: the tangent against differences, the exact account of a step, momenta.
#include "elements/tendon.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "math/cayley.h"
#include "math/so3.h"
#include "support/node_poses.h"
#include "support/whole_step.h"

namespace flexarm::test {
namespace {

using Poses = std::vector<NodePose>;

GuidePlace circle_on(int node, const Vector3& centre, const Vector3& rotation, double radius, double sense) {
  const Matrix3 axes = so3::exp(rotation);
  return {node, centre, axes.col(0), axes.col(1), radius, sense};
}

/// Residual, tangent and account of a tendon over a step of four nodes.
struct TendonAction {
  Eigen::VectorXd residual;
  Eigen::MatrixXd tangent;
  double dissipated = 0, work = 0;
  std::vector<double> memory;
};

bool has_friction(const TendonPlan& plan) {
  return std::any_of(plan.guides.begin(), plan.guides.end(),
                     [](const TendonGuide& guide) { return guide.friction > 0; });
}

struct TendonCase {
  std::string name;
  TendonPlan plan;
  FunctionStep function;  // rest length or tension
};

TendonGuide guide_at(int node, const Vector3& at) {
  return {{node, at}};
}

std::vector<TendonCase> tendon_cases() {
  const TendonGuide start = guide_at(0, {0.1, 0, 0.05}), middle = guide_at(1, {0, 0.1, 0.02}),
                    end = guide_at(2, {-0.1, 0.05, 0});
  const TendonGuide pulley{circle_on(1, {0.02, 0, 0.01}, {0.1, 0.2, -0.4}, 0.12, -1), false, 1};
  TendonGuide grip = pulley, drum{circle_on(2, {0, 0.02, 0.01}, {0.3, -0.2, 0.1}, 0.1, 1), true};
  grip.grips = true;
  TendonGuide rough = middle, rough_pulley = pulley;
  rough.friction = 1e-3;  // little enough to slip in this step
  rough_pulley.friction = 1e-3;
  const TendonLaw law{300, 0}, damped{300, 4};
  const TendonWinch winch{3, Vector3(0.6, 0, 0.8), 0.05, 0};
  const FunctionStep taut{1.5, 1.47, 1.485}, slack{4, 4.1, 4.05}, pull{20, 26, 23};
  return {
      {"vias", {{start, middle, end}, {}, false, law}, taut},
      {"slack", {{start, middle, end}, {}, false, damped}, slack},
      {"damped", {{start, middle, end}, {}, false, damped}, taut},
      {"from the world", {{guide_at(-1, {-0.5, 0.2, 0.3}), middle, end}, {}, false, law}, taut},
      {"of given tension", {{start, pulley, end}, {}, true}, pull},
      {"over a pulley", {{start, pulley, end}, {}, false, law}, taut},
      {"over a pulley that grips", {{start, grip, end}, {}, false, damped}, taut},
      {"with friction at a via", {{start, rough, end}, {}, false, law}, taut},
      {"with friction on a pulley", {{start, rough_pulley, end}, {}, false, law}, taut},
      {"to a drum", {{start, pulley, drum}, {}, false, law}, taut},
      {"with a winch", {{start, pulley, drum}, {winch}, false, damped}, taut},
  };
}

const Poses kTendonBegin{turned_node({0, 0, 0}, {0.2, 0.1, -0.3}), turned_node({0.7, 0.5, 0.1}, {-0.1, 0.5, 0.2}),
                         turned_node({1.4, -0.1, -0.2}, {0.1, 0.2, 0.3}), turned_node({0.1, 0, 0.02}, {0, 0, 0})};
const Poses kTendonEnd{turned_node({0.02, -0.01, 0.03}, {0.25, 0.05, -0.3}),
                       turned_node({0.74, 0.53, 0.15}, {-0.1, 0.6, 0.25}),
                       turned_node({1.45, -0.12, -0.15}, {0.05, 0.25, 0.35}), turned_node({0.13, 0, 0.04}, {0, 0, 0})};

TendonAction action_of(const Tendon& tendon, const TendonCase& tested, const Poses& end, bool at_end) {
  const std::vector<Vector6> velocities(4, 0.3 * Vector6::Ones());
  std::vector<double> memory(tendon.memory_size(), 0.0);
  tendon.start(state_at(kTendonBegin), &tested.function.begin, memory.data());
  ForceStep step{kTendonBegin, end, velocities};
  step.duration = 0.05;
  step.at_end = at_end;
  if (at_end) step.gamma = 0.6;
  step.memory = memory.data();
  step.functions = &tested.function;
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(tendon.reach().size());
  TendonAction out{Eigen::VectorXd(size), Eigen::MatrixXd(size, size), 0, 0, memory};
  step.new_memory = out.memory.data();
  ForceAction action{{out.residual.data(), size}, {out.tangent.data(), size, size}};
  evaluate_step(tendon, step, action);
  out.dissipated = action.dissipated;
  out.work = action.work;
  return out;
}

class TendonElements : public ::testing::TestWithParam<bool> {};

// Central differences with the step 1e-6: truncation of 1e-12 times third derivatives of forces of up to 100 N over
// lengths of 0.1 m, round-off of 1e-16 / 1e-6 times the forces.
TEST_P(TendonElements, HaveTheirTangent) {
  constexpr double h = 1e-6;
  for (const TendonCase& tested : tendon_cases()) {
    const Tendon tendon("", tested.plan, {0}, kTendonBegin);
    // The tangent leaves out how angles of contact change, so friction is not tested here.
    if (has_friction(tested.plan)) continue;
    const TendonAction here = action_of(tendon, tested, kTendonEnd, GetParam());
    for (int k = 0; k < here.residual.size(); ++k) {
      const auto residual = [&](double way) {
        Vector6 by = Vector6::Zero();
        by[k % 6] = way;
        Poses at = kTendonEnd;
        at[tendon.reach()[k / 6]] = moved(at[tendon.reach()[k / 6]], by);
        return action_of(tendon, tested, at, GetParam()).residual;
      };
      const Eigen::VectorXd difference = (residual(h) - residual(-h)) / (2 * h);
      EXPECT_LE((difference - here.tangent.col(k)).norm(), 1e-7 * (1 + here.tangent.norm())) << tested.name << k;
    }
  }
}

TEST_P(TendonElements, AddToNoMomentum) {
  for (const TendonCase& tested : tendon_cases()) {
    const Tendon tendon("", tested.plan, {0}, kTendonBegin);
    if (tested.plan.guides[0].place.node < 0 || !tested.plan.winches.empty()) continue;  // the world takes momentum
    const TendonAction here = action_of(tendon, tested, kTendonEnd, GetParam());
    Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
    const double weight = GetParam() ? 1 : 0.5;
    for (std::size_t i = 0; i < tendon.reach().size(); ++i) {
      const int node = tendon.reach()[i];
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
      const Vector3 position = (1 - weight) * kTendonBegin[node].position + weight * kTendonEnd[node].position;
      force += here.residual.segment<3>(row);
      moment += position.cross(Vector3(here.residual.segment<3>(row))) + here.residual.segment<3>(row + 3);
    }
    EXPECT_LE(force.norm(), 1e-13) << tested.name;  // forces of up to 100 N
    EXPECT_LE(moment.norm(), 1e-13) << tested.name;
  }
}

// What the mean forces do on the nodes is the change of the energy and what is dissipated, less the work from outside.
TEST(TendonAccount, OfMeansKeepTheAccount) {
  for (const TendonCase& tested : tendon_cases()) {
    const Tendon tendon("", tested.plan, {0}, kTendonBegin);
    const TendonAction here = action_of(tendon, tested, kTendonEnd, false);
    double work = 0;
    for (std::size_t i = 0; i < tendon.reach().size(); ++i) {
      const int node = tendon.reach()[i];
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
      work += here.residual.segment<3>(row).dot(kTendonEnd[node].position - kTendonBegin[node].position) +
              here.residual.segment<3>(row + 3).dot(
                  cayley::increment(kTendonBegin[node].orientation, kTendonEnd[node].orientation));
    }
    std::vector<double> before(tendon.memory_size(), 0.0);
    tendon.start(state_at(kTendonBegin), &tested.function.begin, before.data());
    const double change =
        tendon.energy(state_at(kTendonEnd), here.memory.data()) - tendon.energy(state_at(kTendonBegin), before.data());
    EXPECT_NEAR(work, change + here.dissipated - here.work, 1e-12) << tested.name;  // energies of up to 10 J
    // Of these cases only those with a damper or with friction dissipate: friction is so small that the line slips.
    const bool is_slack = tested.name == "slack";
    const bool dissipates = !is_slack && (tested.plan.law.damping > 0 || has_friction(tested.plan));
    if (dissipates) {
      EXPECT_GT(here.dissipated, 1e-6) << tested.name;
    } else {
      EXPECT_NEAR(here.dissipated, 0, 1e-15) << tested.name;
    }
  }
}

// A line up to a pulley that grips and down again, just taut. The pulley turns with the line by an angle a: it takes r
// a from the part before it, whose tension becomes EA r a / (1 - r a), and gives it to the part behind it, which is
// slack.
TEST(TendonRims, CarryTheLineFromOnePartToTheOther) {
  const double radius = 0.1, angle = 0.02, stiffness = 300;
  for (const double side : {-1.0, 1.0}) {  // the line begins on the left, and turns clockwise; or the other way round
    TendonGuide pulley{{1, {0, 0, 0}, Vector3::UnitX(), Vector3::UnitY(), radius, side}, true};
    const Poses begin{turned_node({side * radius, -1, 0}, {0, 0, 0}), turned_node({0, 0, 0}, {0, 0, 0}),
                      turned_node({-side * radius, -1, 0}, {0, 0, 0})};
    Poses end = begin;
    end[1] = turned_node({0, 0, 0}, {0, 0, side * angle});
    const Tendon tendon("", {{guide_at(0, {0, 0, 0}), pulley, guide_at(2, {0, 0, 0})}, {}, false, {stiffness, 0}}, {},
                        begin);
    std::vector<double> memory(tendon.memory_size(), 0.0), after = memory;
    tendon.start(state_at(begin), nullptr, memory.data());
    const std::vector<Vector6> still(3, Vector6::Zero());
    ForceStep step{begin, end, still};
    step.duration = 0.01;
    step.at_end = true;
    step.memory = memory.data();
    step.new_memory = after.data();
    Eigen::VectorXd residual(18);
    ForceAction action{{residual.data(), 18}, {nullptr, 0, 0}};
    evaluate_step(tendon, step, action);
    const double tension = stiffness * radius * angle / (1 - radius * angle);
    EXPECT_NEAR(residual[1], -tension, 1e-12);
    EXPECT_EQ(residual[13], 0);
    // What is wound up is unstretched: EA (e + e^2 / 2) turns the pulley back.
    EXPECT_NEAR(residual[11], side * radius * tension * (1 + 0.5 * tension / stiffness), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(MeansAndEnds, TendonElements, ::testing::Bool());

}  // namespace
}  // namespace flexarm::test
