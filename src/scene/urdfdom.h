#pragma once
/// Calls urdfdom without losing its complaints.

#include <optional>
#include <string>
#include <vector>

#include <tinyxml2.h>

#include "flexarm/scene/visual_description.h"

namespace flexarm::scene {

/// Has urdfdom parse a URDF document of moderate nesting in UTF-8, which must not hide characters behind references
/// like
/// `&#37;`: what it logs as errors, the cause before its consequences. Serialised: urdfdom logs through a global
/// handler.
std::vector<std::string> errors_of_urdfdom(std::string document);

/// The first of these errors, if urdfdom gives no model for the document; nothing if it does, whatever it logs.
std::optional<std::string> refusal_of_urdfdom(std::string document);

/// What a <visual> or <collision> of a link is, of which urdfdom has nothing to complain; nothing where its shape has
/// no extent.
std::optional<VisualDescription> shape_of_urdfdom(const tinyxml2::XMLElement& element);

/// The element as XML text, references only where a character could not stand for itself.
std::string printed(const tinyxml2::XMLElement& element);

}  // namespace flexarm::scene
