#pragma once
/// Parses XML text, and checks that the tree of elements is safe to walk.

#include <string>

#include <tinyxml2.h>

#include "scene/findings.h"

namespace flexarm::scene {

/// Parses `text`. If there is an error (not UTF-8, a document type declaration, too many attributes, malformed, nested
/// too deeply), records it and returns false. The document must not be used then.
bool parse_xml(const std::string& text, tinyxml2::XMLDocument& document, Findings& findings);

}  // namespace flexarm::scene
