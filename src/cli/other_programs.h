#pragma once
/// Parts of flexarm that are programs in Python.

#include <string>
#include <vector>

namespace flexarm::cli {

/// Replaces this process by Python, which runs a script of flexarm with the arguments of `command`. Python imports
/// modules from the script's folder, not from the working folder.
/// @throws std::runtime_error if the script is not installed
[[noreturn]] void become_python(const std::string& command, const std::string& script,
                                const std::vector<std::string>& arguments);

}  // namespace flexarm::cli
