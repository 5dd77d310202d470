// The problems of the speed report: references, grids of runs, targets.
#include "bench/speed.h"

#include <algorithm>

namespace flexarm::bench {
namespace {

constexpr double kTight = 1e-8, kLoose = 1e-3;

struct Mesh {
  int elements, order;
};

/// Every scheme with every mesh, step and tolerance.
void add_product(SpeedProblem& problem, const std::vector<const char*>& schemes, const std::vector<Mesh>& meshes,
                 const std::vector<double>& steps, const std::vector<double>& tolerances = {kTight}) {
  for (const char* scheme : schemes)
    for (const Mesh& mesh : meshes)
      for (const double step : steps)
        for (const double tolerance : tolerances)
          problem.runs.push_back({scheme, mesh.order, mesh.elements, step, tolerance});
}

SpeedProblem spin_up() {
  SpeedProblem p{"spin_up", "Spin-up of a flexible beam", "speed/spin_up.urdf", "", "tip", 20, 0.2, {"em4", 3, 8, 0.02},
                 {}};
  add_product(p, {"em", "em4"}, {{2, 2}, {4, 2}}, {0.1, 0.05}, {kTight, kLoose});
  return p;
}

SpeedProblem right_angle_cantilever() {
  SpeedProblem p{"right_angle_cantilever",
                 "Right-angle cantilever",
                 "speed/right_angle_cantilever.urdf",
                 "",
                 "tip",
                 30,
                 0.2,
                 {"em4", 3, 16, 0.05},
                 {}};
  add_product(p, {"em", "em4"}, {{4, 2}, {8, 2}}, {0.2, 0.1}, {kTight, kLoose});
  return p;
}

SpeedProblem flying_spaghetti() {
  SpeedProblem p{"flying_spaghetti",
                 "Flying spaghetti",
                 "speed/flying_spaghetti.urdf",
                 "",
                 "loaded_end",
                 15,
                 0.1,
                 {"em4", 3, 12, 0.025},
                 {}};
  add_product(p, {"em", "em4"}, {{4, 2}, {8, 2}}, {0.1, 0.05}, {kTight, kLoose});
  return p;
}

SpeedProblem double_pendulum() {
  SpeedProblem p{"double_pendulum",
                 "Flexible double pendulum",
                 "speed/double_pendulum.urdf",
                 "",
                 "tip",
                 3,
                 0.02,
                 {"em4", 3, 16, 0.001},
                 {}};
  add_product(p, {"em", "em4"}, {{4, 2}, {8, 2}}, {0.01, 0.005}, {kTight, kLoose});
  return p;
}

SpeedProblem demo_arm() {
  SpeedProblem p{
      "demo_arm", "The demo's arm", "demo_arm.urdf", "demo_commands.yaml", "payload", 10, 0.1, {"em4", 3, 12, 0.0025},
      {}};
  add_product(p, {"em", "em4"}, {{4, 2}, {6, 2}}, {0.01, 0.005}, {kTight, kLoose});
  return p;
}

SpeedProblem sliding_mass() {
  SpeedProblem p{"sliding_mass",
                 "Free sliding mass",
                 "thesis/12_2_free_sliding_mass.urdf",
                 "",
                 "mass",
                 0.2,
                 0.01,
                 {"em", 2, 20, 0.0005},
                 {}};
  add_product(p, {"em", "em4"}, {{5, 2}, {10, 2}}, {0.002, 0.001}, {kTight, kLoose});
  return p;
}

}  // namespace

std::vector<SpeedProblem> speed_problems() {
  return {spin_up(), right_angle_cantilever(), flying_spaghetti(), double_pendulum(), demo_arm(), sliding_mass()};
}

std::vector<SpeedTarget> speed_targets() {
  return {{"spin_up", 1e-3, 0.37, 0.02},
          {"right_angle_cantilever", 2.5e-3, 0.50, 0.025},
          {"right_angle_cantilever", 2.5e-4, 4.5, 0.1},
          {"flying_spaghetti", 5e-3, 0.21, 0.01}};
}

SpeedProblem shortened(SpeedProblem problem) {
  constexpr int kIntervals = 3;
  problem.until = kIntervals * problem.interval;
  // The coarsest run of each scheme, and the same with half the step.
  std::vector<Discretisation> few;
  for (const Discretisation& run : problem.runs) {
    if (std::any_of(few.begin(), few.end(), [&](const Discretisation& d) { return d.scheme == run.scheme; })) continue;
    few.push_back(run);
    few.push_back(run);
    few.back().step /= 2;
  }
  problem.runs = few;
  return problem;
}

}  // namespace flexarm::bench
