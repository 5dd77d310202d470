#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/scene_input.h"

namespace flexarm::cli {
namespace {

struct Arguments {
  SceneInput scene;
  int count = 10;
};

/// Displacement and spin of a frame when its node moves.
Vector6 frame_motion(const Simulation& simulation, const Mode& mode, const Attachment& frame) {
  if (frame.node < 0) return Vector6::Zero();
  Vector6 motion = mode.node_motion.at(frame.node);
  const Vector3 arm = attached_pose(simulation.state(), frame).position -
                      attached_pose(simulation.state(), {frame.node, Pose()}).position;
  motion.head<3>() += motion.tail<3>().cross(arm);
  return motion;
}

void print_motion(const std::string& name, const Vector6& motion) {
  fmt::print("  {:<24}", name);
  for (int i = 0; i < 6; ++i) fmt::print(" {:>11.4g}", motion[i]);
  fmt::print("\n");
}

void print_shape(const Simulation& simulation, const Mode& mode) {
  for (const LinkFrame& link : simulation.model().links) {
    if (link.frame.node >= 0) print_motion(link.name, frame_motion(simulation, mode, link.frame));
    if (link.beam) print_motion(link.name + "/tip", frame_motion(simulation, mode, link.beam->tip));
  }
}

int solve(const Arguments& arguments) {
  Simulation simulation = load_simulation(arguments.scene);
  seek_equilibrium(simulation);
  const std::vector<Mode> modes = simulation.natural_modes(arguments.count);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    fmt::print("mode {}: {:.7g} Hz{}\n", i + 1, modes[i].frequency,
               modes[i].frequency < 0 ? " (negative: grows, the configuration is not stable)" : "");
    if (i == 0)
      fmt::print("  {:<24} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}\n", "frame", "x", "y", "z", "about x", "about y",
                 "about z");
    print_shape(simulation, modes[i]);
  }
  return kDone;
}

}  // namespace

void add_modes(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("modes", "Natural frequencies and shapes about the equilibrium");
  add_scene(*command, arguments->scene);
  command->add_option("--count", arguments->count, "number of modes")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  command->callback([arguments, &status] { status = solve(*arguments); });
}

}  // namespace flexarm::cli
