#pragma once
/// Attributes whose values are names of a fixed set.

#include "scene/xml_element.h"

namespace flexarm::scene {

template <class Value>
struct Choice {
  const char* name;
  Value value;
};

/// What the attribute names among `choices`; nothing where it is missing or unknown, which is recorded.
template <class Value, std::size_t Count>
std::optional<Value> read_choice(const XmlElement& element, const char* attribute,
                                 const Choice<Value> (&choices)[Count]) {
  const std::optional<std::string> name = element.text(attribute);
  if (!name) return std::nullopt;
  std::string known;
  for (const Choice<Value>& choice : choices) {
    if (*name == choice.name) return choice.value;
    known += (known.empty() ? "" : ", ") + std::string(choice.name);
  }
  element.attribute_error(attribute, std::string(attribute) + " must be one of " + known);
  return std::nullopt;
}

/// The same for an attribute that may be left out.
template <class Value, std::size_t Count>
Value read_choice(const XmlElement& element, const char* attribute, const Choice<Value> (&choices)[Count],
                  Value fallback) {
  return element.has(attribute) ? read_choice(element, attribute, choices).value_or(fallback) : fallback;
}

}  // namespace flexarm::scene
