#include "cli/command_line.h"
#include "cli/commands.h"

int main(int argc, char** argv) {
  using namespace flexarm::cli;
  CLI::App app("Simulates flexible manipulators.", "flexarm");
  app.require_subcommand(1);
  int status = kDone;
  add_check(app, status);
  add_simulate(app, status);
  add_expand(app, status);
  add_static(app, status);
  add_modes(app, status);
  add_linearise(app, status);
  add_replay(app, status);
  add_tune(app, status);
  add_sweep(app);
  add_identify(app);
  add_bench(app);
  return run_command_line(app, status, argc, argv);
}
