#include "cli/files.h"

#include <filesystem>

#include "cli/commands.h"

namespace flexarm::cli {
namespace {

namespace fs = std::filesystem;

/// By the file where both are there, else by its name.
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

}  // namespace flexarm::cli
