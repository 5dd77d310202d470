#pragma once
/// What every text must lead to: an error that says where it is, a run, or a failure that says why.

#include <limits>
#include <string>

namespace flexarm::fuzz {

struct Trial {
  enum class End { Refused, Ran, Failed };
  End end = End::Ran;
  std::string said;   ///< the first finding, or the reason of the failure
  std::string wrong;  ///< what must not be; empty: nothing
};

/// Reads a scene called `name`, builds its model and takes three steps. A scene whose beams have more than about
/// `most_elements` is only read: with sanitizers large ones, which are good, take minutes.
Trial try_scene(const std::string& text, const std::string& name,
                double most_elements = std::numeric_limits<double>::infinity());

}  // namespace flexarm::fuzz
