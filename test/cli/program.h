#pragma once
/// Runs the program as a shell does.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/source_path.h"

namespace flexarm::cli {

struct Outcome {
  int status;  ///< exit status; -1 if it was killed
  std::string output, errors;
};

inline std::string read_file(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// A path for this test alone.
inline std::string temporary(const std::string& name) {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  return testing::TempDir() + "flexarm_" + test->test_suite_name() + "_" + test->name() + "_" + name;
}

inline std::string example(const std::string& name) {
  return test::source_path("config/examples/" + name + ".urdf");
}

/// Writes a scene for this test alone and returns its path.
inline std::string scene_file(const std::string& text) {
  const std::string path = temporary("scene.urdf");
  std::ofstream(path) << text;
  return path;
}

inline void expect_contains(const std::string& text, const std::string& fragment) {
  EXPECT_NE(text.find(fragment), std::string::npos) << "expected '" << fragment << "' in:\n" << text;
}

/// The path of the program.
std::string program();

/// Runs a shell command in which "flexarm" stands for the program.
inline Outcome shell(const std::string& command) {
  const std::string output = temporary("stdout"), errors = temporary("stderr");
  const std::string script =
      "flexarm() { '" + program() + "' \"$@\"; }\n{ " + command + "\n} > '" + output + "' 2> '" + errors + "'";
  const int status = std::system(script.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(output), read_file(errors)};
}

/// A table read back from CSV, by column.
using Columns = std::map<std::string, std::vector<double>>;

inline std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

inline Columns read_csv(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = split(line);
  Columns columns;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = split(line);
    EXPECT_EQ(fields.size(), names.size());
    for (std::size_t i = 0; i < fields.size() && i < names.size(); ++i)
      columns[names[i]].push_back(std::stod(fields[i]));
  }
  return columns;
}

}  // namespace flexarm::cli
