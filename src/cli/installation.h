#pragma once
/// Finds flexarm's own files, both when it is installed and in the source tree.

#include <optional>
#include <string>
#include <vector>

namespace flexarm::cli {

/// The folder of flexarm's example scenes, or a folder in it; empty: not installed.
std::optional<std::string> own_scenes(const std::string& folder = {});

/// The folder of the Python package; empty: not installed.
std::optional<std::string> python_folder();

/// The path of another program of flexarm; empty: not installed.
std::optional<std::string> own_program(const std::string& name);

/// The path of a script of flexarm; empty: not installed.
std::optional<std::string> own_script(const std::string& name);

/// A text in quotes, so that a shell takes it as one word.
std::string as_shell_word(const std::string& text);

/// Runs a script of flexarm with Python. @returns false if it does not exist or fails
bool run_script(const std::string& script, const std::vector<std::string>& arguments);

/// Opens a file in the user's browser, without waiting for it. @returns false if none can be started
bool open_in_browser(const std::string& path);

/// Runs a script that plots the file `data` to `picture`. @returns false if this fails on this machine
bool draw(const std::string& script, const std::string& data, const std::string& picture);

}  // namespace flexarm::cli
