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

/// Reads what elements between two points have in common: their name, and the links and points of their ends.
void read_ends(const XmlElement& element, BetweenTwoPoints& out);

/// Returns the kinds that every scene may have.
const std::vector<ForceElementKind>& force_element_kinds();

}  // namespace flexarm::scene
