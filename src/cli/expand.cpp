#include <memory>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/files.h"
#include "cli/scene_input.h"

namespace flexarm::cli {
namespace {

struct ExpandArguments {
  SceneInput scene;
  std::string output = "-";
};

int expand(const ExpandArguments& arguments) {
  refuse_overwriting("--output", arguments.output, arguments.scene.path);
  require_writable("--output", arguments.output);
  const std::string text = read_scene(arguments.scene).urdf;
  if (is_standard_output(arguments.output))
    fmt::print("{}", text);
  else
    write_file(arguments.output, text);
  return kDone;
}

}  // namespace

void add_expand(CommandLine& line) {
  const auto arguments = std::make_shared<ExpandArguments>();
  Command& command =
      line.command("expand", "Replaces a scene's expressions by numbers, for programs that do not support expressions");
  add_scene(command, arguments->scene);
  command.option("--output", arguments->output, "output file; -: standard output").shown_as("FILE").shows_default();
  command.runs([arguments] { return expand(*arguments); });
}

}  // namespace flexarm::cli
