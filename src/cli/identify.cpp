#include <optional>
#include <stdexcept>
#include <string>

#include "cli/commands.h"
#include "cli/installation.h"
#include "cli/python_program.h"

namespace flexarm::cli {
namespace {

std::string script() {
  const std::optional<std::string> path = own_script("identify.py");
  if (!path) throw std::runtime_error("identify: its script identify.py is not installed beside this program");
  return *path;
}

}  // namespace

void add_identify(CLI::App& app, int& /*status*/) {
  CLI::App* command =
      app.add_subcommand("identify", "Finds values of a scene's parameters with which it moves as was measured");
  command->prefix_command()->set_help_flag();
  command->callback([command] { become_python("identify", {script()}, command->remaining()); });
}

}  // namespace flexarm::cli
