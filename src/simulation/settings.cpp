#include "simulation/settings.h"

#include <fmt/format.h>

#include "schemes/slide_scheme.h"

namespace flexarm {

std::string integrator_place(const scene::SceneDescription& scene) {
  const scene::SourceLocation& place = scene.integrator_location;
  return place.line > 0 ? fmt::format("{}:{}: ", place.file, place.line) : scene.file + ": ";
}

StepSettings settings_of(const scene::SceneDescription& scene, const SimulationOptions& options) {
  StepSettings settings;
  settings.step = options.step.value_or(scene.integrator.step);
  settings.tolerance = options.tolerance.value_or(scene.integrator.tolerance);
  settings.max_iterations = scene.integrator.max_iterations;
  settings.max_halvings = scene.integrator.max_halvings;
  settings.reuse_factorisation = options.reuse_factorisation;
  settings.on_failure = scene.integrator.on_failure;
  settings.recovery_wall_time = options.recovery_wall_time;
  const auto require = [&](bool ok, const std::string& what) {
    if (!ok) throw ModelError(integrator_place(scene) + "<integrator>: " + what);
  };
  require(settings.step > 0 && settings.step <= kLongestStep, "step must be > 0 and at most 1e9");
  require(settings.tolerance > 0 && settings.tolerance <= kLargestTolerance, "tolerance must be > 0 and at most 1");
  if (!(settings.recovery_wall_time >= 0))
    throw ModelError(fmt::format("recovery_wall_time: expected a time >= 0, got {} s", settings.recovery_wall_time));
  require(settings.max_iterations >= 1, "max_iterations must be >= 1");
  require(settings.max_halvings >= 0 && settings.max_halvings <= 30, "max_halvings must be 0 to 30");
  return settings;
}

scene::SceneDescription with_options(scene::SceneDescription scene, const SimulationOptions& options) {
  if (options.scheme) scene.integrator = with_scheme(scene.integrator, *options.scheme);
  if (options.on_failure) scene.integrator.on_failure = *options.on_failure;
  const StepSettings settings = settings_of(scene, options);
  scene.integrator.step = settings.step;
  scene.integrator.tolerance = settings.tolerance;
  return scene;
}

void require_suitable_slides(const scene::SceneDescription& scene, const Scheme& scheme) {
  for (const auto* joints : {&scene.joints, &scene.loop_joints})
    for (const scene::JointDescription& joint : *joints) {
      if (!joint.slide) continue;
      const std::string conflict = slide_scheme_conflict(*find_slide_scheme(joint.slide->scheme), scheme);
      const scene::SourceLocation& place = joint.slide->location;
      if (!conflict.empty())
        throw ModelError(fmt::format("{}:{}: <slide> of joint '{}': {}", place.file, place.line, joint.name, conflict));
    }
}

}  // namespace flexarm
