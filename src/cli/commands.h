#pragma once
/// The subcommands of `flexarm`, one file each, but for those that are programs of their own.

#include "cli/command_line.h"

namespace flexarm::cli {

void add_check(CommandLine& line);
void add_simulate(CommandLine& line);
void add_expand(CommandLine& line);
void add_static(CommandLine& line);
void add_modes(CommandLine& line);
void add_linearise(CommandLine& line);
void add_replay(CommandLine& line);
void add_tune(CommandLine& line);

/// Subcommands that are programs beside this one, which take the place of this process (other_programs.cpp).
void add_sweep(CommandLine& line);
void add_identify(CommandLine& line);
void add_bench(CommandLine& line);

/// How shells learn the commands (completion.cpp).
void add_completion(CommandLine& line);

}  // namespace flexarm::cli
