#pragma once
/// Files that xacro makes into URDF.

#include <string>

#include "scene/findings.h"

namespace flexarm::scene {

/// Replaces the text of a file *.xacro by what the program xacro makes of it, with arguments NAME=VALUE, or NAME:=VALUE
/// as xacro has them, that have spaces between them. Where there is no such program the text stays, and is refused as
/// raw xacro if it is. Records what xacro complains of, and arguments for another file.
/// @returns whether the text is xacro's
bool expand_by_xacro(const std::string& path, const std::string& arguments, std::string& text, Findings& findings);

}  // namespace flexarm::scene
