#pragma once
/// The subcommands of `flexarm`, each in a file of its own, and those that are programs of their own.

#include "cli/command_line.h"

namespace flexarm::cli {

void add_check(CommandLine& line);
void add_simulate(CommandLine& line);
void add_show(CommandLine& line);
void add_expand(CommandLine& line);
void add_static(CommandLine& line);
void add_modes(CommandLine& line);
void add_linearise(CommandLine& line);
void add_replay(CommandLine& line);
void add_tune(CommandLine& line);

/// Subcommands that are programs of their own, which replace this process (other_programs.cpp).
void add_sweep(CommandLine& line);
void add_identify(CommandLine& line);
void add_plot(CommandLine& line);
void add_film(CommandLine& line);
void add_bench(CommandLine& line);

/// The command that prints completion scripts for shells (completion.cpp).
void add_completion(CommandLine& line);

}  // namespace flexarm::cli
