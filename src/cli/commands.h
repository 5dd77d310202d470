#pragma once
/// The subcommands of `flexarm`, one file each, but for those that are programs of their own.

#include <CLI/CLI.hpp>

#include "cli/command_line.h"

namespace flexarm::cli {

/// Each adds its subcommand to `app`; when that is run, it leaves its exit status in `status`.
void add_check(CLI::App& app, int& status);
void add_simulate(CLI::App& app, int& status);
void add_expand(CLI::App& app, int& status);
void add_static(CLI::App& app, int& status);
void add_modes(CLI::App& app, int& status);
void add_linearise(CLI::App& app, int& status);
void add_replay(CLI::App& app, int& status);
void add_tune(CLI::App& app, int& status);

/// Subcommands that are programs beside this one, which take the place of this process (other_programs.cpp).
void add_sweep(CLI::App& app);
void add_identify(CLI::App& app);
void add_bench(CLI::App& app);

}  // namespace flexarm::cli
