#include <memory>

#include <fmt/format.h>

#include "cli/commands.h"

namespace flexarm::cli {
namespace {

// Both scripts ask the program for completions. If it offers none, they complete file names.
constexpr const char* kBash = R"(_flexarm() {
  local line
  COMPREPLY=()
  while IFS= read -r line; do
    COMPREPLY+=("${line%%$'\t'*}")
  done < <("$1" --complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -o bashdefault -o default -F _flexarm flexarm
)";

constexpr const char* kZsh = R"(#compdef flexarm
_flexarm() {
  eval "$_comp_setup"  # whatever options who sourced this had
  local -a lines
  lines=("${(@f)$("${words[1]}" --complete "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  lines=(${${lines//:/\\:}/$'\t'/:})
  if (( $#lines )); then
    _describe flexarm lines
  else
    _files
  fi
}
if [[ ${funcstack[1]-} == _flexarm ]]; then
  _flexarm "$@"
elif (( $+functions[compdef] )); then
  compdef _flexarm flexarm
fi
)";

}  // namespace

void add_completion(CommandLine& line) {
  const auto shell = std::make_shared<std::string>();
  Command& command = line.command(
      "completion",
      "Prints a script with which a shell completes commands and options: eval \"$(flexarm completion bash)\"");
  command.argument("shell", *shell, "bash or zsh").choices({"bash", "zsh"});
  command.runs([shell] {
    fmt::print("{}", *shell == "zsh" ? kZsh : kBash);
    return kDone;
  });
}

}  // namespace flexarm::cli
