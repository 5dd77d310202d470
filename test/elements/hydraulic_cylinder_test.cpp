// Tests the oil of a cylinder as a force element: the tangent against differences, the exact account of a step,
// momenta.
#include "elements/hydraulic_cylinder.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "math/cayley.h"
#include "math/so3.h"
#include "support/node_poses.h"

namespace flexarm::test {
namespace {

using OilPoses = std::vector<NodePose>;

struct OilElementCase {
  std::string name;
  CylinderPlan plan;
  double flow = 0;  // mean over the step [m^3/s]
};

// The barrel is on node 0, the rod on node 1, the pump on node 2. Pressures and areas give forces of some 100 N.
CylinderPlan oil_plan(double pressure, double relief = 0, bool makes_up = false) {
  CylinderPlan plan;
  plan.barrel = {0, {0.1, 0, 0.05}};
  plan.rod = {1, {0, 0.1, 0.02}};
  plan.pump = {2, 0.05, 0};
  for (int i = 0; i < 2; ++i) {
    CylinderPlan::Chamber& chamber = plan.chambers[i];
    chamber.oil.bulk_modulus = 1e6;
    if (relief > 0) chamber.oil.relief_pressure = relief;
    chamber.oil.makes_up = makes_up;
    chamber.area = i == 0 ? 2e-3 : -1.5e-3;
    chamber.volume = i == 0 ? 1e-4 : 3e-3;
    chamber.start_pressure = pressure;
  }
  return plan;
}

std::vector<OilElementCase> oil_cases() {
  CylinderPlan on_world = oil_plan(2e5), still = oil_plan(2e5);
  on_world.barrel = {-1, {-0.1, 0.2, 0.1}};
  still.pump = {-1, 0, 0};
  return {{"closed", oil_plan(2e5)},           {"with a flow", oil_plan(2e5), 3e-4},
          {"on the world", on_world},          {"without a pump", still, 2e-4},
          {"void on one side", oil_plan(1e3)}, {"void that is filled", oil_plan(1e3, 0, true)},
          {"relieved", oil_plan(2e5, 2.02e5)}};
}

const OilPoses kOilBegin{turned_node({0, 0, 0}, {0.2, 0.1, -0.3}), turned_node({0.7, 0.5, 0.1}, {-0.1, 0.5, 0.2}),
                         turned_node({0.1, 0, 0.02}, {0, 0, 0})};
const OilPoses kOilEnd{turned_node({0.02, -0.01, 0.03}, {0.25, 0.05, -0.3}),
                       turned_node({0.74, 0.53, 0.15}, {-0.1, 0.6, 0.25}), turned_node({0.13, 0, 0.04}, {0, 0, 0})};

struct OilAction {
  Eigen::VectorXd residual;
  Eigen::MatrixXd tangent;
  double dissipated = 0, work = 0;
  std::vector<double> memory;
};

std::vector<int> functions_of(const OilElementCase& tested) {
  return tested.flow == 0 ? std::vector<int>{} : std::vector<int>{0};
}

OilAction action_of(const HydraulicCylinder& cylinder, const OilElementCase& tested, const OilPoses& end, bool at_end) {
  const std::vector<Vector6> still(3, Vector6::Zero());
  std::vector<double> memory(2);
  cylinder.start(state_at(kOilBegin), nullptr, memory.data());
  const FunctionStep flow{tested.flow, tested.flow, tested.flow};
  ForceStep step{kOilBegin, end, still};
  step.duration = 0.05;
  step.at_end = at_end;
  step.memory = memory.data();
  step.functions = &flow;
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(cylinder.reach().size());
  OilAction out{Eigen::VectorXd(size), Eigen::MatrixXd(size, size), 0, 0, memory};
  step.new_memory = out.memory.data();
  ForceAction action{{out.residual.data(), size}, {out.tangent.data(), size, size}};
  cylinder.evaluate(step, cylinder.reach().data(), action);
  out.dissipated = action.dissipated;
  out.work = action.work;
  return out;
}

class HydraulicElements : public ::testing::TestWithParam<bool> {};

// Central differences with the step 1e-6: truncation of 1e-12 times third derivatives of forces of up to 500 N over
// lengths of 0.1 m, round-off of 1e-16 / 1e-6 times the forces.
TEST_P(HydraulicElements, HaveTheirTangent) {
  constexpr double h = 1e-6;
  for (const OilElementCase& tested : oil_cases()) {
    const HydraulicCylinder cylinder("", tested.plan, functions_of(tested));
    const OilAction here = action_of(cylinder, tested, kOilEnd, GetParam());
    EXPECT_GT(here.tangent.norm(), 100) << tested.name;
    for (int k = 0; k < here.residual.size(); ++k) {
      const auto residual = [&](double way) {
        Vector6 by = Vector6::Zero();
        by[k % 6] = way;
        OilPoses at = kOilEnd;
        at[cylinder.reach()[k / 6]] = moved(at[cylinder.reach()[k / 6]], by);
        return action_of(cylinder, tested, at, GetParam()).residual;
      };
      const Eigen::VectorXd difference = (residual(h) - residual(-h)) / (2 * h);
      EXPECT_LE((difference - here.tangent.col(k)).norm(), 1e-7 * here.tangent.norm()) << tested.name << k;
    }
  }
}

TEST_P(HydraulicElements, AddToNoMomentum) {
  for (const OilElementCase& tested : oil_cases()) {
    if (tested.plan.barrel.node < 0) continue;
    const HydraulicCylinder cylinder("", tested.plan, functions_of(tested));
    const OilAction here = action_of(cylinder, tested, kOilEnd, GetParam());
    Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
    const double weight = GetParam() ? 1 : 0.5;
    for (std::size_t i = 0; i < 2; ++i) {  // the pump pushes against the world
      const int node = cylinder.reach()[i];
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
      const Vector3 position = (1 - weight) * kOilBegin[node].position + weight * kOilEnd[node].position;
      force += here.residual.segment<3>(row);
      moment += position.cross(Vector3(here.residual.segment<3>(row))) + here.residual.segment<3>(row + 3);
    }
    EXPECT_LE(force.norm(), 1e-12) << tested.name;  // forces of up to 500 N
    EXPECT_LE(moment.norm(), 1e-12) << tested.name;
  }
}

// What the mean forces do on the nodes is the change of the energy and what is dissipated, less the pump's work.
TEST(HydraulicElement, KeepsTheAccountOverMeans) {
  for (const OilElementCase& tested : oil_cases()) {
    const HydraulicCylinder cylinder("", tested.plan, functions_of(tested));
    const OilAction here = action_of(cylinder, tested, kOilEnd, false);
    double work = 0;
    for (std::size_t i = 0; i < cylinder.reach().size(); ++i) {
      const int node = cylinder.reach()[i];
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
      work += here.residual.segment<3>(row).dot(kOilEnd[node].position - kOilBegin[node].position) +
              here.residual.segment<3>(row + 3).dot(
                  cayley::increment(kOilBegin[node].orientation, kOilEnd[node].orientation));
    }
    std::vector<double> before(2);
    cylinder.start(state_at(kOilBegin), nullptr, before.data());
    const double change =
        cylinder.energy(state_at(kOilEnd), here.memory.data()) - cylinder.energy(state_at(kOilBegin), before.data());
    EXPECT_NEAR(work, change + here.dissipated - here.work, 1e-12) << tested.name;  // energies of up to 100 J
    EXPECT_EQ(here.dissipated > 0, tested.name == "relieved") << tested.name;
    EXPECT_EQ(here.work != 0, tested.flow != 0) << tested.name;
  }
}

// A way of the pump and the same way of the piston leave the pressures as they are, but for the oil that is compressed.
TEST(HydraulicElement, MovesAsThePumpDoes) {
  const OilElementCase tested{"", oil_plan(1e3)};
  const HydraulicCylinder cylinder("", tested.plan, {});
  OilPoses end = kOilBegin;
  const LineEnds line(tested.plan.rod, tested.plan.barrel, kOilBegin);
  const double way = 0.1;
  end[1] = moved(end[1], (Vector6() << way * line.distance.normalized(), 0, 0, 0).finished());
  end[2].position.x() += way;
  const OilAction here = action_of(cylinder, tested, end, true);
  for (int i = 0; i < 2; ++i) {
    const CylinderPlan::Chamber& chamber = tested.plan.chambers[i];
    const double volume = chamber.volume + chamber.area * (line.length() + way);
    const double content = here.memory[i] + chamber.area * (end[2].position.x() - 0.05);
    // A pressure of 1e3 Pa makes the oil 1e-3 of the volume that has come, too small or too large.
    EXPECT_NEAR(chamber.oil.pressure(volume, content), 1e3, 1e3 * std::abs(chamber.area) * way / volume);
  }
}

TEST(HydraulicElement, KeepsItsOilWhenTheMechanismChanges) {
  const OilElementCase tested{"", oil_plan(2e5, 2.02e5)};
  const HydraulicCylinder cylinder("", tested.plan, {}), other("", tested.plan, {});
  const std::vector<double> old = action_of(cylinder, tested, kOilEnd, false).memory;
  for (const HydraulicCylinder* before : {&cylinder, &other}) {
    std::vector<double> memory(2);
    cylinder.start(state_at(kOilEnd), nullptr, memory.data());
    EXPECT_NE(memory, old);
    cylinder.carry(*before, old.data(), state_at(kOilEnd), memory.data());
    EXPECT_EQ(memory, old);
  }
}

// The second derivatives of the energy with respect to motions without rotations, along a line through both points.
TEST(HydraulicElement, HasTheStiffnessOfItsMeasures) {
  for (const double pressure : {2e5, 0.0}) {
    const OilElementCase tested{"", oil_plan(pressure)};
    const HydraulicCylinder cylinder("", tested.plan, {});
    std::vector<double> memory(2);
    cylinder.start(state_at(kOilBegin), nullptr, memory.data());
    const ForceMeasures measures = cylinder.measures(state_at(kOilBegin), memory.data(), cylinder.reach().data());
    const Vector3 along = LineEnds(tested.plan.rod, tested.plan.barrel, kOilBegin).distance.normalized();
    Eigen::VectorXd motion = Eigen::VectorXd::Zero(18);
    motion.head<3>() = 0.7 * along;  // the rod, of the nodes rod, barrel, pump
    motion[12] = 1.3;
    const auto energy = [&](double way) {
      OilPoses at = kOilBegin;
      at[1] = moved(at[1], way * motion.head<6>());
      at[2] = moved(at[2], way * motion.tail<6>());
      return cylinder.energy(state_at(at), memory.data());
    };
    constexpr double h = 1e-5;
    const double second = (energy(h) - 2 * energy(0) + energy(-h)) / (h * h);
    const double expected = (measures.rows * motion).dot(measures.stiffness * measures.rows * motion);
    EXPECT_NEAR(pressure > 0 ? second : 0, expected, 1e-4 * expected);  // without pressure neither side is stiff
  }
}

INSTANTIATE_TEST_SUITE_P(MeansAndEnds, HydraulicElements, ::testing::Bool());

}  // namespace
}  // namespace flexarm::test
