#pragma once
/// Calls urdfdom without losing its complaints.

#include <string>
#include <vector>

#include <tinyxml2.h>
#include <urdf_model/model.h>
#include <urdf_world/types.h>

namespace flexarm::scene {

struct UrdfdomResult {
  urdf::ModelInterfaceSharedPtr model;  ///< may be null, and incomplete wherever there are errors
  std::vector<std::string> errors;      ///< what urdfdom logged as errors, the cause before its consequences
};

/// Parses a URDF document of moderate nesting in UTF-8. Serialised: urdfdom logs through a global handler.
UrdfdomResult parse_with_urdfdom(const std::string& document);

/// The element as XML text.
std::string printed(const tinyxml2::XMLElement& element);

}  // namespace flexarm::scene
