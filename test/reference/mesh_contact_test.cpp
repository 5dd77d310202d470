// Tests contact of meshes: a body with the mesh of a box moves as the same body with a box.
#include <filesystem>
#include <fstream>

#include "reference/contact_scenes.h"
#include "support/polytopes.h"
#include "support/refusal.h"

namespace flexarm::test::touching {
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
  return "<mesh filename='file://" + box_file() + "' scale='0.001 0.001 0.001'/>";
}

std::string body_with(const std::string& name, const std::string& shape) {
  return body(name, 1, {0.004, 0.001, 0.004}, Vector3::Zero(), collision(shape)) + floating(name);
}

/// Two bodies of the given shape, which fall on each other and on a floor.
Simulation falling(const std::string& shape) {
  return simulation_of(
      kFloor + contact_of("*", "*", "restitution='0.5' friction='0.4'") + body_with("low", shape) +
          body_with("high", shape),
      "<initial joint='of_low/z' position='0.06'/><initial joint='of_high/z' position='0.15'/><initial "
      "joint='of_high/x' position='0.02'/><initial link='low' angular='0.4 0.2 0'/>",
      1e-3);
}

// Points and faces have a different order, so that sums differ by round-off, which grows from hit to hit.
TEST(TouchingMeshes, OfABoxAreTheBox) {
  Simulation box = falling("<box size='" + xyz(2 * kHalf) + "'/>"), mesh = falling(mesh_shape());
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
  Simulation simulation = simulation_of(
      kFloor + body_with("block", mesh_shape()) +
          "<gazebo reference='block'><mu1>0.4</mu1><mu2>0.3</mu2><kp>1e6</kp></gazebo>" + contact_of("block", "floor"),
      "<initial joint='of_block/z' position='0.03'/>", 1e-3, {9.81 * std::sin(slope), 0, -9.81 * std::cos(slope)});
  const auto speed_at = [&](double time) {
    run_until(simulation, time);
    return simulation.momentum().x();
  };
  const double first = speed_at(1), second = speed_at(2);  // after it has settled
  EXPECT_NEAR(second - first, 9.81 * (std::sin(slope) - 0.3 * std::cos(slope)), 1e-6);
}

TEST(TouchingMeshes, ThatAreMissingAreErrorsWhereTheyAreMeantToTouch) {
  const auto refused = [](const std::string& contact) {
    return refusal_of(scene_of(robot(kFloor + body_with("a", "<mesh filename='file:///nowhere/a.stl'/>") + contact)));
  };
  EXPECT_EQ(refused(""), "");
  EXPECT_EQ(refused(contact_of("a", "floor")),
            "test.urdf:1: <link> 'a': its <collision> has the mesh 'file:///nowhere/a.stl', but there is no file "
            "/nowhere/a.stl");
}

}  // namespace
}  // namespace flexarm::test::touching
