#pragma once
/// From bytes to an XML tree that is safe to walk.

#include <string>

#include <tinyxml2.h>

#include "scene/findings.h"

namespace flexarm::scene {

/// Parses `text`. On any error (not UTF-8, document type declaration, malformed, nested too deeply) records it and
/// returns false; `document` is then not to be used.
bool parse_xml(const std::string& text, tinyxml2::XMLDocument& document, Findings& findings);

}  // namespace flexarm::scene
