#pragma once
/// Runs the program xacro on scene files whose names end with ".xacro".

#include <string>

#include "scene/findings.h"

namespace flexarm::scene {

/// Replaces the text of a file *.xacro by the output of the program xacro. `arguments`: NAME=VALUE or NAME:=VALUE,
/// separated by spaces. If xacro is not installed, the text stays as it is, and refuse_xacro() refuses it later.
/// Records the errors and warnings of xacro, and an error if there are arguments for a file with another ending.
/// @returns whether `text` is the output of xacro
bool expand_by_xacro(const std::string& path, const std::string& arguments, std::string& text, Findings& findings);

}  // namespace flexarm::scene
