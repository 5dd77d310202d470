/// The good scene spoilt in one place, and all that is said about it, word for word: broken_scenes.tsv. Each of its
/// lines has what is replaced, by what, and the findings, separated by tabs and the findings by " | ".

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
