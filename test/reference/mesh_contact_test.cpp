// Tests contact of meshes: a body with the mesh of a box moves as the same body with a box.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "flexarm/model/model_error.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#include "support/polytopes.h"

namespace flexarm::test::touching_meshes {
namespace {

const Vector3 kHalf(0.05, 0.1, 0.03);

/// Writes a file with the mesh of a box in millimetres, and returns its path.
std::string box_file() {
  const std::string path = std::filesystem::path(::testing::TempDir()) / "touching_box.obj";
  std::ofstream file(path);
  const Polytope box = box_polytope(1e3 * kHalf);
  for (const Vector3& corner : box.corners) file << "v " << corner.transpose() << "\n";
  for (const Polytope::Face& face : box.faces) {
    file << "f";
    for (const int corner : face.corners) file << " " << corner + 1;
    file << "\n";
  }
  return path;
}

std::string mesh_shape() {
  return "<mesh filename=\"file://" + box_file() + "\" scale=\"0.001 0.001 0.001\"/>";
}
std::string box_shape() {
  return fmt::format("<box size=\"{} {} {}\"/>", 2 * kHalf.x(), 2 * kHalf.y(), 2 * kHalf.z());
}

/// Two bodies of the given shape, which fall on each other and on a floor.
Simulation falling(const std::string& shape) {
  std::string text = R"(<robot name="meshes"><link name="world"/><ground name="floor"/>
    <contact first="*" second="*" restitution="0.5" friction="0.4"/>)";
  for (const char* name : {"low", "high"})
    text += fmt::format(
        R"(<link name="{0}"><inertial><mass value="1"/><inertia ixx="0.004" iyy="0.001" izz="0.004" ixy="0" ixz="0"
        iyz="0"/></inertial><collision><geometry>{1}</geometry></collision></link><joint name="of_{0}" type="floating">
        <parent link="world"/><child link="{0}"/></joint>)",
        name, shape);
  text += R"(<simulation><integrator scheme="em" step="1e-3"/><initial joint="of_low/z" position="0.06"/>
    <initial joint="of_high/z" position="0.15"/><initial joint="of_high/x" position="0.02"/>
    <initial link="low" angular="0.4 0.2 0"/></simulation></robot>)";
  const scene::ReadResult result = scene::read_scene_text(text, "meshes.urdf");
  EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
  return Simulation(result.scene.value());
}

// Points and faces have a different order, so that sums differ by round-off, which grows from hit to hit.
TEST(TouchingMeshes, OfABoxAreTheBox) {
  Simulation box = falling(box_shape()), mesh = falling(mesh_shape());
  for (int k = 0; k < 400; ++k) {
    ASSERT_TRUE(box.step().converged);
    ASSERT_TRUE(mesh.step().converged);
    for (const std::size_t link : {1, 2}) {
      const Vector3 one = box.link_pose(link).position, other = mesh.link_pose(link).position;
      ASSERT_NEAR((one - other).norm(), 0, 1e-7) << link << " after " << k + 1 << " steps";
    }
  }
  EXPECT_GT(box.energies().dissipated, 0.1) << "it did hit";
}

// Sliding follows g (sin - mu cos), with the smaller mu of both surfaces, as in Gazebo.
TEST(TouchingMeshes, SlideByTheFrictionThatGazeboKnows) {
  const double slope = 0.5;
  const scene::ReadResult result = scene::read_scene_text(
      fmt::format(
          R"(<robot name="meshes"><link name="world"/><ground name="floor"/><link name="block"><inertial><mass value="1"/>
      <inertia ixx="0.004" iyy="0.001" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry>{}</geometry>
      </collision></link><joint name="of_block" type="floating"><parent link="world"/><child link="block"/></joint>
      <gazebo reference="block"><mu1>0.4</mu1><mu2>0.3</mu2><kp>1e6</kp></gazebo><contact first="block" second="floor"/>
      <simulation><gravity xyz="{} 0 {}"/><integrator scheme="em" step="1e-3"/><initial joint="of_block/z" position="0.03"/>
      </simulation></robot>)",
          mesh_shape(), 9.81 * std::sin(slope), -9.81 * std::cos(slope)),
      "slope.urdf");
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  Simulation simulation(result.scene.value());
  const auto speed_at = [&](int steps) {
    while (simulation.time() < steps * 1e-3 - 1e-9) EXPECT_TRUE(simulation.step().converged);
    return simulation.momentum().x();
  };
  const double first = speed_at(1000), second = speed_at(2000);  // after it has settled
  EXPECT_NEAR(second - first, 9.81 * (std::sin(slope) - 0.3 * std::cos(slope)), 1e-6);
}

TEST(TouchingMeshes, ThatAreMissingAreErrorsWhereTheyAreMeantToTouch) {
  const auto refusal = [](const std::string& contact) -> std::string {
    const scene::ReadResult result = scene::read_scene_text(
        R"(<robot name="meshes"><link name="world"/><ground name="floor"/><link name="a"><inertial><mass value="1"/>
        <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry>
        <mesh filename="file:///nowhere/a.stl"/></geometry></collision></link><joint name="j" type="floating">
        <parent link="world"/><child link="a"/></joint>)" +
            contact + "</robot>",
        "missing.urdf");
    EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
    try {
      Simulation simulation(result.scene.value());
    } catch (const ModelError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(""), "");
  EXPECT_EQ(refusal(R"(<contact first="a" second="floor"/>)"),
            "missing.urdf:1: <link> 'a': its <collision> has the mesh 'file:///nowhere/a.stl', but there is no file "
            "/nowhere/a.stl");
}

}  // namespace
}  // namespace flexarm::test::touching_meshes
