// Tests estimates of the errors of beam meshes against the exact error of a cantilever, and the choice of meshes.
#include "accuracy/mesh_errors.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "accuracy/automatic_meshes.h"
#include "accuracy/ramped_cantilever.h"
#include "support/scene_text.h"

namespace flexarm {
namespace {

using test::kOneSecond;
using test::kRampRms;
using test::linear_element_error;
using test::ramped_cantilever;

constexpr double kWay = 0.01;  // displacement of the tip [m]

MeshErrors measured(TrialRuns& trials, double wanted) {
  RunSettings settings = settings_of(trials.scene());
  MeshFreedom freedom;
  freedom.is_free = {true};
  freedom.keeps_orders = true;
  return measure_meshes(trials, settings, freedom, wanted * kWay);
}

// Effects that the formula neglects: large rotations, (0.01)^2; inertia, 1e-4; shear, 3e-5; the step, (pi h / T)^2 / 12
// = 1e-4.
constexpr double kLeftOut = 1e-3;

TEST(MeshErrors, AreThoseOfTheDeflection) {
  TrialRuns trials(ramped_cantilever("order=\"1\""), kOneSecond, {}, {}, {});
  const MeshErrors errors = measured(trials, 1e-3);
  EXPECT_TRUE(errors.is_rich_enough) << errors.shortcoming;
  ASSERT_EQ(errors.beams.size(), 1u);
  ASSERT_GT(errors.beams[0].size(), 4u);
  for (const MeshError& mesh : errors.beams[0]) {
    const double expected = linear_element_error(*mesh.mesh.elements) * kRampRms;
    EXPECT_NEAR(size(mesh.error) / kWay, expected, kLeftOut * (expected + kRampRms)) << mesh.mesh.text();
  }
  // The two finest meshes are good enough: the error is below 1e-3 for 8 elements and more.
  EXPECT_LE(size(errors.beams[0].back().error), 1e-3 * kWay);
}

/// Elements of order 2 and more give the static tip exactly, since they represent the cubic deflection at every node.
TEST(MeshErrors, VanishWhereElementsAreExact) {
  for (const char* mesh : {"order=\"2\"", "order=\"3\""}) {
    TrialRuns trials(ramped_cantilever(mesh), kOneSecond, {}, {}, {});
    const MeshErrors errors = measured(trials, 1e-2);
    for (const MeshError& error : errors.beams.at(0))
      EXPECT_LE(size(error.error), kLeftOut * kWay) << error.mesh.text();
  }
}

TEST(MeshErrors, OfARigidBeamAreAllThatItBends) {
  // The hinge is held by a motion, because a rigid link that is fixed to the world takes no loads.
  scene::SceneDescription scene = ramped_cantilever("");
  scene.joints[0].kind = scene::JointKind::Revolute;
  scene.joints[0].axis = Vector3::UnitY();
  scene.motions.push_back({"clamp", TimeFunction(0.0), {}});
  TrialRuns trials(scene, kOneSecond, {}, {}, {});
  RunSettings settings = settings_of(trials.scene());
  const MeshErrors errors = measure_meshes(trials, settings, {{true}, true, false}, 1e-3 * kWay);
  const auto& beam = errors.beams.at(0);
  const auto rigid =
      std::find_if(beam.begin(), beam.end(), [](const MeshError& mesh) { return mesh.mesh.elements == 0; });
  ASSERT_NE(rigid, beam.end());
  EXPECT_NEAR(size(rigid->error) / kWay, kRampRms, 2 * kLeftOut * kRampRms);
}

TEST(MeshErrors, ChoicesGetBetterAndDearer) {
  TrialRuns trials(ramped_cantilever("order=\"1\""), kOneSecond, {}, {}, {});
  const std::vector<MeshChoice> choices = mesh_choices(measured(trials, 1e-3));
  for (std::size_t i = 1; i < choices.size(); ++i) {
    EXPECT_LT(size(choices[i].error), size(choices[i - 1].error));
    EXPECT_GT(choices[i].cost, choices[i - 1].cost);
  }
  EXPECT_EQ(cheapest_mesh(choices, 1).beams, choices.front().beams);
  EXPECT_EQ(cheapest_mesh(choices, 0).beams, choices.back().beams);
}

TEST(MeshErrors, OfASceneWithoutBeamsAreNone) {
  const MeshErrors none;
  const std::vector<MeshChoice> choices = mesh_choices(none);
  ASSERT_EQ(choices.size(), 1u);
  EXPECT_TRUE(choices[0].beams.empty());
  EXPECT_EQ(size(choices[0].error), 0);
}

// ---------------------------------------------------------------- elements="auto"

TEST(AutomaticMeshes, AreTheFewestElements) {
  TrialRuns trials(ramped_cantilever("elements=\"auto\" order=\"1\""), kOneSecond, {}, {}, {});
  for (const double accuracy : {5e-2, 1e-2, 1e-3}) {
    const AutomaticMeshes meshes = automatic_meshes(trials, accuracy);
    EXPECT_TRUE(meshes.is_met) << meshes.shortcoming;
    const int n = meshes.settings.beams.at(0).elements.value();
    EXPECT_EQ(meshes.settings.beams[0].order, 1);
    EXPECT_LE(linear_element_error(n) * kRampRms, accuracy);
    // The next coarser mesh that is tried has at least two thirds of the elements.
    ASSERT_GT(n, 1);
    EXPECT_GT(linear_element_error(2 * n / 3) * kRampRms, 0.8 * accuracy) << n;
  }
}

/// A stiff rod that falls about a hinge. `more` adds an element to the scene.
scene::SceneDescription stiff_pendulum(const std::string& more) {
  return test::scene_of(
      R"(<robot name="pendulum">
    <link name="world"/>
    <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/> </joint>
    <link name="rod"> <beam>
      <centerline> <line to="1 0 0"/> </centerline>
      <circle radius="0.05"/> <material young="200e9" poisson="0.3" density="7800"/>
    </beam> </link>
    )" +
      more +
      R"(
    <simulation> <probe name="tip" link="rod" at="1 0 0"/> </simulation>
  </robot>)");
}

TEST(AutomaticMeshes, AreNoneWhereABeamMayBeRigid) {
  // The rod bends by about rho g A L^4 / (8 E I) = 1e-5 m, while it falls by a metre.
  TrialRuns trials(stiff_pendulum(""), {0.01, 50}, {}, {}, {});
  const AutomaticMeshes meshes = automatic_meshes(trials, 1e-3);
  EXPECT_TRUE(meshes.is_met) << meshes.shortcoming;
  EXPECT_EQ(meshes.settings.beams.at(0).elements, 0);
  // A strain sensor needs an elastic beam.
  const std::string sensor = R"(<sensor name="gauge" kind="strain" link="rod" at="0.5 0 0.05"/>)";
  TrialRuns with_sensor(stiff_pendulum(sensor), {0.01, 50}, {}, {}, {});
  const AutomaticMeshes elastic = automatic_meshes(with_sensor, 1e-3);
  EXPECT_TRUE(elastic.is_met) << elastic.shortcoming;
  EXPECT_GT(elastic.settings.beams.at(0).elements, 0);
}

TEST(AutomaticMeshes, LeaveNumbersOfElementsAlone) {
  TrialRuns trials(ramped_cantilever("elements=\"2\" order=\"1\""), kOneSecond, {}, {}, {});
  const AutomaticMeshes meshes = automatic_meshes(trials, 1e-3);
  EXPECT_TRUE(meshes.is_met);
  EXPECT_EQ(meshes.runs, 0);
  EXPECT_EQ(meshes.settings.beams.at(0).elements, 2);
}

TEST(AutomaticMeshes, EndWhereTheirRunsAreUsedUp) {
  TrialLimits limits;
  limits.runs = 4;
  TrialRuns trials(ramped_cantilever("elements=\"auto\" order=\"1\""), kOneSecond, limits, {}, {});
  const AutomaticMeshes meshes = automatic_meshes(trials, 1e-9);
  EXPECT_FALSE(meshes.is_met);
  EXPECT_NE(meshes.shortcoming.find("4 runs"), std::string::npos) << meshes.shortcoming;
}

}  // namespace
}  // namespace flexarm
