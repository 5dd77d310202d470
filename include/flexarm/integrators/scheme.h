#pragma once
/// The time integration schemes as data.

#include <optional>
#include <string_view>
#include <vector>

#include "flexarm/elements/time_rule.h"

namespace flexarm {

/// A scheme by name: its rule for the elements, and what it claims to conserve.
struct Scheme : TimeRule {
  std::string_view name;
  bool conserves_energy, conserves_momenta;
  std::string_view description;
};

/// All schemes, the default first.
const std::vector<Scheme>& schemes();
/// By name; "auto" is the default. Empty if unknown.
std::optional<Scheme> find_scheme(std::string_view name);

}  // namespace flexarm
