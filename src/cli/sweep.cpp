#include "cli/commands.h"
#include "cli/python_program.h"

namespace flexarm::cli {

void add_sweep(CLI::App& app, int& /*status*/) {
  CLI::App* command = app.add_subcommand("sweep", "Runs a scene many times, with the parameters of a plan");
  command->prefix_command()->set_help_flag();
  command->callback([command] { become_python("sweep", {"-m", "flexarm.sweep"}, command->remaining()); });
}

}  // namespace flexarm::cli
