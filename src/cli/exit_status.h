#pragma once
/// What programs of the command line end with.

#include <stdexcept>

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

}  // namespace flexarm::cli
