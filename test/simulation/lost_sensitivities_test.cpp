// Tests runs without sensitivities: requests that are refused, and events in a run after which derivatives are lost.
#include <cmath>

#include <gtest/gtest.h>

#include "flexarm/model/model_error.h"
#include "simulation/sensitivity_scenes.h"
#include "support/refusal.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

std::string refusal_by(const Scene& scene, const std::string& parameter) {
  Simulation simulation = scene.simulation();
  return refusal<std::invalid_argument>([&] { Sensitivities(simulation, scene.request({parameter})); });
}

TEST(LostSensitivities, ParametersThatHaveNoneAreRefused) {
  const Scene scene{with_scheme(flexible_arm("0 0 1"), "em", 2e-3)};
  EXPECT_EQ(refusal_by(scene, "stiffnes"),
            "unknown parameter 'stiffnes': expected one of young, payload, damping, length, elements, turn");
  expect_contains(refusal_by(scene, "elements"),
                  "the run cannot be differentiated with respect to parameter 'elements'");
  std::string text = with_scheme(kPendulum, "em", 5e-3);
  const std::string step = "step=\"0.005\"";
  text.replace(text.find(step), step.size(), "step=\"${0.0025*payload}\"");
  expect_contains(refusal_by({text}, "payload"), "it changes the <integrator>");
}

TEST(LostSensitivities, WhereAStepFails) {
  const Scene scene{
      rod_with_stop(3, "0 0 -9.81", "scheme=\"em\" step=\"0.5\" max_iterations=\"1\" max_halvings=\"0\"")};
  Simulation simulation = scene.simulation();
  Sensitivities sensitivities(simulation, scene.request({"speed"}));
  EXPECT_FALSE(sensitivities.step().converged);
  EXPECT_EQ(sensitivities.lost(), "the step to t = 0.5 s has failed");
  EXPECT_TRUE(sensitivities.velocities().array().isNaN().all());
  EXPECT_EQ(simulation.time(), 0);
}

// The slider leaves the rail at its end, 0.1 m ahead, in the fourth step.
TEST(LostSensitivities, WhereASliderLeavesItsLine) {
  const Scene scene{R"(<robot name="rail"> <parameter name="speed" value="3"/> <link name="world"/>
    <joint name="mount" type="fixed"> <parent link="world"/> <child link="rail"/> </joint>
    <link name="rail"> <beam elements="2"> <centerline> <line to="1 0 0"/> </centerline> <circle radius="0.02"/>
      <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
    <joint name="runner" type="floating"> <parent link="rail"/> <child link="mass"/>
      <slide start="0.9" on_end="free"/> </joint>
    <link name="mass"> <inertial> <mass value="0.3"/>
      <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <simulation> <gravity xyz="0 0 0"/> <initial joint="runner/s" position="0.9" velocity="${speed}"/>
      <integrator scheme="em" step="0.01"/> </simulation> </robot>)"};
  Simulation simulation = scene.simulation();
  Sensitivities sensitivities(simulation, scene.request({"speed"}));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(sensitivities.step().converged);
  EXPECT_EQ(sensitivities.lost(), "");
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(sensitivities.step().converged);
  EXPECT_EQ(sensitivities.lost(), "a slider has left its line before t = 0.04 s");
}

// A stiff cantilever under a step force, with steps of several periods of its lowest mode, as in recovery_test.cpp.
TEST(LostSensitivities, WhereAStepIsDoneByAnotherScheme) {
  constexpr double kStep = 1.8;
  SceneBuilder b;
  b.beam("arm", {{1, 0, 0}}, section(1e5, 3.5e4, 0.8, 1, 1, 2e-5, 1e-5), 8, 2);
  b.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  b.load("arm", {1, 0, 0}, {0, 0, 1});
  b.scene.gravity.setZero();
  b.scene.integrator.step = kStep;
  b.scene.integrator.max_iterations = 6;
  b.scene.integrator.max_halvings = 0;
  b.scene.integrator.on_failure = OnFailure::Dissipate;
  b.scene.parameters.push_back({"nothing", 1});
  SensitivityRequest request{{"nothing"}, [&](const std::string&, double) {
                               scene::ReadResult result;
                               result.scene = b.scene;
                               return result;
                             }};
  Simulation simulation(b.scene);
  Sensitivities sensitivities(simulation, request);
  StepResult result;
  while (simulation.time() < 60 * kStep && !result.is_dissipated) {
    const double begin = simulation.time();
    EXPECT_EQ(sensitivities.lost(), "");
    result = sensitivities.step();
    if (result.is_dissipated) {
      EXPECT_EQ(sensitivities.lost(),
                fmt::format("the step to t = {:.9g} s was done by another scheme", begin + kStep));
    }
    ASSERT_TRUE(result.converged);
  }
  EXPECT_TRUE(result.is_dissipated) << "this test wants a scene that em cannot do in so long steps";
}

TEST(LostSensitivities, RunThatHasBegunIsRefused) {
  const Scene scene{with_scheme(kPendulum, "em", 5e-3)};
  Simulation simulation = scene.simulation();
  simulation.step();
  EXPECT_THROW(Sensitivities(simulation, scene.request({"payload"})), std::invalid_argument);
  simulation.reset();
  Sensitivities sensitivities(simulation, scene.request({"payload"}));
  sensitivities.step();
  simulation.step();
  EXPECT_THROW(sensitivities.step(), std::logic_error);
}

TEST(LostSensitivities, IterativeInterpolationIsRefused) {
  std::string text = with_scheme(flexible_arm("0 0 1"), "newmark", 5e-3);
  const std::string scheme = "scheme=\"newmark\"";
  text.replace(text.find(scheme), scheme.size(), scheme + " interpolation=\"iterative\"");
  const Scene scene{text};
  Simulation simulation = scene.simulation();
  EXPECT_THROW(Sensitivities(simulation, scene.request({"payload"})), ModelError);
}

}  // namespace
}  // namespace flexarm::test
