/// Tests the good scene with one error at a time: all messages must be as expected, word for word. Each line of
/// broken_scenes.tsv has the replaced text, its replacement, and the messages, separated by tabs. Messages are
/// separated by " | ".

#include <fstream>
#include <set>
#include <sstream>

#include "scene/scene_text.h"
#include "support/source_path.h"

namespace flexarm::scene {

TEST(BrokenScenes, AreRefusedWithExactlyTheseWords) {
  std::ifstream table(test::source_path("test/scene/broken_scenes.tsv"));
  std::set<std::string> scenes;
  for (std::string line; std::getline(table, line);) {
    std::stringstream fields(line);
    std::string replaced, by, expected, found;
    std::getline(fields, replaced, '\t');
    std::getline(fields, by, '\t');
    std::getline(fields, expected);
    const ReadResult result = read(good_scene_with(replaced, by));
    for (const Diagnostic& finding : result.diagnostics) found += (found.empty() ? "" : " | ") + finding.text();
    EXPECT_FALSE(result.scene) << line;
    EXPECT_EQ(found, expected) << line;
    scenes.insert(replaced + '\t' + by);
  }
  EXPECT_GE(scenes.size(), 140u);
}

}  // namespace flexarm::scene
