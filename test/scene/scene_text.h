#pragma once
/// A good scene as text, and functions that put errors into it.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "flexarm/scene/urdf_reader.h"
#include "support/source_path.h"

namespace flexarm::scene {

inline std::string text_of_file(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// A scene that uses every element. It is also a seed of the fuzzer.
inline const std::string kGoodScene = text_of_file(test::source_path("test/fuzz/seeds/everything.urdf"));

/// Returns the good scene with `from`, which must occur exactly once, replaced by `to`.
inline std::string good_scene_with(const std::string& from, const std::string& to) {
  std::string text = kGoodScene;
  const std::size_t found = text.find(from);
  if (found == std::string::npos || text.find(from, found + 1) != std::string::npos) {
    ADD_FAILURE() << "'" << from << "' must be in the scene once";
    return text;
  }
  return text.replace(found, from.size(), to);
}

inline ReadResult read(const std::string& text) {
  return read_scene_text(text, "scene.urdf");
}

/// The good scene as data. There must be no findings.
inline SceneDescription good_scene() {
  const ReadResult result = read(kGoodScene);
  EXPECT_TRUE(result.diagnostics.empty()) << to_text(result.diagnostics);
  return result.scene.value();
}

/// Returns all findings about a scene that is refused, with " | " between them.
inline std::string findings_of(const std::string& text) {
  const ReadResult result = read(text);
  EXPECT_FALSE(result.scene) << text;
  std::string found;
  for (const Diagnostic& finding : result.diagnostics) found += (found.empty() ? "" : " | ") + finding.text();
  return found;
}

/// Reads a scene from a file, with a table in the same folder.
inline ReadResult read_with_table(const std::string& text, const std::string& name, const std::string& table) {
  const std::string folder = testing::TempDir();
  std::ofstream(folder + name) << table;
  const std::string path = folder + "beside_" + name + ".urdf";
  std::ofstream(path) << text;
  return read_scene_file(path);
}

/// Expects exactly one error, on this line, with a message that contains the fragment.
inline void expect_one_error(const std::string& text, int line, const std::string& fragment) {
  const ReadResult result = read(text);
  EXPECT_FALSE(result.scene);
  ASSERT_EQ(result.diagnostics.size(), 1u) << "expected: " << fragment << "\n" << to_text(result.diagnostics);
  EXPECT_EQ(result.diagnostics[0].line, line) << result.diagnostics[0].text();
  EXPECT_NE(result.diagnostics[0].text().find(fragment), std::string::npos) << "expected: " << fragment << "\n"
                                                                            << result.diagnostics[0].text();
}

/// Expects exactly one error, on this line, of the good scene with one replacement.
inline void expect_error(const std::string& from, const std::string& to, int line, const std::string& fragment) {
  SCOPED_TRACE(from + " -> " + to);
  expect_one_error(good_scene_with(from, to), line, fragment);
}

/// Expects a scene with a warning on this line whose message contains the fragment.
inline void expect_warning(const ReadResult& result, int line, const std::string& fragment) {
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  for (const Diagnostic& finding : result.diagnostics)
    if (finding.line == line && finding.text().find(fragment) != std::string::npos) return;
  ADD_FAILURE() << "expected at line " << line << ": " << fragment << "\n" << to_text(result.diagnostics);
}

}  // namespace flexarm::scene
