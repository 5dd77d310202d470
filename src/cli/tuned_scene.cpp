#include "cli/tuned_scene.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "cli/attribute_editor.h"
#include "flexarm/scene/urdf_reader.h"

namespace flexarm::cli {
namespace {

/// Null: there is none.
const TagPlace* find_beam(const std::vector<TagPlace>& tags, const std::string& link) {
  const auto found = std::find_if(tags.begin(), tags.end(), [&](const TagPlace& tag) {
    return tag.name == "beam" && tag.link == link && tag.above.size() == 2;
  });
  return found == tags.end() ? nullptr : &*found;
}

const TagPlace* find_tag(const std::vector<TagPlace>& tags, const std::string& name,
                         const std::vector<std::string>& above) {
  const auto found = std::find_if(tags.begin(), tags.end(),
                                  [&](const TagPlace& tag) { return tag.name == name && tag.above == above; });
  return found == tags.end() ? nullptr : &*found;
}

/// Where <integrator> begins; it is there from now on.
std::size_t integrator_of(std::string& text) {
  const std::string root = find_tags(text).at(0).name;
  if (const std::vector<TagPlace> tags = find_tags(text);
      const TagPlace* tag = find_tag(tags, "integrator", {root, "simulation"}))
    return tag->begin;
  if (!find_tag(find_tags(text), "simulation", {root})) {
    const std::size_t end = text.rfind("</" + root);
    text.insert(end, "  <simulation>\n  </simulation>\n");
  }
  const std::vector<TagPlace> tags = find_tags(text);
  const TagPlace& simulation = *find_tag(tags, "simulation", {root});
  if (simulation.is_empty) text.replace(simulation.end - 2, 2, ">\n  </simulation>");
  text.insert(find_tag(find_tags(text), "simulation", {root})->end, "\n    <integrator/>");
  const std::vector<TagPlace> after = find_tags(text);
  return find_tag(after, "integrator", {root, "simulation"})->begin;
}

void set_beams(std::string& text, const scene::SceneDescription& scene, const RunSettings& settings) {
  const RunSettings own = settings_of(scene);
  std::size_t beam = 0;
  for (const scene::LinkDescription& link : scene.links) {
    if (!link.beam) continue;
    const BeamResolution &now = own.beams[beam], &then = settings.beams[beam];
    ++beam;
    const std::vector<TagPlace> tags = find_tags(text);
    const TagPlace* tag = find_beam(tags, link.name);
    if (!tag) continue;  // found out below
    if (then.order != now.order && then.elements != 0)
      set_attribute(text, tag->begin, "order", std::to_string(then.order));
    if (then.elements != now.elements)
      set_attribute(text, tag->begin, "elements", then.elements ? std::to_string(*then.elements) : "auto");
  }
}

void set_integrator(std::string& text, const scene::SceneDescription& scene, const RunSettings& settings) {
  const RunSettings own = settings_of(scene);
  const bool is_accurate = scene.integrator.accuracy.has_value();  // its steps would not be those that were tuned
  if (!is_accurate && settings.scheme == own.scheme && settings.step == own.step && settings.tolerance == own.tolerance)
    return;
  const std::size_t begin = integrator_of(text);
  if (is_accurate) remove_attribute(text, begin, "accuracy");
  if (settings.scheme != own.scheme) set_attribute(text, begin, "scheme", settings.scheme);
  if (settings.step != own.step) set_attribute(text, begin, "step", fmt::format("{}", settings.step));
  if (settings.tolerance != own.tolerance)
    set_attribute(text, begin, "tolerance", fmt::format("{}", settings.tolerance));
  IntegratorDescription with_all = scene.integrator;
  with_all.scheme = settings.scheme;
  for (const OptionConflict& conflict : option_conflicts(with_all)) remove_attribute(text, begin, conflict.attribute);
}

}  // namespace

std::string tuned_text(const std::string& text, const scene::SceneDescription& scene, const RunSettings& settings) {
  std::string out = text;
  set_beams(out, scene, settings);
  set_integrator(out, scene, settings);
  scene::ReadOptions as_set;
  for (const scene::ParameterDescription& parameter : scene.parameters)
    as_set.parameters[parameter.name] = parameter.value;
  const scene::ReadResult read = scene::read_scene_text(out, scene.file, as_set);
  RunSettings got = read.scene ? settings_of(*read.scene) : RunSettings(), wanted = settings;
  for (RunSettings* some : {&got, &wanted})
    for (BeamResolution& beam : some->beams)
      if (beam.elements == 0) beam.order = 1;
  if (!read.scene || got < wanted || wanted < got)
    throw std::runtime_error(fmt::format("'{}' cannot be changed by its attributes alone", scene.file));
  return out;
}

}  // namespace flexarm::cli
