#pragma once
/// Calls urdfdom, the URDF parser of ROS, and returns the errors that it logs.

#include <optional>
#include <string>
#include <vector>

#include <tinyxml2.h>

#include "flexarm/scene/visual_description.h"

namespace flexarm::scene {

/// Lets urdfdom parse a URDF document, and returns the errors that it logs, in order. The document must be UTF-8 with
/// moderate nesting, without character references like `&#37;`. Calls from several threads are serialised by a mutex,
/// since urdfdom logs through a global handler.
std::vector<std::string> errors_of_urdfdom(std::string document);

/// Returns the first error if urdfdom makes no model from the document. Returns nothing if it makes one, even if it
/// logs errors.
std::optional<std::string> refusal_of_urdfdom(std::string document);

/// Reads the shape of a <visual> or <collision> of a link, with its colour. The element must be one without errors of
/// urdfdom. Returns nothing if the shape has no extent; the sphere of a <collision> may be a point.
std::optional<VisualDescription> shape_of_urdfdom(const tinyxml2::XMLElement& element);

/// Returns the element as XML text. Character references occur only where XML requires them.
std::string printed(const tinyxml2::XMLElement& element);

}  // namespace flexarm::scene
