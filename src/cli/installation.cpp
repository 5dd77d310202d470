#include "cli/installation.h"

#include <cstdlib>
#include <filesystem>
#include <vector>

namespace flexarm::cli {
namespace {

namespace fs = std::filesystem;

fs::path program_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

/// The share folder of an installation, in which this program is <prefix>/lib/flexarm/flexarm.
fs::path share() {
  return program_folder().parent_path().parent_path() / "share/flexarm";
}

/// The first of the places that exists.
std::optional<std::string> first_of(const std::vector<fs::path>& places) {
  std::error_code error;
  for (const fs::path& place : places)
    if (fs::exists(place, error)) return place.string();
  return std::nullopt;
}

}  // namespace

std::string as_shell_word(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::optional<std::string> own_scenes(const std::string& folder) {
  return first_of({share() / "config" / folder, fs::path(FLEXARM_SOURCE_DIR) / "config" / folder});
}

std::optional<std::string> python_folder() {
  const fs::path folder = program_folder().parent_path() / "python3/dist-packages";
  return first_of({folder / "flexarm"}) ? std::optional<std::string>(folder.string()) : std::nullopt;
}

std::optional<std::string> own_program(const std::string& name) {
  return first_of({program_folder() / name});
}

std::optional<std::string> own_script(const std::string& name) {
  return first_of({share() / "scripts" / name, fs::path(FLEXARM_SOURCE_DIR) / "scripts" / name});
}

bool run_script(const std::string& script, const std::vector<std::string>& arguments) {
  const std::optional<std::string> path = own_script(script);
  if (!path) return false;
  std::string command = "/usr/bin/python3 " + as_shell_word(*path);
  for (const std::string& argument : arguments) command += " " + as_shell_word(argument);
  return std::system(command.c_str()) == 0;
}

bool open_in_browser(const std::string& path) {
  return std::system(("xdg-open " + as_shell_word(path) + " >/dev/null 2>&1").c_str()) == 0;
}

bool draw(const std::string& script, const std::string& data, const std::string& picture) {
  return run_script(script, {data, picture});
}

}  // namespace flexarm::cli
