#pragma once
/// Commands that are programs of the Python package beside this one.

#include <string>
#include <vector>

namespace flexarm::cli {

/// This process becomes Python, which runs `program` ("-m", "flexarm.sweep") with the arguments of `command`, options
/// included. @throws std::runtime_error if there is no package, or no Python.
[[noreturn]] void become_python(const std::string& command, const std::vector<std::string>& program,
                                const std::vector<std::string>& arguments);

}  // namespace flexarm::cli
