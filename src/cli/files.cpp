#include "cli/files.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include "cli/exit_status.h"
#include "simulation/unfinished_file.h"

namespace flexarm::cli {
namespace {

namespace fs = std::filesystem;

/// Compares the files if both exist, else their names.
bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const fs::path canonical = fs::weakly_canonical(a, error);
  return !error && canonical == fs::weakly_canonical(b, error);
}

}  // namespace

void refuse_overwriting(const std::string& option, const std::string& output, const std::string& input) {
  if (!output.empty() && !input.empty() && is_same_file(output, input))
    throw InputError("flexarm: " + option + " would overwrite '" + input + "'");
}

void require_writable(const std::string& option, const std::string& output) {
  if (output.empty() || is_standard_output(output)) return;
  const bool is_new = !fs::exists(fs::symlink_status(output));
  const bool is_good = std::ofstream(output, std::ios::app).is_open();
  const int reason = errno;
  if (!is_good)
    throw InputError(fmt::format("flexarm: {}: cannot write '{}': {}", option, output, std::strerror(reason)));
  if (is_new) fs::remove(output);
}

void write_file(const std::string& path, const std::string& text) {
  try {
    UnfinishedFile(path, text).put_in_place();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("'" + path + "' " + error.what());
  }
}

}  // namespace flexarm::cli
