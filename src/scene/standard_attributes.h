#pragma once
/// What the readers of <link> and <joint> share: numbers of URDF's own children, and urdfdom's opinion of elements.

#include <optional>
#include <string>

#include "scene/xml_element.h"

namespace flexarm::scene {

/// `count` numbers in an attribute of a child element.
struct StandardAttribute {
  const char* child;
  const char* attribute;
  std::size_t count;
  bool required;  // if the child exists
  NumberRange range;
};

template <std::size_t Count>
void check_attributes(const XmlElement& element, const StandardAttribute (&table)[Count]) {
  for (const StandardAttribute& row : table) {
    const std::optional<XmlElement> child = element.child(row.child);
    if (child && (row.required || child->has(row.attribute))) child->numbers(row.attribute, row.count, row.range);
  }
}

/// Lets urdfdom read a document whose <robot> has only these elements. If urdfdom reports an error, records a warning,
/// since flexarm itself can read the element.
/// @returns whether urdfdom reports no error
bool judge_alone(const XmlElement& element, const std::string& elements);

/// Returns the pose in <origin>; the identity if that is missing.
Pose read_origin(const XmlElement& element);

/// Returns a number that check_attributes() has checked; 0 if the attribute or the child is missing.
double checked_number(const XmlElement& element, const char* child, const char* attribute);

}  // namespace flexarm::scene
