#include "cli/commands.h"

int main(int argc, char** argv) {
  using namespace flexarm::cli;
  CommandLine line("flexarm", "Simulates flexible manipulators.");
  add_check(line);
  add_simulate(line);
  add_show(line);
  add_film(line);
  add_expand(line);
  add_static(line);
  add_modes(line);
  add_linearise(line);
  add_replay(line);
  add_tune(line);
  add_sweep(line);
  add_identify(line);
  add_plot(line);
  add_bench(line);
  add_completion(line);
  return line.run(argc, argv);
}
