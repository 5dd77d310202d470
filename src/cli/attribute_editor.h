#pragma once
/// Changes attributes in the text of a scene file, and leaves every other byte as it is.

#include <optional>
#include <string>
#include <vector>

namespace flexarm::cli {

/// A start tag in a text.
struct TagPlace {
  std::string name;                ///< "beam"
  std::vector<std::string> above;  ///< names of the elements around it, the root first
  std::string link;                ///< `name` of the link around it; empty: none
  std::size_t begin = 0, end = 0;  ///< of "<beam ...>" in the text
  bool is_empty = false;           ///< "<beam .../>"
};

/// All start tags of a well-formed text, in its order; comments and the like have none.
std::vector<TagPlace> find_tags(const std::string& text);

/// Sets an attribute of the tag that begins at `begin`: a value where it is, or else as the tag's last attribute.
void set_attribute(std::string& text, std::size_t begin, const std::string& name, const std::string& value);
/// Takes an attribute away where there is one.
void remove_attribute(std::string& text, std::size_t begin, const std::string& name);

}  // namespace flexarm::cli
