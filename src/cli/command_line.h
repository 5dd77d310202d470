#pragma once
/// A program's set of commands, and its start and end. For `flexarm`, and for `flexarm_benchmarks` (`flexarm bench`).

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/exit_status.h"

namespace flexarm::cli {

class CommandLine {
 public:
  /// @param name  as the user types it: "flexarm"
  CommandLine(std::string name, std::string description);

  /// Adds a command. The reference is valid as long as this object.
  Command& command(const std::string& name, const std::string& description);
  /// Adds a command that is another program. All words after its name, including --help, go to `run`, which should
  /// replace this process by that program. Kind::LikeThis: the program has a CommandLine, too, which is asked for
  /// completions.
  enum class Kind { LikeThis, Other };
  void program(const std::string& name, const std::string& description, Kind kind,
               std::function<int(const Words& words)> run);

  /// Runs the command that the user typed, and prints exceptions. @returns the exit status of the program
  int run(int argc, char** argv) const;

 private:
  struct Program {
    std::string name, description;
    Kind kind;
    std::function<int(const Words& words)> run;
  };
  struct Named {
    std::string name;
    Command command;
  };

  int dispatch(const Words& words) const;
  int complete(const Words& words) const;
  void print_help() const;
  /// Names with descriptions, in the order of declaration.
  std::vector<Completion> all() const;

  std::string name_, description_;
  std::deque<Named> commands_;
  std::vector<Program> programs_;
};

/// With this word and the words typed so far, a shell asks a program for completions.
constexpr const char* kComplete = "--complete";

}  // namespace flexarm::cli
