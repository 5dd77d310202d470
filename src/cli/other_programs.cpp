#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/installation.h"
#include "cli/other_programs.h"

namespace flexarm::cli {
namespace {

/// Replaces this process by the program words[0], with all words as its arguments.
[[noreturn]] void become(const std::string& command, std::vector<std::string> words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  throw std::runtime_error(fmt::format("{}: cannot run '{}': {}", command, words.front(), std::strerror(errno)));
}

[[noreturn]] void become_benchmarks(const std::vector<std::string>& arguments) {
  const std::optional<std::string> program = own_program("flexarm_benchmarks");
  if (!program) throw std::runtime_error("bench: its program flexarm_benchmarks is not installed beside this program");
  std::vector<std::string> words = {*program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  become("bench", words);
}

}  // namespace

void become_python(const std::string& command, const std::string& script, const std::vector<std::string>& arguments) {
  const std::optional<std::string> path_of_script = own_script(script);
  if (!path_of_script)
    throw std::runtime_error(fmt::format("{}: its script {} is not installed beside this program", command, script));
  const std::optional<std::string> folder = python_folder();
  if (!folder) throw std::runtime_error(command + ": the Python package flexarm is not installed beside this program");
  const char* others = std::getenv("PYTHONPATH");
  const std::string path = others && *others ? *folder + ":" + others : *folder;
  setenv("PYTHONPATH", path.c_str(), 1);
  std::vector<std::string> words = {"/usr/bin/python3", *path_of_script};
  words.insert(words.end(), arguments.begin(), arguments.end());
  become(command, words);
}

void add_sweep(CommandLine& line) {
  line.program("sweep", "Runs a scene many times, with the parameters of a plan", CommandLine::Kind::Other,
               [](const Words& words) -> int { become_python("sweep", "sweep.py", words); });
}

void add_identify(CommandLine& line) {
  line.program("identify", "Finds the values of a scene's parameters with which its motion fits measurements",
               CommandLine::Kind::Other,
               [](const Words& words) -> int { become_python("identify", "identify.py", words); });
}

void add_plot(CommandLine& line) {
  line.program("plot", "Draws columns of results: as a picture, in a window, or in the terminal",
               CommandLine::Kind::Other, [](const Words& words) -> int { become_python("plot", "plot.py", words); });
}

void add_film(CommandLine& line) {
  line.program("film", "Films a run, as MP4, GIF or PNG: the picture of `show`, without a display",
               CommandLine::Kind::Other, [](const Words& words) -> int { become_python("film", "film.py", words); });
}

void add_bench(CommandLine& line) {
  line.program("bench", "Measures the simulator itself", CommandLine::Kind::LikeThis,
               [](const Words& words) -> int { become_benchmarks(words); });
}

}  // namespace flexarm::cli
