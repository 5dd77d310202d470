#include "cli/tuned_scene.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "flexarm/scene/urdf_reader.h"

namespace flexarm::cli {

// ---------------------------------------------------------------- attributes in the text of a file

// All other bytes of the text stay as they are.

namespace {

/// The place of a start tag in a text.
struct TagPlace {
  std::string name;                ///< "beam"
  std::vector<std::string> above;  ///< names of the enclosing elements, from the root
  std::string link;                ///< `name` of the enclosing link; empty: none
  std::size_t begin = 0, end = 0;  ///< of "<beam ...>" in the text
  bool is_empty = false;           ///< whether it is "<beam .../>"
};

constexpr std::size_t kNone = std::string::npos;

/// The place of an attribute in a text: the begin of its name, and the value between the quotes.
struct AttributePlace {
  std::string name;
  std::size_t begin, value_begin, value_end;
};

bool is_space(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

/// The end of a comment, CDATA section or declaration that begins at `i`; `i` if none begins there.
std::size_t after_opaque(const std::string& text, std::size_t i) {
  for (const auto& [begin, end] :
       {std::pair<std::string_view, std::string_view>("<!--", "-->"), {"<![CDATA[", "]]>"}, {"<?", "?>"}, {"<!", ">"}})
    if (text.compare(i, begin.size(), begin) == 0) {
      const std::size_t found = text.find(end, i + begin.size());
      return found == kNone ? text.size() : found + end.size();
    }
  return i;
}

/// The position after the '>' of the tag that begins at `i`.
std::size_t after_tag(const std::string& text, std::size_t i) {
  char quote = 0;
  for (; i < text.size(); ++i) {
    if (quote != 0) {
      if (text[i] == quote) quote = 0;
    } else if (text[i] == '"' || text[i] == '\'') {
      quote = text[i];
    } else if (text[i] == '>') {
      return i + 1;
    }
  }
  return text.size();
}

std::size_t after_name(const std::string& text, std::size_t i) {
  while (i < text.size() && !is_space(text[i]) && text[i] != '=' && text[i] != '>' && text[i] != '/') ++i;
  return i;
}

std::vector<AttributePlace> attributes(const std::string& text, std::size_t tag) {
  std::vector<AttributePlace> found;
  const std::size_t end = after_tag(text, tag);
  std::size_t i = after_name(text, tag + 1);
  while (true) {
    while (i < end && is_space(text[i])) ++i;
    const std::size_t begin = i, name_end = after_name(text, i), quote = text.find_first_of("\"'", name_end);
    if (name_end == begin || quote >= end) return found;
    const std::size_t value_end = text.find(text[quote], quote + 1);
    if (value_end == kNone) return found;
    found.push_back({text.substr(begin, name_end - begin), begin, quote + 1, value_end});
    i = value_end + 1;
  }
}

std::string decoded(std::string text) {
  for (const auto& [entity, character] :
       {std::pair("&lt;", "<"), {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}})
    for (std::size_t i = text.find(entity); i != kNone; i = text.find(entity, i + 1))
      text.replace(i, std::string_view(entity).size(), character);
  return text;
}

std::string value_of(const std::string& text, std::size_t tag, const std::string& name) {
  for (const AttributePlace& attribute : attributes(text, tag))
    if (attribute.name == name)
      return decoded(text.substr(attribute.value_begin, attribute.value_end - attribute.value_begin));
  return "";
}

/// All start tags of a well-formed text, in order, without those in comments and CDATA sections.
std::vector<TagPlace> find_tags(const std::string& text) {
  std::vector<TagPlace> tags;
  std::vector<std::string> open, links;
  for (std::size_t i = text.find('<'); i != kNone; i = text.find('<', i)) {
    if (const std::size_t end = after_opaque(text, i); end != i) {
      i = end;
      continue;
    }
    const std::size_t end = after_tag(text, i);
    if (text[i + 1] == '/') {
      if (!open.empty()) open.pop_back(), links.pop_back();
    } else {
      TagPlace tag{text.substr(i + 1, after_name(text, i + 1) - i - 1),
                   open,
                   links.empty() ? "" : links.back(),
                   i,
                   end,
                   text[end - 2] == '/'};
      if (!tag.is_empty) {
        open.push_back(tag.name);
        links.push_back(tag.name == "link" ? value_of(text, i, "name") : tag.link);
      }
      tags.push_back(std::move(tag));
    }
    i = end;
  }
  return tags;
}

/// Sets an attribute of the tag that begins at `begin`. A new attribute becomes the tag's last one.
void set_attribute(std::string& text, std::size_t begin, const std::string& name, const std::string& value) {
  const std::vector<AttributePlace> all = attributes(text, begin);
  for (const AttributePlace& attribute : all)
    if (attribute.name == name) {
      text.replace(attribute.value_begin, attribute.value_end - attribute.value_begin, value);
      return;
    }
  const std::size_t place = all.empty() ? after_name(text, begin + 1) : all.back().value_end + 1;
  text.insert(place, " " + name + "=\"" + value + "\"");
}

/// Removes an attribute, if the tag has it.
void remove_attribute(std::string& text, std::size_t begin, const std::string& name) {
  for (const AttributePlace& attribute : attributes(text, begin))
    if (attribute.name == name) {
      std::size_t from = attribute.begin;
      while (is_space(text[from - 1])) --from;
      text.erase(from, attribute.value_end + 1 - from);
      return;
    }
}

}  // namespace

// ---------------------------------------------------------------- settings in a scene

namespace {

/// Null if the link has no beam.
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

/// The position of <integrator>, which is added if it is missing.
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
    if (!tag) continue;  // reported below
    if (then.order != now.order && then.elements != 0)
      set_attribute(text, tag->begin, "order", std::to_string(then.order));
    if (then.elements != now.elements)
      set_attribute(text, tag->begin, "elements", then.elements ? std::to_string(*then.elements) : "auto");
  }
}

void set_integrator(std::string& text, const scene::SceneDescription& scene, const RunSettings& settings) {
  const RunSettings own = settings_of(scene);
  const bool is_accurate =
      scene.integrator.accuracy.has_value();  // with an accuracy, steps would not be the tuned ones
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
    throw std::runtime_error(fmt::format("'{}' cannot be tuned by changing attributes alone", scene.file));
  return out;
}

}  // namespace flexarm::cli
