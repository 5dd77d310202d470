// Tests distributed loads on a part of a line.
#include <gtest/gtest.h>

#include "building/expect_model_error.h"
#include "simulation/inside.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

constexpr double kLength = 2, kStiffness = 100;

SceneBuilder loaded(std::optional<double> from, std::optional<double> to, double force) {
  SceneBuilder b;
  b.beam("arm", {{kLength, 0, 0}}, section(1e7, 1e7, 80, kStiffness, 1, 0.2, 0.1), 4, 3);
  b.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  scene::DistributedLoad load;
  load.link = "arm";
  load.force = {0, force, 0};
  load.from = from;
  load.to = to;
  b.scene.distributed_loads.push_back(load);
  return b;
}

// Reactions of the clamp: force q (b - a), moment q (b^2 - a^2) / 2. The weights that lump the load at nodes are exact
// for linear functions.
TEST(DistributedLoad, ActsBetweenItsEnds) {
  const double q = 1e-4;
  for (const auto& [from, to] : {std::pair(0.0, 2.0), std::pair(0.35, 1.1), std::pair(1.2, 2.0)}) {
    SceneBuilder b = loaded(from, to, q);
    b.sensor("root", scene::SensorKind::Reaction, "arm");
    b.scene.integrator.tolerance = 1e-12;
    Simulation simulation(b.scene);
    ASSERT_TRUE(simulation.solve_static(1).converged);
    const Wrench reaction = simulation.reaction(1);
    const double force = q * (to - from), moment = q * (to * to - from * from) / 2;
    EXPECT_NEAR(-reaction.force.y(), force, 1e-7 * force);
    EXPECT_NEAR(-reaction.moment.z(), moment, 1e-7 * moment);
  }
}

TEST(DistributedLoad, IsOnTheWholeLineWithoutEnds) {
  const Simulation whole(loaded(std::nullopt, std::nullopt, 3).scene), ends(loaded(0.0, kLength, 3).scene);
  ASSERT_EQ(model_of(whole).loads.size(), model_of(ends).loads.size());
  for (std::size_t i = 0; i < model_of(whole).loads.size(); ++i)
    EXPECT_EQ(model_of(whole).loads[i].force, model_of(ends).loads[i].force);
}

TEST(DistributedLoad, EndsWhereTheLineDoes) {
  expect_error(loaded(0.5, 2.5, 1).scene, "the line of link 'arm' is 2.000000 m long, got 2.5");
}

}  // namespace
}  // namespace flexarm::test
