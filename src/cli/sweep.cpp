#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <unistd.h>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/installation.h"

namespace flexarm::cli {
namespace {

/// Becomes the program of the Python package, which has options of its own.
[[noreturn]] void sweep(const std::vector<std::string>& arguments) {
  const std::optional<std::string> folder = python_folder();
  if (!folder) throw std::runtime_error("sweep: the Python package flexarm is not installed beside this program");
  const char* others = std::getenv("PYTHONPATH");
  const std::string path = others && *others ? *folder + ":" + others : *folder;
  setenv("PYTHONPATH", path.c_str(), 1);
  std::vector<std::string> words = {"/usr/bin/python3", "-P", "-m", "flexarm.sweep"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  throw std::runtime_error(fmt::format("sweep: cannot run '{}': {}", words.front(), std::strerror(errno)));
}

}  // namespace

void add_sweep(CLI::App& app, int& /*status*/) {
  CLI::App* command = app.add_subcommand("sweep", "Runs a scene many times, with the parameters of a plan");
  command->prefix_command()->set_help_flag();
  command->callback([command] { sweep(command->remaining()); });
}

}  // namespace flexarm::cli
