#pragma once
/// What lies beside the program, where it is installed and in the source tree that it was built from.

#include <optional>
#include <string>
#include <vector>

namespace flexarm::cli {

/// The scenes that come with flexarm, or a folder of them; empty: they are not installed.
std::optional<std::string> own_scenes(const std::string& folder = {});

/// The folder of the Python package; empty: it is not installed.
std::optional<std::string> python_folder();

/// A program that comes with flexarm, beside this one; empty: it is not installed.
std::optional<std::string> own_program(const std::string& name);

/// A script that comes with flexarm; empty: it is not installed.
std::optional<std::string> own_script(const std::string& name);

/// Runs a script that comes with flexarm by Python; false if it is not there, or fails.
bool run_script(const std::string& script, const std::vector<std::string>& arguments);

/// Runs a script that draws `picture` of the file `data`; false if this machine cannot.
bool draw(const std::string& script, const std::string& data, const std::string& picture);

}  // namespace flexarm::cli
