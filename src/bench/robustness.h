#pragma once
/// Measures how schemes cope with hard scenes.

#include <string>
#include <vector>

#include "bench/run.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::bench {

/// A scene that is run with several steps, since the result of a single run is random if the motion is chaotic.
struct HardScene {
  std::string name;
  scene::SceneDescription scene;
  double until;               ///< [s]
  std::vector<double> steps;  ///< [s]
};
std::vector<HardScene> hard_scenes();

struct Robustness {
  int runs = 0, completed = 0;
  double time_reached = 0;   ///< mean over the runs, relative to the end time
  double halved = 0;         ///< fraction of the steps in which a sub-step was halved
  double iterations = 0;     ///< of Newton's method per step
  double energy_defect = 0;  ///< largest error of energy - work + dissipation, relative to the largest energy
};

/// Runs the scene with the simulator's default tolerance and step control.
Robustness robustness(const Variant& variant, const HardScene& hard, bool quick);

}  // namespace flexarm::bench
