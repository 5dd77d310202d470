#pragma once
/// Files that commands write.

#include <string>

namespace flexarm::cli {

/// @throws InputError if `output`, which is that of an option, is the file `input`. An empty path is no file.
void refuse_overwriting(const std::string& option, const std::string& output, const std::string& input);

/// For what is written later: tries to open it now, and leaves all as it is.
/// @throws InputError if `output`, which is that of an option, cannot be written. "-" is the standard output.
void require_writable(const std::string& option, const std::string& output);

/// Writes a file whole, or what was there before stays.
/// @throws std::runtime_error
void write_file(const std::string& path, const std::string& text);

/// Whether results go there, so that other text must not.
inline bool is_standard_output(const std::string& path) {
  return path == "-";
}

}  // namespace flexarm::cli
