#pragma once
/// The commands of a program, and how it begins and ends: `flexarm`, and `flexarm_benchmarks` behind `flexarm bench`.

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/exit_status.h"

namespace flexarm::cli {

class CommandLine {
 public:
  /// `name` as it is typed: "flexarm".
  CommandLine(std::string name, std::string description);

  /// Valid as long as this.
  Command& command(const std::string& name, const std::string& description);
  /// A command whose words, --help included, are another program's, which run() becomes; one like this is asked what
  /// may be typed next.
  enum class Kind { LikeThis, Other };
  void program(const std::string& name, const std::string& description, Kind kind,
               std::function<int(const Words& words)> run);

  /// Runs the command that was typed, and prints what it throws. To be returned by main().
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
  /// Names with their descriptions, in the order in which they were declared.
  std::vector<Completion> all() const;

  std::string name_, description_;
  std::deque<Named> commands_;
  std::vector<Program> programs_;
};

/// The words by which a shell asks a program what may be typed next: this one, and behind it those so far.
constexpr const char* kComplete = "--complete";

}  // namespace flexarm::cli
