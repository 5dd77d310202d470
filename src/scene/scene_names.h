#pragma once
/// Names of things in a scene: each is unique, and chains of names have an end (internal to scene/).

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// The link to which a floating root link is joined, and that nobody needs to declare.
constexpr const char* kWorld = "world";

inline std::string element_of(const char* tag, const std::string& name) {
  return "<" + std::string(tag) + "> " + quoted(name);
}

/// Names of the scene's links, but for those that are missing.
inline std::vector<std::string> link_names(const SceneDescription& scene) {
  std::vector<std::string> names;
  names.reserve(scene.links.size());
  for (const LinkDescription& link : scene.links)
    if (!link.name.empty()) names.push_back(link.name);
  return names;
}

/// Names of the scene's force elements of a kind.
inline std::vector<std::string> force_element_names(const SceneDescription& scene, std::string_view kind) {
  std::vector<std::string> names;
  for (const auto& element : scene.force_elements)
    if (element->kind() == kind && !element->name.empty()) names.push_back(element->name);
  return names;
}

inline std::string line_text(const SourceLocation& location) {
  return "line " + std::to_string(location.line);
}

using NamesTaken = std::map<std::string, int>;  // names, and the lines in which they first occur

/// Records an error if the name is in `taken`; else adds it.
template <class Named>
void check_name(const Named& thing, const char* tag, Findings& findings, NamesTaken& taken) {
  const auto [first, is_new] = taken.emplace(thing.name, thing.location.line);
  if (!is_new && !thing.name.empty())
    findings.error(thing.location.line, element_of(tag, thing.name),
                   "name is taken, by line " + std::to_string(first->second), quoted(thing.name));
}

/// Records errors for names that occur twice. Errors for missing names are recorded elsewhere.
template <class Named>
NamesTaken check_unique(const std::vector<Named>& things, const char* tag, Findings& findings, NamesTaken taken = {}) {
  for (const Named& thing : things) check_name(thing, tag, findings, taken);
  return taken;
}

/// Follows the chain of `next` from every name, and returns one name of each ring. `next` returns a name, or nothing at
/// the end of a chain.
template <class Named, class Next>
std::vector<std::string> find_rings(const std::vector<Named>& things, const Next& next) {
  std::vector<std::string> rings;
  std::map<std::string, int> visits;  // by name: the number of the walk that first reached it
  int walk = 0;
  for (const Named& thing : things) {
    ++walk;
    std::string name = thing.name;
    std::optional<std::string> following = next(name);
    while (following && visits.emplace(name, walk).second) {
      name = *following;
      following = next(name);
    }
    if (following && visits.at(name) == walk) rings.push_back(name);
  }
  return rings;
}

}  // namespace flexarm::scene
