// The arms of the documentation; see documented_arms.h.
#include "reference/documented_arms.h"

#include <fstream>
#include <sstream>

#include "flexarm/scene/urdf_reader.h"
#include "support/source_path.h"

namespace flexarm::test {

scene::SceneDescription guide_arm() {
  std::stringstream guide;
  guide << std::ifstream(source_path("docs/guide.md")).rdbuf();
  const std::string text = guide.str(), begin = "<robot name=\"arm\">", end = "</robot>";
  const std::size_t from = text.find(begin), to = text.find(end, from) + end.size();
  return scene::read_scene_text(text.substr(from, to - from), "docs/guide.md").scene.value();
}

scene::SceneDescription demo_arm() {
  return scene::read_scene_file(source_path("config/demo_arm.urdf")).scene.value();
}

}  // namespace flexarm::test
