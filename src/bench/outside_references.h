#pragma once
/// Motions of scenes that are not flexarm's, as scripts/outside_references writes them.

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
  double disagreement = 0;  ///< of two runs of the reference, relative to how far its points come
  scene::SceneDescription scene;
  bool is_there = true;  ///< else finer runs have to judge, and there is no motion
  JudgedMotion motion;
};

/// A reference whose two runs differ by more than this part of its way judges nothing.
constexpr double kLargestDisagreement = 1e-9;

/// What `index.csv` of the folder lists, in its order; `only`: those with this in "GROUP: NAME".
/// @throws std::runtime_error naming file and line for a table that cannot be read, times that are not equally spaced
/// from 0 to the end, numbers that are not finite, runs that disagree, and points that do not start where those of the
/// scene do.
std::vector<OutsideReference> read_outside_references(const std::string& folder, const std::string& only = {});

}  // namespace flexarm::bench
