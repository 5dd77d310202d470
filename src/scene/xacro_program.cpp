#include "scene/xacro_program.h"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

extern char** environ;

namespace flexarm::scene {
namespace {

constexpr const char* kXacroEnding = ".xacro";
/// Longest message of xacro [bytes]. Only the end of a longer one is kept, which says what is wrong.
constexpr std::size_t kLongestComplaint = 2000;

/// A file in memory. A child process writes it, and this process reads it after the child has ended. Unlike with a
/// pipe, neither waits for the other.
class Output {
 public:
  Output() : descriptor_(memfd_create("xacro", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw std::runtime_error(std::strerror(errno));
  }
  ~Output() { close(descriptor_); }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  int descriptor() const { return descriptor_; }
  std::string text() const {
    std::string text;
    std::array<char, 1 << 14> part;
    for (ssize_t count; (count = pread(descriptor_, part.data(), part.size(), static_cast<off_t>(text.size()))) > 0;)
      text.append(part.data(), static_cast<std::size_t>(count));
    return text;
  }

 private:
  int descriptor_;
};

struct Run {
  bool is_found = true;  ///< the program xacro exists
  int status = 0;        ///< from waitpid()
  std::string output, complaints;
};

Run run_xacro(std::vector<std::string> words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const Output output, complaints;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, output.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, complaints.descriptor(), STDERR_FILENO);
  Run run;
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  run.is_found = error != ENOENT;
  if (run.is_found && error != 0) throw std::runtime_error(std::strerror(error));
  if (!run.is_found) return run;
  while (waitpid(child, &run.status, 0) < 0)
    if (errno != EINTR) throw std::runtime_error(std::strerror(errno));
  run.output = output.text();
  run.complaints = complaints.text();
  return run;
}

/// Joins the lines of a message by "; ", and shortens it from its beginning.
std::string as_line(std::string text) {
  if (text.size() > kLongestComplaint) text = "..." + text.substr(text.size() - kLongestComplaint);
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) out += (out.empty() ? "" : "; ") + line;
  return out;
}

std::string end_of(const Run& run) {
  return WIFEXITED(run.status) ? fmt::format("ended with status {}", WEXITSTATUS(run.status))
                               : fmt::format("was ended by signal {}", WTERMSIG(run.status));
}

/// Turns NAME=VALUE into xacro's NAME:=VALUE. Launch files need the first form, since the value of one of their own
/// arguments cannot contain ":=".
std::string as_xacro_has_it(std::string word) {
  const std::size_t equals = word.find('=');
  if (equals != std::string::npos && (equals == 0 || word[equals - 1] != ':')) word.insert(equals, ":");
  return word;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

bool expand_by_xacro(const std::string& path, const std::string& arguments, std::string& text, Findings& findings) {
  if (!ends_with(path, kXacroEnding)) {
    if (!arguments.empty())
      findings.error(0, "", fmt::format("takes no arguments of xacro, as its name does not end with {}", kXacroEnding),
                     quoted(arguments));
    return false;
  }
  std::vector<std::string> words = {"xacro", path};
  std::istringstream given(arguments);
  for (std::string word; given >> word;) words.push_back(as_xacro_has_it(word));
  try {
    const Run run = run_xacro(words);
    if (!run.is_found) return false;
    if (run.status != 0)
      findings.error(0, "", fmt::format("xacro {}: {}", end_of(run), as_line(run.complaints)));
    else if (!run.complaints.empty())
      findings.warning(0, "", "xacro says: " + as_line(run.complaints));
    text = run.output;
    return run.status == 0;
  } catch (const std::runtime_error& error) {
    findings.error(0, "", fmt::format("xacro cannot be run: {}", error.what()));
    return false;
  }
}

}  // namespace flexarm::scene
