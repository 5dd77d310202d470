#include "accuracy/run_settings.h"

#include <stdexcept>
#include <tuple>

#include <fmt/format.h>

namespace flexarm {

std::string BeamResolution::text() const {
  if (elements == 0) return "rigid";
  return fmt::format("{} x {}", elements ? std::to_string(*elements) : "auto", order);
}

bool BeamResolution::operator<(const BeamResolution& other) const {
  return std::tie(elements, order) < std::tie(other.elements, other.order);
}

bool BeamResolution::operator==(const BeamResolution& other) const {
  return elements == other.elements && order == other.order;
}

std::string RunSettings::mesh() const {
  if (beams.empty()) return "–";
  std::string text;
  for (const BeamResolution& beam : beams) text += (text.empty() ? "" : ", ") + beam.text();
  return text;
}

bool RunSettings::operator<(const RunSettings& other) const {
  return std::tie(beams, scheme, step, tolerance) < std::tie(other.beams, other.scheme, other.step, other.tolerance);
}

RunSettings settings_of(const scene::SceneDescription& scene) {
  RunSettings settings;
  for (const scene::LinkDescription& link : scene.links)
    if (link.beam) settings.beams.push_back({link.beam->elements, link.beam->order});
  settings.scheme = scene.integrator.scheme;
  settings.step = scene.integrator.step;
  settings.tolerance = scene.integrator.tolerance;
  return settings;
}

scene::SceneDescription with_settings(scene::SceneDescription scene, const RunSettings& settings) {
  auto resolution = settings.beams.begin();
  for (scene::LinkDescription& link : scene.links) {
    if (!link.beam) continue;
    if (resolution == settings.beams.end()) throw std::invalid_argument("the scene has more beams than the settings");
    link.beam->elements = resolution->elements;
    link.beam->order = resolution->order;
    ++resolution;
  }
  if (resolution != settings.beams.end()) throw std::invalid_argument("the scene has fewer beams than the settings");
  if (settings.scheme != scene.integrator.scheme) scene.integrator = with_scheme(scene.integrator, settings.scheme);
  scene.integrator.step = settings.step;
  scene.integrator.tolerance = settings.tolerance;
  return scene;
}

}  // namespace flexarm
