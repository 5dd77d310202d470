#pragma once
/// Reads reference motions that do not come from flexarm, as scripts/outside_references writes them.

#include <string>
#include <vector>

#include "flexarm/accuracy/trajectory.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::bench {

struct OutsideReference {
  std::string group, name;
  bool is_cornered = true;
  double until = 0;         ///< [s]
  int intervals = 0;        ///< of equal length, between the times of `motion`
  double disagreement = 0;  ///< difference between two runs of the reference, relative to the largest displacement
  scene::SceneDescription scene;
  bool is_there = true;  ///< whether `motion` exists; if not, finer runs are the reference
  JudgedMotion motion;
};

/// A reference whose two runs differ by more (relative to the largest displacement) is not used.
constexpr double kLargestDisagreement = 1e-9;

/// Reads all references that the folder's `index.csv` lists. `only`: those with this text in "GROUP: NAME".
/// @throws std::runtime_error with file and line if a table cannot be read, times are not equally spaced from 0 to the
///   end, numbers are not finite, runs disagree, or the points' initial positions are not those of the scene
std::vector<OutsideReference> read_outside_references(const std::string& folder, const std::string& only = {});

}  // namespace flexarm::bench
