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

namespace flexarm::cli {
namespace {

/// This process becomes the program words[0], with all words as its arguments.
[[noreturn]] void become(const std::string& command, std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  throw std::runtime_error(fmt::format("{}: cannot run '{}': {}", command, words.front(), std::strerror(errno)));
}

/// This process becomes Python, which runs `program` ("-m", "flexarm.sweep") with the arguments of `command`.
[[noreturn]] void become_python(const std::string& command, const std::vector<std::string>& program,
                                const std::vector<std::string>& arguments) {
  const std::optional<std::string> folder = python_folder();
  if (!folder) throw std::runtime_error(command + ": the Python package flexarm is not installed beside this program");
  const char* others = std::getenv("PYTHONPATH");
  const std::string path = others && *others ? *folder + ":" + others : *folder;
  setenv("PYTHONPATH", path.c_str(), 1);
  // -P: a file of the folder where we are must not take the place of a module.
  std::vector<std::string> words = {"/usr/bin/python3", "-P"};
  words.insert(words.end(), program.begin(), program.end());
  words.insert(words.end(), arguments.begin(), arguments.end());
  become(command, words);
}

[[noreturn]] void become_identification(const std::vector<std::string>& arguments) {
  const std::optional<std::string> script = own_script("identify.py");
  if (!script) throw std::runtime_error("identify: its script identify.py is not installed beside this program");
  become_python("identify", {*script}, arguments);
}

[[noreturn]] void become_benchmarks(const std::vector<std::string>& arguments) {
  const std::optional<std::string> program = own_program("flexarm_benchmarks");
  if (!program) throw std::runtime_error("bench: its program flexarm_benchmarks is not installed beside this program");
  std::vector<std::string> words = {*program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  become("bench", words);
}

}  // namespace

void add_sweep(CommandLine& line) {
  line.program("sweep", "Runs a scene many times, with the parameters of a plan", CommandLine::Kind::Other,
               [](const Words& words) -> int {
                 become_python("sweep", {"-m", "flexarm.sweep"}, words);
               });
}

void add_identify(CommandLine& line) {
  line.program("identify", "Finds values of a scene's parameters with which it moves as was measured",
               CommandLine::Kind::Other, [](const Words& words) -> int { become_identification(words); });
}

void add_bench(CommandLine& line) {
  line.program("bench", "Measures the simulator itself", CommandLine::Kind::LikeThis,
               [](const Words& words) -> int { become_benchmarks(words); });
}

}  // namespace flexarm::cli
