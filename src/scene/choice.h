#pragma once
/// Attributes whose values are names of a fixed set.

#include <iterator>

#include "scene/xml_element.h"

namespace flexarm::scene {

template <class Value>
struct Choice {
  const char* name;
  Value value;
};

/// The row of a table with that `name` which the attribute gives; null where it is missing or unknown, which is
/// recorded.
template <class Table>
auto read_row(const XmlElement& element, const char* attribute, const Table& table) -> decltype(&*std::begin(table)) {
  const std::optional<std::string> name = element.text(attribute);
  if (!name) return nullptr;
  std::string known;
  for (const auto& row : table) {
    if (*name == row.name) return &row;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  element.attribute_error(attribute, std::string(attribute) + " must be one of " + known);
  return nullptr;
}

/// What the attribute names among `choices`; nothing where it is missing or unknown, which is recorded.
template <class Value, std::size_t Count>
std::optional<Value> read_choice(const XmlElement& element, const char* attribute,
                                 const Choice<Value> (&choices)[Count]) {
  const Choice<Value>* choice = read_row(element, attribute, choices);
  return choice ? std::optional<Value>(choice->value) : std::nullopt;
}

/// The same for an attribute that may be left out.
template <class Value, std::size_t Count>
Value read_choice(const XmlElement& element, const char* attribute, const Choice<Value> (&choices)[Count],
                  Value fallback) {
  return element.has(attribute) ? read_choice(element, attribute, choices).value_or(fallback) : fallback;
}

}  // namespace flexarm::scene
