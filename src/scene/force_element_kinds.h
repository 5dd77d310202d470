#pragma once
/// Lists the kinds of XML elements of a scene that describe forces between points of links.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "flexarm/scene/force_element.h"

namespace flexarm::scene {

class XmlElement;

/// A kind of force element: which children of <robot> describe it, and the function that reads them.
struct ForceElementKind {
  std::string tag;
  std::string attribute;  ///< a child with `tag` is of this kind only if it has this attribute; empty: always
  std::function<std::shared_ptr<const ForceElementDescription>(const XmlElement&)> read;
};

/// Returns the kinds that every scene may have.
const std::vector<ForceElementKind>& force_element_kinds();

}  // namespace flexarm::scene
