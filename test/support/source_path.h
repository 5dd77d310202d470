#pragma once
/// Files of the repository that tests read.

#include <string>

namespace flexarm::test {

/// The absolute path of a file or folder, given from the repository's root.
std::string source_path(const std::string& path);

}  // namespace flexarm::test
