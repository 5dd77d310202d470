#pragma once
/// Runs the program by a shell, and reads its output.

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

/// Returns the path of a temporary file that belongs to the running test alone.
inline std::string temporary(const std::string& name) {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  return testing::TempDir() + "flexarm_" + test->test_suite_name() + "_" + test->name() + "_" + name;
}

inline std::string example(const std::string& name) {
  return test::source_path("config/examples/" + name + ".urdf");
}

/// Writes a scene into a file that belongs to the running test alone, and returns the path.
inline std::string scene_file(const std::string& text) {
  const std::string path = temporary("scene.urdf");
  std::ofstream(path) << text;
  return path;
}

inline void expect_contains(const std::string& text, const std::string& fragment) {
  EXPECT_NE(text.find(fragment), std::string::npos) << "expected '" << fragment << "' in:\n" << text;
}

/// Returns the path of the program under test.
std::string program();

/// Returns words that start the program so that SIGINT ends it even in the background; a shell lets background programs
/// ignore SIGINT. (`env --default-signal` does the same, but Ubuntu 20.04 does not have it.)
inline std::string interruptible_program() {
  return "/usr/bin/python3 -c 'import os, signal as s, sys; s.signal(s.SIGINT, s.SIG_DFL); s.signal(s.SIGPIPE, "
         "s.SIG_DFL); os.execv(sys.argv[1], sys.argv[1:])' '" +
         program() + "' ";
}

/// Runs a shell command, in which the word "flexarm" stands for the program under test.
inline Outcome shell(const std::string& command) {
  const std::string output = temporary("stdout"), errors = temporary("stderr");
  const std::string script =
      "flexarm() { '" + program() + "' \"$@\"; }\n{ " + command + "\n} > '" + output + "' 2> '" + errors + "'";
  const int status = std::system(script.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(output), read_file(errors)};
}

/// The columns of a table that was read from CSV, by name.
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
