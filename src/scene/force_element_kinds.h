#pragma once
/// The elements of a scene that act between points of links.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "flexarm/scene/force_element.h"

namespace flexarm::scene {

class XmlElement;

/// A kind of force element: the children of <robot> that it is read from, and how.
struct ForceElementKind {
  std::string tag;
  std::string attribute;  ///< without which a child of that tag is something else; empty: all are
  std::function<std::shared_ptr<const ForceElementDescription>(const XmlElement&)> read;
};

/// Those that every scene may have.
const std::vector<ForceElementKind>& force_element_kinds();

}  // namespace flexarm::scene
