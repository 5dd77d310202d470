// Tests the right-angle cantilever of Simo and Vu-Quoc (1988), reference case D5.
#include <vector>

#include "reference/dynamics_runs.h"

namespace flexarm::test {
namespace {

enum { kElbow, kTip };

SceneBuilder right_angle_cantilever(int elements, int order) {
  SceneBuilder b;
  b.beam("arm", {{10, 0, 0}, {10, 10, 0}}, scene::DirectSection{1e6, 1e6, 1e6, 1e3, 1e3, 1e3, 1, 20, 10, 10}, elements,
         order);
  b.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  b.load("arm", {10, 0, 0}, {0, 0, 50}, Vector3::Zero(), "0:0 1:1 2:0");
  b.probe("elbow", "arm", {10, 0, 0});
  b.probe("tip", "arm", {10, 10, 0});
  return b;
}

TEST(RightAngleCantilever, KeepsItsEnergyForTwoHundredSecondsAtLargeSteps) {
  Simulation simulation(right_angle_cantilever(8, 2).scene, options("em", 0.1, 1e-10));
  int halvings = 0;
  double reference = 0, drift = 0;
  for (int n = 1; n <= 2000; ++n) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << "t = " << simulation.time() << ": " << to_string(result.reason);
    halvings += result.halvings;
    const Energies e = simulation.energies();
    if (n <= 20) {
      EXPECT_NEAR(e.total(), e.work, 1e-10 * (1 + e.work)) << "energy is the work done, t = " << simulation.time();
      reference = e.total();
    }
    drift = std::max(drift, std::abs(e.total() - reference));
  }
  EXPECT_EQ(halvings, 0);
  EXPECT_GT(reference, 1);
  EXPECT_LT(drift, 1e-9 * reference);
}

struct Extremum {
  double value, time;
};
void keep_largest(Extremum& e, double value, double time) {
  if (value > e.value) e = {value, time};
}

// The published run has 40 linear elements per leg and the step 0.005 s. Values scatter by 1 % between meshes.
TEST(RightAngleCantilever, ExtremaAgreeWithPublishedCurves) {
  Simulation simulation(right_angle_cantilever(12, 2).scene, options("em", 0.025));
  Extremum tip_max{-1e9, 0}, tip_min{-1e9, 0}, elbow_min{-1e9, 0};
  run(simulation, 800, [&] {
    const double t = simulation.time();
    if (t < 10) keep_largest(tip_max, simulation.probe(kTip).pose.position.z(), t);
    keep_largest(tip_min, -simulation.probe(kTip).pose.position.z(), t);
    if (t < 14) keep_largest(elbow_min, -simulation.probe(kElbow).pose.position.z(), t);
  });
  EXPECT_NEAR(tip_max.value, 8.25, 0.01 * 8.25);
  EXPECT_NEAR(tip_max.time, 7.44, 0.05);
  EXPECT_NEAR(tip_min.value, 9.73, 0.01 * 9.73);
  EXPECT_NEAR(tip_min.time, 15.87, 0.05);
  EXPECT_NEAR(elbow_min.value, 4.06, 0.01 * 4.06);
  EXPECT_NEAR(elbow_min.time, 10.87, 0.05);
}

}  // namespace
}  // namespace flexarm::test
