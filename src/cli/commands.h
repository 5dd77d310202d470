#pragma once
/// The subcommands of `flexarm`, one file each.

#include <stdexcept>

#include <CLI/CLI.hpp>

namespace flexarm::cli {

/// A command that a signal has ended has the status that a shell gives to a program killed by it.
enum ExitStatus { kDone = 0, kFailed = 1, kBadInput = 2, kInterrupted = 128 /* + the signal's number */ };

/// What the user gave cannot be used; what() is printed and the exit status is kBadInput.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A signal wants the program to end: what() says how far it came, the exit status is kInterrupted and its number.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Each adds its subcommand to `app`; when that is run, it leaves its exit status in `status`.
void add_check(CLI::App& app, int& status);
void add_simulate(CLI::App& app, int& status);
void add_expand(CLI::App& app, int& status);
void add_static(CLI::App& app, int& status);
void add_modes(CLI::App& app, int& status);
void add_linearise(CLI::App& app, int& status);
void add_replay(CLI::App& app, int& status);
void add_tune(CLI::App& app, int& status);
void add_sweep(CLI::App& app, int& status);
void add_identify(CLI::App& app, int& status);
void add_bench(CLI::App& app, int& status);

}  // namespace flexarm::cli
