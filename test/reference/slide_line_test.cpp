// Tests lines over several links: welded beams are one line, which a kink ends.
#include "building/model_builder.h"
#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// A line of 4 m in `links` welded beams with eight elements in all. An arm with a body slides from 2.2 m, on the first
/// link of the second half, with `speed`.
SceneBuilder welded(int links, double speed) {
  SceneBuilder b;
  const double length = 4.0 / links;
  for (int i = 0; i < links; ++i) {
    const std::string name = "line" + std::to_string(i);
    b.beam(name, {{length, 0, 0}}, soft_section(), 8 / links, 2);
    if (i == 0)
      b.joint("free", JointKind::Floating, "world", name);
    else
      b.joint("weld" + std::to_string(i), JointKind::Fixed, "line" + std::to_string(i - 1), name, {length, 0, 0});
  }
  b.beam("arm", {{0, 0.8, 0.3}}, soft_section(), 1, 2);
  b.body("hand", 0.8, {0.2, 0.1, -0.1}, 0.2 * body_inertia());
  const int parent = links / 2;
  const double origin = parent * length;
  scene::JointDescription& run =
      b.joint("run", JointKind::Slide, "line" + std::to_string(parent), "arm", Vector3::Zero(), Vector3(1, 2, 2) / 3);
  run.slide = scene::SlideDescription{2.2 - origin, JointKind::Revolute};
  b.joint("wrist", JointKind::Fixed, "arm", "hand", {0, 0.8, 0.3});
  initial_field(b, "line0", {0.1, -0.2, 0.1}, {0.3, 0.5, 1.0});
  initial_joint(b, "run/s", 2.2 - origin, speed);
  return b;
}

double place(const Simulation& simulation) {
  return simulation.position(*simulation.find_coordinate("run/s")) - model_of(simulation).slide_lines[0].begin();
}

// The same mesh in one, two and four links, with travel past welds in both directions. A plain line in two links, whose
// nodes at the weld are never active, gives the same results up to round-off, which grows with the square of the steps.
// Otherwise SM-EM distributes the rotation of the section beyond its nodes (joints.md 4.5) over one more node. This
// difference must be small against the error of the lines, by which a smooth line differs from a plain one.
TEST(SlideLine, WeldedBeamsAreOneLine) {
  for (const bool smooth : {false, true})
    for (const double speed : {-2.0, 2.0}) {
      const auto simulation = [&](int links, bool is_smooth) {
        SceneBuilder b = welded(links, speed);
        for (scene::JointDescription& joint : b.scene.joints)
          if (joint.slide) joint.slide->smooth = is_smooth;
        return Simulation(b.scene, options("em", 0.01, 1e-12));
      };
      Simulation one = simulation(1, smooth), two = simulation(2, smooth), four = simulation(4, smooth),
                 other = simulation(1, !smooth);
      InvariantDrift drift_of_two(two), drift_of_four(four);
      EXPECT_NEAR(model_of(four).slide_lines[0].begin(), -2, 1e-15);
      EXPECT_NEAR(model_of(four).slide_lines[0].end(), 2, 1e-15);
      double least = 1e9, most = -1e9, weld_of_two = 0, weld_of_four = 0, error = 0;
      run(one, 150, [&] {
        for (Simulation* other_one : {&two, &four, &other}) ASSERT_TRUE(other_one->step().converged);
        drift_of_two.observe();
        drift_of_four.observe();
        const double s = place(one);
        weld_of_two = std::max(weld_of_two, std::abs(place(two) - s));
        weld_of_four = std::max(weld_of_four, std::abs(place(four) - s));
        error = std::max(error, std::abs(place(other) - s));
        least = std::min(least, s);
        most = std::max(most, s);
      });
      EXPECT_GT(most - least, 1.0) << "it must pass welds";
      const double bound = smooth ? 1e-3 * error : 1e-8;
      EXPECT_LT(weld_of_two, !smooth && speed > 0 ? 150 * 150 * 2e-16 * 4 : bound);
      EXPECT_LT(weld_of_four, bound);
      for (const InvariantDrift* drift : {&drift_of_two, &drift_of_four}) {
        EXPECT_LT(drift->energy(), 1e-10);
        EXPECT_LT(drift->momentum(), 1e-11);
        EXPECT_LT(drift->angular_momentum(), 1e-11);
      }
    }
}

TEST(SlideLine, EndsAtKinksAndAtTurnedSections) {
  SceneBuilder b = welded(4, 0);
  const auto line = [&] { return build_model(b.scene).slide_lines[0]; };
  EXPECT_EQ(line().pieces.size(), 8u);
  scene::JointDescription& weld = b.scene.joints[3];
  ASSERT_EQ(weld.name, "weld3");
  weld.origin.orientation = so3::exp_quaternion(Vector3(0, 0, 0.01));  // a kink
  EXPECT_NEAR(line().end(), 1, 1e-15);
  weld.origin.orientation = so3::exp_quaternion(Vector3(0.01, 0, 0));  // rotation about the line itself
  EXPECT_NEAR(line().end(), 1, 1e-15);
  weld.origin.orientation = Quaternion::Identity();
  weld.origin.position.y() = 0.01;  // attached to the nearest section, beside it
  EXPECT_NEAR(line().end(), 1, 1e-15);
}

}  // namespace
}  // namespace flexarm::test
