// Moves joints of an arm to given angles by PD controllers that run at 1 kHz. Prints the positions of the tips of
// flexible links, and the energies. Arguments for each joint: its name, the angle [rad], stiffness [N m/rad] and
// damping [N m s/rad] of its controller.
//
//   close_the_loop arm.urdf shoulder 0.8 200 2
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <vector>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace {

constexpr double kPeriod = 1e-3, kMove = 3, kUntil = 5;  // [s]
constexpr int kReports = 10;                             // lines printed

struct Controller {
  std::size_t coordinate;
  double start, goal, stiffness, damping;

  double effort(const flexarm::Simulation& simulation) const {
    // The set point moves from start to goal without a jump of the speed, which would make the links vibrate.
    const double part = std::min(simulation.time() / kMove, 1.0);
    const double angle = start + (goal - start) * part * part * (3 - 2 * part);
    const double speed = (goal - start) * 6 * part * (1 - part) / kMove;
    return stiffness * (angle - simulation.position(coordinate)) + damping * (speed - simulation.velocity(coordinate));
  }
};

void print(const flexarm::Simulation& simulation) {
  std::printf("%.3f s", simulation.time());
  for (std::size_t link = 0; link < simulation.link_names().size(); ++link) {
    if (!simulation.is_flexible(link)) continue;
    const flexarm::Vector3 tip = simulation.tip_pose(link).position;
    std::printf(", %s (%.4f %.4f %.4f) m", simulation.link_names()[link].c_str(), tip.x(), tip.y(), tip.z());
  }
  const flexarm::Energies energies = simulation.energies();
  std::printf(", kinetic %.4f J, strain %.4f J\n", energies.kinetic, energies.strain);
}

/// Makes one step of the simulation for each period of the controllers. @return false if a step fails
bool run(flexarm::Simulation& simulation, const std::vector<Controller>& controllers) {
  const int periods = static_cast<int>(kUntil / kPeriod + 0.5);
  for (int period = 1; period <= periods; ++period) {
    for (const Controller& controller : controllers)
      simulation.command_effort(controller.coordinate, controller.effort(simulation));
    const flexarm::StepResult result = simulation.step();
    if (!result.converged) {
      std::cerr << "at " << simulation.time() << " s: " << to_string(result.reason) << "\n";
      return false;
    }
    if (period % (periods / kReports) == 0) print(simulation);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || (argc - 2) % 4 != 0) {
    std::cerr << "usage: close_the_loop SCENE [JOINT ANGLE STIFFNESS DAMPING]...\n";
    return 2;
  }
  const flexarm::scene::ReadResult read = flexarm::scene::read_scene_file(argv[1]);
  std::cerr << to_text(read.diagnostics);  // errors and warnings, by file and line
  if (!read.scene) return 2;
  try {
    flexarm::SimulationOptions options;
    options.step = kPeriod;
    flexarm::Simulation simulation(*read.scene, options);
    std::vector<Controller> controllers;
    for (int i = 2; i < argc; i += 4) {
      const std::optional<std::size_t> coordinate = simulation.find_coordinate(argv[i]);
      if (!coordinate || !simulation.is_commandable(*coordinate)) {
        std::cerr << "no joint '" << argv[i] << "' to be commanded\n";
        return 2;
      }
      controllers.push_back({*coordinate, simulation.position(*coordinate), std::atof(argv[i + 1]),
                             std::atof(argv[i + 2]), std::atof(argv[i + 3])});
    }
    return run(simulation, controllers) ? 0 : 1;
  } catch (const flexarm::ModelError& error) {  // impossible as a mechanism
    std::cerr << error.what() << "\n";
    return 2;
  }
}
