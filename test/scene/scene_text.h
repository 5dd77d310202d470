#pragma once
/// A good scene as text, and ways to spoil it.

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

/// Uses every element. It is a seed of the fuzzer, too.
inline const std::string kGoodScene = text_of_file(test::source_path("test/fuzz/seeds/everything.urdf"));

/// The good scene with `from`, which must be there once, replaced.
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

/// The same from a file beside which lies a table.
inline ReadResult read_with_table(const std::string& text, const std::string& name, const std::string& table) {
  const std::string folder = testing::TempDir();
  std::ofstream(folder + name) << table;
  const std::string path = folder + "beside_" + name + ".urdf";
  std::ofstream(path) << text;
  return read_scene_file(path);
}

/// Expects exactly one error, at this line, whose text contains the fragment.
inline void expect_one_error(const std::string& text, int line, const std::string& fragment) {
  const ReadResult result = read(text);
  EXPECT_FALSE(result.scene);
  ASSERT_EQ(result.diagnostics.size(), 1u) << "expected: " << fragment << "\n" << to_text(result.diagnostics);
  EXPECT_EQ(result.diagnostics[0].line, line) << result.diagnostics[0].text();
  EXPECT_NE(result.diagnostics[0].text().find(fragment), std::string::npos) << "expected: " << fragment << "\n"
                                                                            << result.diagnostics[0].text();
}

/// The good scene with one replacement has one error, at this line.
inline void expect_error(const std::string& from, const std::string& to, int line, const std::string& fragment) {
  SCOPED_TRACE(from + " -> " + to);
  expect_one_error(good_scene_with(from, to), line, fragment);
}

/// Expects a scene, and among its warnings one at this line whose text contains the fragment.
inline void expect_warning(const ReadResult& result, int line, const std::string& fragment) {
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  for (const Diagnostic& finding : result.diagnostics)
    if (finding.line == line && finding.text().find(fragment) != std::string::npos) return;
  ADD_FAILURE() << "expected at line " << line << ": " << fragment << "\n" << to_text(result.diagnostics);
}

}  // namespace flexarm::scene
