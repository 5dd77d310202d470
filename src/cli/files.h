#pragma once
/// Checks and writes output files.

#include <string>

namespace flexarm::cli {

/// @throws InputError if `output`, the value of `option`, is the same file as `input`. An empty path is no file.
void refuse_overwriting(const std::string& option, const std::string& output, const std::string& input);

/// Checks early that a file can be written later, without changing it.
/// @throws InputError if `output`, the value of `option`, cannot be written. "-" is standard output.
void require_writable(const std::string& option, const std::string& output);

/// Writes a whole file; if that fails, an existing file stays as it was.
/// @throws std::runtime_error
void write_file(const std::string& path, const std::string& text);

/// Whether results go to standard output, so that no other text may go there.
inline bool is_standard_output(const std::string& path) {
  return path == "-";
}

}  // namespace flexarm::cli
