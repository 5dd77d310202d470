#pragma once
/// The exit status of the command-line programs, and exceptions that lead to it.

#include <stdexcept>

namespace flexarm::cli {

/// A command that a signal ends has the status that shells report for programs killed by this signal.
enum ExitStatus { kDone = 0, kFailed = 1, kBadInput = 2, kInterrupted = 128 /* + the signal's number */ };

/// The user's input cannot be used. what() is printed, and the exit status is kBadInput.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A signal ended the program early. what() says how far it came; the exit status is kInterrupted plus the signal's
/// number.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace flexarm::cli
