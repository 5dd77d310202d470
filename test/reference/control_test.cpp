// Tests that a sampled controller with published positions and velocities holds an arm as it would hold a real one.
#include <cstdio>
#include <ostream>

#include "reference/documented_arms.h"
#include "reference/dynamics_runs.h"

namespace flexarm::test {
namespace {

struct Loop {
  std::string name;
  scene::SceneDescription (*arm)();
  double stiffness, damping;  ///< of every joint [N m/rad, N m s/rad]
  double offset;              ///< offset of the set points from the initial positions [rad]
  double inertia;             ///< lower bound of any joint's inertia [kg m^2]
  double period;              ///< sample time of the controller [s]
  friend std::ostream& operator<<(std::ostream& out, const Loop& loop) { return out << loop.name; }
};

class Control : public ::testing::TestWithParam<Loop> {};

// A spring and a damper between arm and world only remove energy. The controller is such a pair, except for its sample
// and hold, which reduces kd by kp T/2, far less than kd. So the energy of arm and springs decreases, and no joint
// moves faster than the smallest inertia on these springs would. (At 100 Hz, the demo's wrist needs less than 600 N m
// s/rad. With more, a real arm vibrates, too, and so does one in steps of 0.05 ms.)
TEST_P(Control, HoldsTheArm) {
  const Loop& loop = GetParam();
  scene::SceneDescription scene = loop.arm();
  scene.efforts.clear();
  Simulation simulation(scene, options("auto", 1e-3));
  const std::size_t joints = simulation.coordinate_names().size();
  std::vector<double> set_points(joints);
  for (std::size_t i = 0; i < joints; ++i) set_points[i] = simulation.position(i) + loop.offset;
  const auto stored = [&] {
    double energy = simulation.energies().total();
    for (std::size_t i = 0; i < joints; ++i)
      energy += 0.5 * loop.stiffness * std::pow(simulation.position(i) - set_points[i], 2);
    return energy;
  };
  const int steps_per_period = static_cast<int>(std::lround(loop.period / simulation.step_size()));
  const double at_start = stored();
  double largest = 0, fastest = 0;
  for (int n = 0; n < std::lround(10 / loop.period); ++n) {
    for (std::size_t i = 0; i < joints; ++i)
      simulation.command_effort(
          i, loop.stiffness * (set_points[i] - simulation.position(i)) - loop.damping * simulation.velocity(i));
    run(simulation, steps_per_period);
    largest = std::max(largest, stored());
    for (std::size_t i = 0; i < joints && simulation.time() > 9; ++i)
      fastest = std::max(fastest, std::abs(simulation.velocity(i)));
  }
  std::printf("stored: %.4g J at the start, %.4g J at most, %.4g J after 10 s\n", at_start, largest, stored());
  EXPECT_LT(largest, at_start * (1 + 0.5 * loop.stiffness * loop.period / loop.damping));
  EXPECT_LT(stored(), at_start);
  EXPECT_LT(fastest, loop.offset * std::sqrt(static_cast<double>(joints) * loop.stiffness / loop.inertia));
}

INSTANTIATE_TEST_SUITE_P(Arms, Control,
                         ::testing::Values(Loop{"guide_1000_Hz", guide_arm, 20, 2, 0.4, 4, 1e-3},
                                           Loop{"guide_100_Hz", guide_arm, 20, 2, 0.4, 4, 1e-2},
                                           Loop{"demo_1000_Hz", demo_arm, 2000, 500, 0.03, 100, 1e-3},
                                           Loop{"demo_100_Hz", demo_arm, 2000, 300, 0.03, 100, 1e-2}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace flexarm::test
