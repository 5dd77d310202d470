#include "cli/mesh_choice.h"

#include <fmt/format.h>

#include "accuracy/automatic_meshes.h"
#include "cli/interruption.h"
#include "cli/progress_bar.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::cli {
namespace {

constexpr int kJudgedTimes = 100;

/// "elements: arm 5, forearm 3"; those that were chosen.
std::string names_of(const scene::SceneDescription& scene, const RunSettings& settings) {
  std::string text = "elements:";
  auto beam = settings.beams.begin();
  for (const scene::LinkDescription& link : scene.links) {
    if (!link.beam) continue;
    if (!link.beam->elements)
      text += fmt::format("{} {} {}", text.back() == ':' ? "" : ",", link.name, beam->elements.value_or(0));
    ++beam;
  }
  return text;
}

}  // namespace

ChosenMeshes choose_meshes(const SimulateArguments& arguments, double accuracy, Simulation& simulation) {
  if (!arguments.resume.empty() || !arguments.checkpoint.empty()) return {accuracy};
  const scene::SceneDescription scene = simulation.scene();
  ProgressBar bar(0, 1, !arguments.quiet);
  TrialRuns trials(scene, {(arguments.until - simulation.time()) / kJudgedTimes, kJudgedTimes}, {}, {}, [&] {
    bar.show(0, "meshes");
    return interruption() == 0;
  });
  const AutomaticMeshes meshes = automatic_meshes(trials, kMeshShare * accuracy);
  bar.clear();
  if (!meshes.is_met)
    fmt::print(stderr, "flexarm: elements=\"auto\": the accuracy {:g} was not met: {}\n", accuracy, meshes.shortcoming);
  if (meshes.is_chosen) {  // else those of the present rule stay
    if (!arguments.quiet)
      fmt::print(report_stream(arguments), "{}; error {:.2g} estimated, after {} runs\n",
                 names_of(scene, meshes.settings), meshes.error, meshes.runs);
    simulation = Simulation(with_settings(scene, meshes.settings), arguments.options);
  }
  return {meshes.left(accuracy), meshes.error, meshes.is_met};
}

}  // namespace flexarm::cli
