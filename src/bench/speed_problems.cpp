// The problems of the speed report: references, runs, targets.
#include "bench/speed.h"

#include <algorithm>

namespace flexarm::bench {
namespace {

/// Tolerances of Newton's method: the default, and larger ones that save iterations.
constexpr double kTight = 1e-8, kLoose = 1e-4, kLoosest = 1e-3, kRough = 1e-2;

struct Mesh {
  int elements, order;
};

/// Adds runs for all combinations of schemes, meshes, tolerances and steps; `parts`: numbers of steps per interval.
void add_product(SpeedProblem& problem, const std::vector<const char*>& schemes, const std::vector<Mesh>& meshes,
                 const std::vector<int>& parts, const std::vector<double>& tolerances) {
  for (const char* scheme : schemes)
    for (const Mesh& mesh : meshes)
      for (const double tolerance : tolerances)
        for (const int part : parts)
          problem.runs.push_back({scheme, mesh.order, mesh.elements, problem.interval / part, tolerance});
}

/// Adds runs of em and em0. With the rough tolerance for em0, some runs are fast, and others fail.
void add_em(SpeedProblem& problem, const std::vector<Mesh>& meshes, const std::vector<int>& parts) {
  add_product(problem, {"em", "em0"}, meshes, parts, {kTight, kLoose, kLoosest});
  add_product(problem, {"em0"}, meshes, parts, {kRough});
}

/// Schemes of second order for comparison; em and em0 have more runs.
const std::vector<const char*> kOthers = {"em_symmetric", "edmc2", "m1", "newmark", "hht2"};

SpeedProblem spin_up() {
  SpeedProblem p{
      "spin_up", "Spin-up of a flexible beam", "speed/spin_up.urdf", "", "tip", 20, 0.2, {"em4", 3, 4, 0.005}, {}};
  add_em(p, {{1, 2}, {2, 1}, {2, 2}, {4, 1}, {1, 3}, {2, 3}}, {2, 3, 4, 5, 6, 7, 8, 10, 16});
  add_product(p, kOthers, {{2, 1}, {1, 3}, {2, 2}}, {2, 4, 8, 16}, {kTight, kLoosest});
  add_product(p, {"em4"}, {{2, 1}, {2, 2}, {1, 3}, {2, 3}}, {2, 4, 8}, {kTight, kLoosest});
  p.note = "The arm turns: what is compared is the tip's lag behind the hub, in whose frame it starts at rest.";
  p.frame = "arm";
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
                 {"em4", 4, 16, 0.025},
                 {}};
  add_em(p, {{8, 1}, {16, 1}, {4, 2}, {6, 2}, {8, 2}, {4, 3}, {2, 4}}, {1, 2, 3, 4, 5, 6, 7, 8, 10});
  add_product(p, kOthers, {{16, 1}, {4, 2}, {4, 3}}, {1, 2, 4, 8}, {kTight, kLoose});
  add_product(p, {"em4"}, {{8, 1}, {4, 2}, {8, 2}, {4, 3}, {8, 3}, {4, 4}}, {1, 2, 4}, {kTight, kLoose, kLoosest});
  return p;
}

SpeedProblem flying_spaghetti() {
  SpeedProblem p{"flying_spaghetti",
                 "Flying spaghetti",
                 "speed/flying_spaghetti.urdf",
                 "",
                 "loaded_end",
                 15,
                 0.2,
                 {"em4", 4, 16, 0.0125},
                 {}};
  add_em(p, {{4, 1}, {8, 1}, {16, 1}, {3, 2}, {4, 2}, {4, 3}, {2, 4}}, {1, 2, 3, 4, 5, 6, 7, 8, 10});
  add_product(p, kOthers, {{8, 1}, {4, 2}, {4, 3}}, {1, 2, 4, 8}, {kTight, kLoosest});
  add_product(p, {"em4"}, {{8, 1}, {4, 2}, {8, 2}, {4, 3}, {2, 4}, {4, 4}}, {1, 2, 4, 8}, {kTight, kLoose});
  p.note = "The beam flies off, so that errors are relative to its way, six times its length.";
  return p;
}

SpeedProblem double_pendulum() {
  SpeedProblem p{"double_pendulum",
                 "Flexible double pendulum",
                 "speed/double_pendulum.urdf",
                 "",
                 "tip",
                 3,
                 0.06,
                 {"em4", 4, 16, 0.0015},
                 {}};
  add_em(p, {{2, 1}, {4, 1}, {8, 1}, {2, 2}, {4, 2}, {8, 2}, {4, 3}}, {1, 2, 3, 6, 12, 24});
  add_product(p, kOthers, {{4, 1}, {4, 2}, {4, 3}}, {2, 6, 12, 24}, {kTight, kLoose});
  add_product(p, {"em4"}, {{4, 2}, {8, 2}, {4, 3}, {4, 4}}, {2, 6, 12}, {kTight, kLoose});
  return p;
}

SpeedProblem demo_arm() {
  // The reference is not em4, which also steps backwards in time: then the brakes would drive the arm.
  SpeedProblem p{
      "demo_arm", "The demo's arm", "demo_arm.urdf", "demo_commands.yaml", "payload", 10, 0.1, {"em", 3, 8, 0.00025},
      {}};
  // The demo's torques change at multiples of 5 ms.
  add_em(p, {{2, 2}, {4, 2}, {6, 2}, {2, 3}, {4, 3}}, {2, 5, 10, 20});
  add_product(p, {"em", "em0"}, {{4, 2}, {4, 3}}, {40, 100}, {kTight});
  add_product(p, kOthers, {{2, 2}, {4, 2}}, {2, 5, 10, 20}, {kTight, kLoose});
  add_product(p, {"em4"}, {{2, 2}, {4, 2}, {2, 3}}, {1, 5, 20}, {kTight, kLoose});
  return p;
}

SpeedProblem sliding_mass() {
  SpeedProblem p{"sliding_mass",
                 "Free sliding mass",
                 "thesis/12_2_free_sliding_mass.urdf",
                 "",
                 "mass",
                 0.2,
                 0.008,
                 {"em", 3, 160, 0.0005},
                 {}};
  add_product(p, {"em", "em0"}, {{5, 1}, {10, 1}, {20, 1}, {40, 1}, {5, 2}, {10, 2}, {20, 2}, {40, 2}, {20, 3}},
              {1, 2, 4}, {kTight, kLoose, kLoosest});
  add_product(p, kOthers, {{10, 1}, {40, 1}, {10, 2}, {20, 2}}, {1, 2, 4}, {kTight, kLoosest});
  add_product(p, {"em4"}, {{10, 1}, {40, 1}, {10, 2}, {20, 2}}, {1, 2}, {kTight, kLoosest});
  p.note =
      "At the start the velocity jumps at the slider, so that errors fall slowly with the mesh, whatever its order: "
      "the reference is coarse.";
  return p;
}

SpeedProblem tendon_rod() {
  SpeedProblem p{
      "tendon_rod", "Rod with three tendons", "speed/tendon_rod.urdf", "", "tip", 2, 0.04, {"em4", 3, 24, 0.001}, {}};
  add_em(p, {{12, 1}, {12, 2}}, {2, 4, 8, 16, 32});
  add_product(p, {"edmc2", "newmark"}, {{12, 1}, {12, 2}}, {4, 8, 16, 32}, {kTight, kLoosest});
  add_product(p, {"em4"}, {{12, 1}, {12, 2}}, {4, 8, 16}, {kTight, kLoosest});
  p.note =
      "Three tendons of given tension run through 13 points each. In MuJoCo the rod is a chain of rigid segments on "
      "ball "
      "joints, and the tendons run through sites.";
  return p;
}

SpeedProblem six_joint_arm() {
  SpeedProblem p{"six_joint_arm",
                 "Free swing of a rigid six-joint arm",
                 "speed/six_joint_arm.urdf",
                 "",
                 "tip",
                 1,
                 0.02,
                 {"dop853", 0, 0, 0.02 / 16},
                 {}};
  const std::vector<int> parts = {1, 2, 4, 5, 10, 20, 40};
  add_em(p, {{0, 0}}, parts);
  add_product(p, {"em4"}, {{0, 0}}, parts, {kTight, kLoose, kLoosest, kRough});
  add_product(p, {"newmark"}, {{0, 0}}, parts, {kTight, kLoose, kLoosest});
  add_product(p, {"rk4", "dop853"}, {{0, 0}}, {1, 2, 3, 4, 5, 8, 10, 20}, {kTight});
  p.note = "Nothing bends: only the step errs. Other programs read the same file.";
  return p;
}

SpeedProblem humanoid() {
  SpeedProblem p{"humanoid",
                 "Free swing of a rigid tree of 30 joints",
                 "speed/humanoid.urdf",
                 "",
                 "tip",
                 1,
                 0.02,
                 {"dop853", 0, 0, 0.02 / 16},
                 {}};
  add_product(p, {"em", "em4"}, {{0, 0}}, {1, 2, 4, 8, 16}, {kTight, kLoosest});
  add_product(p, {"rk4", "dop853"}, {{0, 0}}, {1, 2, 3, 4, 5, 8, 10, 20}, {kTight});
  p.note = "Five limbs at a trunk. Other programs read the same file.";
  return p;
}

}  // namespace

std::vector<SpeedProblem> speed_problems() {
  return {spin_up(),    right_angle_cantilever(), flying_spaghetti(), double_pendulum(), demo_arm(), sliding_mass(),
          tendon_rod(), six_joint_arm(),          humanoid()};
}

std::vector<SpeedTarget> speed_targets() {
  const char *three_node = "three-node beams, loose Newton tolerance", *unknown = "element not on record";
  return {{"spin_up", 1e-3, 0.19, 0.0126, 0.0015, "planar two-node beams"},
          {"right_angle_cantilever", 2.5e-3, 0.411, 0.0179, 0.003, three_node},
          {"right_angle_cantilever", 2.5e-4, 2.6, 0.032, 0.006, three_node},
          {"flying_spaghetti", 5e-3, 0.047, 0.003, 0.0008, unknown},
          {"flying_spaghetti", 1e-3, 0.096, 0.011, 0.0018, unknown}};
}

std::vector<PeerTarget> peer_targets() {
  return {{"six_joint_arm", "RK4", 1e-3, 0.5}, {"six_joint_arm", "RK4", 1e-6, 0.5}, {"humanoid", "RK4", 1e-3, 0.7}};
}

std::vector<RealTimeScene> real_time_scenes() {
  using Unit = RealTimeScene::Unit;
  return {
      {"cylindrical manipulator, mesh H2, at 1 kHz", "thesis/12_4_cylindrical_manipulator.urdf", "", "end1", "em", 1.5,
       Unit::TimesRealTime, 15},
      {"sliding arm at 1 kHz", "examples/sliding_arm.urdf", "", "load", "auto", 2, Unit::TimesRealTime, 40},
      {"demo arm at 1 kHz", "demo_arm.urdf", "demo_commands.yaml", "payload", "auto", 10, Unit::TimesRealTime, 80},
      {"tower crane at 1 kHz", "examples/tower_crane.urdf", "", "load", "auto", 40, Unit::TimesRealTime, 50},
      {"arm of three flexible tubes at 1 kHz", "speed/control_arm.urdf", "", "tip", "auto", 4,
       Unit::MicrosecondsPerStep, 6},
      {"the same in a plane at 1 kHz", "speed/control_arm_in_a_plane.urdf", "", "tip", "auto", 4,
       Unit::MicrosecondsPerStep, 4},
      {"rigid four-bar at 1 kHz", "speed/rigid_four_bar.urdf", "", "middle", "auto", 2, Unit::MicrosecondsPerStep, 8},
      {"rigid six-joint arm at 1 kHz", "speed/six_joint_arm.urdf", "", "tip", "auto", 1,
       Unit::MicrosecondsPerTwoIterations, 6}};
}

RealTimeScene shortened(RealTimeScene scene) {
  scene.until = 0.05;
  return scene;
}

SpeedProblem shortened(SpeedProblem problem) {
  constexpr int kIntervals = 3;
  problem.until = kIntervals * problem.interval;
  // The coarsest run of each scheme, and the same run with half the step.
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
