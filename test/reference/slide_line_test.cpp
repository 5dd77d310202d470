// Lines over several links: welded beams are one line, kinks end it.
#include "flexarm/model/model_builder.h"
#include "reference/dynamics_joint_chain.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// A line of 4 m in `links` welded beams with eight elements altogether; an arm with a body slides on the second half's
/// first link from 2.2 m, at `speed`.
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

// The same mesh, in one link and in two and four: the welds must not be felt, in either direction.
TEST(SlideLine, WeldedBeamsAreOneLine) {
  for (const double speed : {-2.0, 2.0}) {
    std::vector<std::unique_ptr<Simulation>> runs;
    std::vector<std::unique_ptr<InvariantDrift>> drifts;
    for (const int links : {1, 2, 4}) {
      runs.push_back(std::make_unique<Simulation>(welded(links, speed).scene, options("em", 0.01, 1e-12)));
      drifts.push_back(std::make_unique<InvariantDrift>(*runs.back()));
    }
    EXPECT_NEAR(runs[2]->model().slide_lines[0].begin(), -2, 1e-15);
    EXPECT_NEAR(runs[2]->model().slide_lines[0].end(), 2, 1e-15);
    double least = 1e9, most = -1e9;
    for (int i = 0; i < 150; ++i) {
      const double expected = runs[0]->position(*runs[0]->find_coordinate("run/s"));
      for (std::size_t k = 0; k < runs.size(); ++k) {
        ASSERT_TRUE(runs[k]->step().converged);
        drifts[k]->observe();
      }
      for (std::size_t k = 1; k < runs.size(); ++k) {
        const double s = runs[k]->position(*runs[k]->find_coordinate("run/s")) + 2;
        // Newton leaves 1e-15 of the size in a step, 1e-12 m/s in velocities, which the motion amplifies; a weld that
        // was felt would show as another mesh does, by 1e-3 m.
        EXPECT_NEAR(s, runs[0]->position(*runs[0]->find_coordinate("run/s")), 1e-7);
      }
      least = std::min(least, expected);
      most = std::max(most, expected);
    }
    EXPECT_GT(most - least, 1.0) << "it must pass welds";
    for (const auto& drift : drifts) {
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
  weld.origin.orientation = so3::exp_quaternion(Vector3(0.01, 0, 0));  // about the line itself
  EXPECT_NEAR(line().end(), 1, 1e-15);
  weld.origin.orientation = Quaternion::Identity();
  weld.origin.position.y() = 0.01;  // attached to the nearest section, beside it
  EXPECT_NEAR(line().end(), 1, 1e-15);
}

}  // namespace
}  // namespace flexarm::test
