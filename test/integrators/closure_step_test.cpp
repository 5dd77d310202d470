// Tests whole steps of mechanisms whose loops are closed by multipliers.
#include "integrators/consistent_tangent.h"
#include "integrators/mechanism.h"
#include "joints/kinematics.h"
#include "support/closed_ring.h"
#include "support/scheme_variants.h"

namespace flexarm {
namespace {

using namespace test;
using scene::JointKind;

/// A ring of rigid bodies with a beam fixed to one of them.
Model ring_with_beam(JointKind kind) {
  SceneBuilder builder = free_ring(kind);
  builder.beam("flag", {Vector3(0.5, 0.1, 0)}, test::section(40, 20, 6, 8, 1.4, 0.2, 0.1), 1, 2);
  builder.joint("flag", JointKind::Spherical, "left_end", "flag", Vector3(0.1, 0, 0));
  return build_model(builder.scene);
}

class ClosedStep : public ::testing::TestWithParam<std::tuple<JointKind, const char*>> {};

TEST_P(ClosedStep, TangentOfAStep) {
  const auto [kind, name] = GetParam();
  const Model model = ring_with_beam(kind);
  ASSERT_FALSE(model.closures.at(0).constraints.empty());
  RandomSource random(5);
  StepSystem system(model, *find_scheme(name), BackendChoice::Matrix);
  State state = random_state(model, random, 0.15);
  system.initialise(state);
  system.begin(state, 0.2, Guess::Extrapolated);
  system.update(random_update(system.degrees_of_freedom().unknowns, random, 0.1));
  Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(system.degrees_of_freedom().unknowns);
  for (const int equation : multiplier_equations(model, system.degrees_of_freedom()))
    multipliers[equation] = 20 * random.number();
  system.update(multipliers);
  expect_consistent_tangent(system, 0.25);
}
INSTANTIATE_TEST_SUITE_P(
    KindsAndSchemes, ClosedStep,
    ::testing::Combine(::testing::Values(JointKind::Fixed, JointKind::Continuous, JointKind::Prismatic,
                                         JointKind::Spherical, JointKind::Universal, JointKind::Cylindrical,
                                         JointKind::PinSlot, JointKind::Planar),
                       ::testing::Values("em", "edmc2", "m1", "std", "newmark", "hht1", "hht2", "hht3")));

// The norm of an update is a length. A multiplier enters it by the distance that its force moves the mechanism in a
// step, h^2 / mass times the multiplier, relative to the scene's length.
TEST(ClosedStep, MultipliersCountInNormsByTheirWay) {
  const Model model = ring_with_beam(JointKind::Fixed);
  StepSystem system(model, *find_scheme("em"), BackendChoice::Matrix);
  const DegreesOfFreedom& dof = system.degrees_of_freedom();
  EXPECT_EQ(multiplier_equations(model, dof).front(), dof.unknowns - 6);
  Eigen::VectorXd increment = Eigen::VectorXd::Zero(dof.unknowns);
  increment.tail<6>().setConstant(1e6);
  double mass = 0;
  for (const NodalInertia& inertia : model.inertias) mass += inertia.total_mass;
  for (const double step : {0.1, 0.01}) {
    State state = initial_state(model);
    system.begin(state, step, Guess::Unchanged);
    const double way = 1e6 * step * step / (mass * model.length_scale), arm = std::max(1.0, 1 / model.length_scale);
    EXPECT_NEAR(system.scales().norm(increment, step), way * arm, 1e-12 * way);
  }
  EXPECT_EQ(system.scales().largest_rotation(increment), 0);
  EXPECT_EQ(system.scales().norm(increment, 0), 0) << "statics";
}

}  // namespace
}  // namespace flexarm
