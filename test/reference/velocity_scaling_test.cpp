// em_scaled closes the energy by scaling what the supports do not let move rigidly: energy exact, and every momentum
// that the supports leave alone. Free trees: conservation_free_flight_test.cpp.
#include <cstdio>

#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

constexpr int kSteps = 1000;
constexpr double kStep = 0.02;

const Vector3 kAxis = Vector3(2, 1, 2) / 3;

struct Support {
  std::string name;
  JointKind kind;
  std::string root_coordinate;               ///< set into motion; empty: none
  bool turns_about_axis, slides_along_axis;  ///< momenta that the support leaves alone
  bool turns_freely = false;                 ///< about the origin
  friend std::ostream& operator<<(std::ostream& out, const Support& s) { return out << s.name; }
};

SceneBuilder supported_tree(const Support& support) {
  SceneBuilder b = free_tree(JointKind::Revolute);
  scene::JointDescription& root = b.scene.joints.front();
  root.kind = support.kind;
  root.axis = kAxis;
  b.scene.initial_links.clear();
  if (!support.root_coordinate.empty()) initial_joint(b, support.root_coordinate, 0.1, 0.8);
  initial_joint(b, "shoulder", 0.2, 1.5);
  initial_joint(b, "mount", -0.1, -1);
  return b;
}

class VelocityScaling : public ::testing::TestWithParam<Support> {};

// A step rounds the energies that it compares, ten operations each; and the velocities, by 2 r epsilon / h.
TEST_P(VelocityScaling, KeepsEnergyAndTheMomentaOfTheSupport) {
  const Support support = GetParam();
  Simulation simulation(supported_tree(support).scene, options("em_scaled", kStep, 1e-10));
  Simulation control(supported_tree(support).scene, options("em0", kStep, 1e-10));
  InvariantDrift drift(simulation), control_drift(control);
  const Vector3 linear = simulation.momentum(), angular = simulation.angular_momentum();
  double about_axis = 0, along_axis = 0, about_origin = 0;
  run(control, kSteps, [&] { control_drift.observe(); });
  run(simulation, kSteps, [&] {
    drift.observe();
    about_axis = std::max(about_axis, std::abs(kAxis.dot(simulation.angular_momentum() - angular)));
    along_axis = std::max(along_axis, std::abs(kAxis.dot(simulation.momentum() - linear)));
    about_origin = std::max(about_origin, (simulation.angular_momentum() - angular).norm());
    EXPECT_EQ(state_of(simulation).energy_defect, 0);
  });
  double extent = 0;
  for (const NodeState& node : state_of(simulation).nodes) extent = std::max(extent, node.position.norm());
  const double mass = total_mass(simulation), velocity = 10 * 2 * extent * kEpsilon / kStep;
  const double bound = kSteps * mass * velocity;
  std::printf("%s: energy %.1e (em0: %.1e), angular momentum about the axis %.1e, momentum along it %.1e of %.1e\n",
              support.name.c_str(), drift.energy(), control_drift.energy(), about_axis, along_axis, bound);
  EXPECT_LT(drift.energy(), 10 * kEpsilon * kSteps);
  EXPECT_GT(control_drift.energy(), 1e4 * kEpsilon * kSteps) << "there must be something to close";
  if (support.turns_about_axis) {
    EXPECT_LT(about_axis, bound * extent);
  }
  if (support.slides_along_axis) {
    EXPECT_LT(along_axis, bound);
  }
  if (support.turns_freely) {
    EXPECT_LT(about_origin, bound * extent);
  } else {
    EXPECT_GT(about_origin, 1e-3) << "the support must take momentum";
  }
}

// With gravity, drives, loads and damping the same holds for total - work + dissipated.
TEST_P(VelocityScaling, ClosesTheBudget) {
  SceneBuilder b = supported_tree(GetParam());
  b.scene.gravity = {0.5, 0, -2};
  b.load("branch", {0.5, 2, 0.3}, {1, 2, 3}, {0.1, 0.2, 0.3}, "sin(t)");
  b.load("trunk", {2, 0, 0}, {0, 1, 0}, Vector3::Zero(), "1", scene::LoadFrame::Follower);
  b.scene.efforts.push_back({"shoulder", TimeFunction::parse("2*cos(t)"), {}});
  b.scene.joints[1].damping = 0.3;
  for (scene::LinkDescription& link : b.scene.links)
    if (link.beam) link.beam->stiffness_proportional_damping = 1e-4;
  Simulation simulation(b.scene, options("em_scaled", kStep, 1e-10));
  InvariantDrift drift(simulation);
  run(simulation, kSteps, [&] { drift.observe(); });
  std::printf("%s: budget %.1e\n", GetParam().name.c_str(), drift.energy());
  EXPECT_LT(drift.energy(), 10 * kEpsilon * kSteps);
}

INSTANTIATE_TEST_SUITE_P(Supports, VelocityScaling,
                         ::testing::Values(Support{"clamped", JointKind::Fixed, "", false, false},
                                           Support{"hinged", JointKind::Revolute, "free", true, false},
                                           Support{"on_a_rail", JointKind::Prismatic, "free", false, true},
                                           Support{"on_a_pivot", JointKind::Spherical, "free/rz", true, false, true},
                                           Support{"in_a_sleeve", JointKind::Cylindrical, "", true, true}),
                         [](const auto& info) { return info.param.name; });

TEST(VelocityScalingOfMotions, IsRefused) {
  SceneBuilder b = free_tree(JointKind::Revolute);
  b.scene.motions.push_back({"shoulder", TimeFunction::parse("0.4*sin(2*t)"), {}});
  try {
    const Simulation simulation(b.scene, options("em_scaled", kStep));
    FAIL() << "a prescribed velocity cannot be scaled";
  } catch (const ModelError& error) {
    const std::string what = error.what();
    for (const char* part : {"em_scaled", "<motion>", "shoulder"})
      EXPECT_NE(what.find(part), std::string::npos) << what;
  }
  EXPECT_NO_THROW(Simulation(b.scene, options("em", kStep)));
}

}  // namespace
}  // namespace flexarm::test
