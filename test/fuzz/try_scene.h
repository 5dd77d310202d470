#pragma once
/// Tries a text as a scene. Every text must lead to an error that says its place, to a run, or to a failure with a
/// reason.

#include <limits>
#include <string>

namespace flexarm::fuzz {

struct Trial {
  enum class End { Refused, Ran, Failed };
  End end = End::Ran;
  std::string said;   ///< the first finding, or the reason of the failure
  std::string wrong;  ///< what is wrong; empty if nothing is
};

/// Limits for builds with sanitizers, in which large valid scenes and steps with many halvings take minutes.
struct Limits {
  /// Approximate limit for all beams; a scene with more is read but not run
  double elements = std::numeric_limits<double>::infinity();
  int halvings = std::numeric_limits<int>::max();  ///< upper limit, whatever the scene says
};

/// Reads a scene called `name`, builds its model and makes three steps.
Trial try_scene(const std::string& text, const std::string& name, const Limits& limits = {});

}  // namespace flexarm::fuzz
