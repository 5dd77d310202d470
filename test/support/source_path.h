#pragma once
/// Paths of files in the repository that tests read.

#include <string>

namespace flexarm::test {

/// Returns the absolute path of a file or folder, given relative to the root of the repository.
std::string source_path(const std::string& path);

}  // namespace flexarm::test
