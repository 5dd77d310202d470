#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/installation.h"

namespace flexarm::cli {
namespace {

/// Becomes the script, which has options of its own.
[[noreturn]] void identify(const std::vector<std::string>& arguments) {
  const std::optional<std::string> folder = python_folder(), script = own_script("identify.py");
  if (!folder || !script)
    throw std::runtime_error("identify: the Python package flexarm is not installed beside this program");
  const char* others = std::getenv("PYTHONPATH");
  const std::string path = others && *others ? *folder + ":" + others : *folder;
  setenv("PYTHONPATH", path.c_str(), 1);
  std::signal(SIGPIPE, SIG_DFL);  // Python has an exception for it
  std::signal(SIGXFSZ, SIG_DFL);
  std::vector<std::string> words = {"/usr/bin/python3", *script};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  throw std::runtime_error(fmt::format("identify: cannot run '{}': {}", words.front(), std::strerror(errno)));
}

}  // namespace

void add_identify(CLI::App& app, int& /*status*/) {
  CLI::App* command =
      app.add_subcommand("identify", "Finds values of a scene's parameters with which it moves as was measured");
  command->prefix_command()->set_help_flag();
  command->callback([command] { identify(command->remaining()); });
}

}  // namespace flexarm::cli
