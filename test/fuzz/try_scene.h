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

/// With sanitizers large scenes, which are good, take minutes, and so do steps that are halved often.
struct Limits {
  double elements = std::numeric_limits<double>::infinity();  ///< of all beams, about; a scene with more is only read
  int halvings = std::numeric_limits<int>::max();             ///< at most, whatever the scene says
};

/// Reads a scene called `name`, builds its model and takes three steps.
Trial try_scene(const std::string& text, const std::string& name, const Limits& limits = {});

}  // namespace flexarm::fuzz
