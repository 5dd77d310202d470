#pragma once
/// How the programs of the command line begin and end: `flexarm`, and `flexarm_benchmarks` behind `flexarm bench`.

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

/// Runs the commands of `app`, which leave their exit status in `status`, and prints what they throw. To be returned by
/// main().
int run_command_line(CLI::App& app, const int& status, int argc, char** argv);

// ---------------------------------------------------------------- signals that end a program, for loops to ask about

/// From now on SIGINT, SIGTERM and SIGHUP are only noted; a second one of the same kind ends the program as usual.
/// What is ignored already, as nohup has it and shells for what runs in the background, stays so.
void catch_interruptions();
/// The number of the first signal that has come; 0: none.
int interruption();

/// What cannot be written is an error of the function that writes, not a signal that ends the program.
void ignore_signals_of_output();

}  // namespace flexarm::cli
