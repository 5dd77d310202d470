#include "announcement.h"

#include <ros/console.h>

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/driven_ends.h"

namespace flexarm::node {
namespace {

constexpr std::size_t kMostNames = 12;  ///< most joint names that are listed

/// The first kMostNames names, separated by commas, and how many more there are.
std::string list_of(const std::vector<std::string>& names) {
  if (names.empty()) return "none";
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) list += (i > 0 ? ", " : "") + names[i];
  return list + (names.size() > kMostNames ? " and " + std::to_string(names.size() - kMostNames) + " more" : "");
}

}  // namespace

void say_what_is_simulated(const Simulation& simulation, const RunState& run, const std::string& topics,
                           const std::string& services) {
  for (const scene::Diagnostic& warning : simulation.start_warnings()) ROS_WARN_STREAM(warning.text());
  if (const std::string warning = warning_of_shaking_servos(simulation); !warning.empty()) ROS_WARN_STREAM(warning);
  const scene::SceneDescription& scene = simulation.scene();
  ROS_INFO_STREAM("scene '" << scene.name << "' of " << scene.file << ": joints "
                            << list_of(simulation.coordinate_names()) << "; " << simulation.degrees_of_freedom()
                            << " unknowns");
  ROS_INFO_STREAM("scheme " << simulation.scheme() << ", step " << simulation.step_size() << " s; topics in " << topics
                            << ", services in " << services
                            << (run.lock_step ? "; each step waits for its command" : "")
                            << (run.paused ? "; paused" : ""));
}

void advise_controllers(const Simulation& simulation) {
  std::vector<std::string> limits;
  for (const DrivenEnd& end : driven_ends(simulation))
    limits.push_back(fmt::format("{} {:.3g}", end.coordinate, end.shakes_beyond));
  if (limits.empty()) return;
  ROS_INFO(
      "controllers that act once a step shake joints at the ends of beams if they damp by more than, in N m s/rad: %s "
      "(flexarm check says more)",
      list_of(limits).c_str());
}

}  // namespace flexarm::node
