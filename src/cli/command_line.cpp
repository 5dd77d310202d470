#include "cli/command_line.h"

#include <algorithm>
#include <cstdio>
#include <new>

#include <malloc.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/interruptions.h"
#include "flexarm/math/near_names.h"
#include "flexarm/model/model_error.h"

namespace flexarm::cli {

CommandLine::CommandLine(std::string name, std::string description)
    : name_(std::move(name)), description_(std::move(description)) {}

Command& CommandLine::command(const std::string& name, const std::string& description) {
  return commands_.emplace_back(Named{name, Command(name_ + " " + name, description)}).command;
}

void CommandLine::program(const std::string& name, const std::string& description, Kind kind,
                          std::function<int(const Words& words)> run) {
  programs_.push_back({name, description, kind, std::move(run)});
}

std::vector<Completion> CommandLine::all() const {
  std::vector<Completion> all;
  for (const Named& one : commands_) all.push_back({one.name, one.command.description()});
  for (const Program& one : programs_) all.push_back({one.name, one.description});
  return all;
}

void CommandLine::print_help() const {
  fmt::print("{}\nUsage: {} [OPTIONS] SUBCOMMAND\n\nSubcommands, each with its own --help:\n", description_, name_);
  for (const Completion& one : all()) fmt::print("  {:<12} {}\n", one.word, one.help);
  fmt::print("\nOptions:\n  {:<12} prints this help\n  {:<12} prints the version\n", "-h, --help", "--version");
}

int CommandLine::dispatch(const Words& words) const {
  const std::string help = fmt::format("\n'{} --help' lists what is expected", name_);
  std::vector<std::string> names;
  for (const Completion& one : all()) names.push_back(one.word);
  if (words.empty()) throw InputError(fmt::format("{}: expected one of {}{}", name_, fmt::join(names, ", "), help));
  const std::string& typed = words.front();
  const Words rest(words.begin() + 1, words.end());
  if (typed == kComplete) return complete(rest);
  if (typed == "--help" || typed == "-h") {
    print_help();
    return kDone;
  }
  if (typed == "--version") {
    fmt::print("flexarm {}\n", FLEXARM_VERSION);
    return kDone;
  }
  for (const Named& one : commands_)
    if (one.name == typed) return one.command.run(rest);
  for (const Program& one : programs_)
    if (one.name == typed) return one.run(rest);
  names.insert(names.end(), {"--help", "--version"});
  const char* kind = typed.rfind('-', 0) == 0 ? "option" : "subcommand";
  throw InputError(fmt::format("{}: there is no {} '{}'{}{}", name_, kind, typed, suggestion(typed, names), help));
}

int CommandLine::complete(const Words& words) const {
  std::vector<Completion> found;
  if (words.size() < 2) {
    found = all();
    found.push_back({"--help", "prints all subcommands"});
    found.push_back({"--version", "prints the version"});
    found = completions_of(words.empty() ? "" : words.front(), found);
  } else {
    const Words rest(words.begin() + 1, words.end());
    for (const Named& one : commands_)
      if (one.name == words.front()) found = one.command.complete(rest);
    for (const Program& one : programs_)
      if (one.name == words.front() && one.kind == Kind::LikeThis) {
        Words asked = {kComplete};
        asked.insert(asked.end(), rest.begin(), rest.end());
        return one.run(asked);
      }
  }
  for (const Completion& one : found) fmt::print("{}\t{}\n", one.word, one.help);
  return kDone;
}

// ---------------------------------------------------------------- beginning and end

namespace {

template <class Run>
int printing_errors(const Run& run) {
  try {
    return run();
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  } catch (const Interrupted& error) {
    fmt::print(stderr, "flexarm: {}\n", error.what());
    return kInterrupted + interruption();
  } catch (const ModelError& error) {
    fmt::print(stderr, "flexarm: {}\n", error.what());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "flexarm: not enough memory for this scene\n");
    return kFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "flexarm: {}\n", error.what());
    return kFailed;
  }
}

/// Keeps freed memory in the process for the next simulation: to get fresh memory from the system takes longer than to
/// build a large model.
void keep_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
}

}  // namespace

int CommandLine::run(int argc, char** argv) const {
  keep_memory();
  ignore_signals_of_output();
  const int result = printing_errors([&] { return dispatch(Words(argv + 1, argv + argc)); });
  if (std::fflush(stdout) == 0) return result;
  std::perror("flexarm: cannot write the output");
  return kFailed;
}

}  // namespace flexarm::cli
