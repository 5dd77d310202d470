// Tests friction that is larger at rest (Stribeck's curve) against closed forms, a quadrature, and an integration of
// the law from event to event.
#include <cmath>
#include <string>
#include <vector>

#include "reference/one_coordinate_scenes.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

using Law = scene::FrictionDescription::Law;

/// A block under friction of 3 N that is 1.5 times as large at rest.
SceneBuilder block_that_breaks_away() {
  SceneBuilder b = block_on_rail();
  b.scene.joints[0].friction = 3;
  b.scene.joints[0].friction_law = {Law::Coulomb, 0, 0, 1.5, 0.01};
  return b;
}

TEST(StaticFriction, HoldsUntilItBreaksAway) {
  for (const std::string scheme : {"em", "edmc2", "m1", "m2", "std", "newmark", "hht2"}) {
    // In the Newmark family a part of the acceleration alternates after the start, at most the one at the start.
    const bool alternates = scheme == "newmark" || scheme == "hht2";
    const double tolerance = alternates ? 0.5 * 0.001 * 4.5 / kBlockMass : 1e-6;
    Simulation simulation(block_that_breaks_away().scene, options(scheme, 0.001));
    simulation.command_effort(0, 0.999 * 4.5);
    run(simulation, 50, [&] { ASSERT_EQ(simulation.position(0), 0) << scheme; });
    EXPECT_EQ(simulation.energies().dissipated, 0);
    simulation.command_effort(0, 1.001 * 4.5);
    run(simulation, 500);
    ASSERT_GT(simulation.velocity(0), 0.1) << scheme;
    simulation.command_effort(0, 3.5);  // enough for a block that slides
    run(simulation, 5);                 // published velocities come from the last steps, which the change has left then
    const double speed = simulation.velocity(0);
    run(simulation, 100);
    EXPECT_NEAR(simulation.velocity(0) - speed, 0.1 * 0.5 / kBlockMass, tolerance) << scheme;
    simulation.command_effort(0, 0);
    run(simulation, 1000);
    EXPECT_NEAR(simulation.velocity(0), 0, 1e-14) << scheme;
    const double rest = simulation.position(0);
    simulation.command_effort(0, 3.5);  // not enough for a block at rest
    // The alternating part of the acceleration may move it for a few steps.
    const double moved = alternates ? 0.001 * tolerance : 0;
    run(simulation, 50, [&] { ASSERT_NEAR(simulation.position(0), rest, moved) << scheme; });
  }
}

// While it slides, the block follows m v' = Q - F(v), of which the time from one speed to another is a quadrature:
// second order in the step.
TEST(StaticFriction, FallsAlongItsCurve) {
  const double load = 5, from = 0.02, to = 0.05, speed = 0.03;
  double time = 0;
  constexpr int kParts = 2000;
  for (int i = 0; i < kParts; ++i) {
    const double x = (from + (i + 0.5) * (to - from) / kParts) / speed;
    time += (to - from) / kParts * kBlockMass / (load - 3 * (1 + 0.5 * std::exp(-x * x)));
  }
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const int steps = 20 << k;
    SceneBuilder b = block_that_breaks_away();
    b.scene.joints[0].friction_law.stribeck_speed = speed;
    b.scene.initial_joints[0].velocity = from;
    Simulation simulation(b.scene, options("em", time / steps));
    simulation.command_effort(0, load);
    run(simulation, steps);
    error[k] = std::abs(simulation.velocity(0) - to);
  }
  EXPECT_LT(error[1], 1e-3 * to);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.15);
}

// A block of 2 kg that a spring of 200 N/m pulls, whose end moves with 0.1 m/s; friction of 4 N, 1.5 times as large
// at rest. Where it rests after each slip: from an integration of the law with scipy, from event to event. (As the
// Stribeck speed vanishes, a slip takes 2 (pi - atan(D w / V)) / w, D = 0.01 m, w = 10/s: 0.4712 s;
// elements/scripts/reference_stick_slip.py.) A step decides whether the block breaks away: up to a step late it
// slides on farther by twice the way of the spring's end, and as much again at its stop.
TEST(StaticFriction, SticksAndSlipsAsIntegratedFromEventToEvent) {
  struct Case {
    double stribeck, period, slip;
  };
  for (const Case& each : {Case{0.01, 0.7028383672, 0.4719631454}, Case{0.05, 0.7432931607, 0.4802554625}})
    for (const double step : {2e-3, 2.5e-4}) {
      Simulation simulation(scene_of(robot(
          joint("pull", "prismatic", "world", "end", "<origin xyz='1 0 0'/>" + kFarLimits) +
              joint("rail", "prismatic", "world", "block",
                    kFarLimits + "<dynamics friction='4'/>" +
                        fmt::format("<friction law='coulomb' static='1.5' stribeck='{}'/>", each.stribeck)) +
              body("end", 2) + body("block", 2) + "<spring from='block' to='end' stiffness='200' rest_length='1'/>",
          gravity({0, 0, 0}) + integrator("em", step) + "<motion joint='pull' position='0.1*t'/>")));
      const double begin = energy_account(simulation);
      const int rail = 1;
      double before = 0, dissipated = 0;
      std::vector<double> starts, stops, rests;
      bool sticks = true;
      run(simulation, static_cast<int>(2.3 / step), [&] {
        const double now = simulation.position(rail);
        if (sticks && now != before) starts.push_back(simulation.time() - step);
        if (!sticks && now == before) {
          rests.push_back(now);
          stops.push_back(simulation.time() - step);
        }
        sticks = now == before;
        before = now;
        ASSERT_GE(simulation.energies().dissipated, dissipated);
        dissipated = simulation.energies().dissipated;
      });
      ASSERT_EQ(starts.size(), 3u);
      ASSERT_EQ(rests.size(), 3u);
      for (int n = 0; n < 3; ++n) {
        EXPECT_NEAR(starts[n], 0.3 + n * each.period, (2 + 4 * n) * step) << each.stribeck;
        EXPECT_NEAR(stops[n] - starts[n], each.slip, 3 * step) << each.stribeck;
        EXPECT_NEAR(rests[n], (n + 1) * 0.1 * each.period, (n + 1) * 4 * 0.1 * step) << each.stribeck;
      }
      EXPECT_NEAR(energy_account(simulation), begin, 1e-9);
    }
}

}  // namespace
}  // namespace flexarm::test
