#pragma once
/// The arms that the documentation shows.

#include <fstream>
#include <sstream>

#include "support/scene_text.h"

namespace flexarm::test {

/// The second scene of docs/guide.md.
inline scene::SceneDescription guide_arm() {
  std::stringstream guide;
  guide << std::ifstream(source_path("docs/guide.md")).rdbuf();
  const std::string text = guide.str(), end = "</robot>";
  const std::size_t from = text.find("<robot name=\"arm\">"), to = text.find(end, from) + end.size();
  return scene_of(text.substr(from, to - from));
}
inline scene::SceneDescription demo_arm() {
  return scene_at("config/demo_arm.urdf");
}

}  // namespace flexarm::test
