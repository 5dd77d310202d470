/// Tests that the example scenes are read without any message, are valid URDF for other tools, and are those of the
/// guide.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scene/scene_text.h"
#include "support/source_path.h"

namespace flexarm::scene {
namespace {

std::vector<std::string> example_scenes() {
  std::vector<std::string> paths;
  for (const char* folder : {"config/examples", "config/speed"})
    for (const auto& entry : std::filesystem::directory_iterator(test::source_path(folder)))
      if (entry.path().extension() == ".urdf") paths.push_back(entry.path());
  return paths;
}

}  // namespace

TEST(ExampleScenes, AreReadWithoutAnyFinding) {
  const std::vector<std::string> paths = example_scenes();
  EXPECT_GE(paths.size(), 5u);
  for (const std::string& path : paths) {
    const ReadResult result = read_scene_file(path);
    EXPECT_TRUE(result.scene) << path;
    EXPECT_TRUE(result.diagnostics.empty()) << to_text(result.diagnostics);
  }
}

TEST(ExampleScenes, AreValidUrdfForOtherTools) {
  if (std::system("command -v check_urdf > /dev/null") != 0) GTEST_SKIP() << "check_urdf (liburdfdom-tools) is missing";
  for (const std::string& path : example_scenes())
    EXPECT_EQ(std::system(("check_urdf '" + path + "' > /dev/null").c_str()), 0) << path;
}

TEST(ExampleScenes, TheGuideShowsTheCantilever) {
  const auto text = [](const std::string& path) {
    std::stringstream stream;
    stream << std::ifstream(test::source_path(path)).rdbuf();
    return stream.str();
  };
  EXPECT_NE(text("docs/scene_format.md").find(text("config/examples/cantilever.urdf")), std::string::npos);
}

}  // namespace flexarm::scene
