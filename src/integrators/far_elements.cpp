#include "integrators/far_elements.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {

FarElements::Travel FarElements::travel(const std::vector<NodePose>& from, const std::vector<NodePose>& to) {
  double way = 0, chord = 0;  // squared
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto &begin = from[i].orientation.coeffs(), &end = to[i].orientation.coeffs();
    way = std::max(way, (to[i].position - from[i].position).squaredNorm());
    chord = std::max(chord, std::min((end - begin).squaredNorm(), (end + begin).squaredNorm()));
  }
  constexpr double kTurnPerChord = 2.3;  // rotation angle per distance of unit quaternions: from 2 to pi / sqrt(2)
  return {std::sqrt(way), kTurnPerChord * std::sqrt(chord)};
}

void FarElements::begin(const ForceStart& start) {
  if (!last_.empty()) {
    const Travel moved = travel(last_, start.poses);
    travelled_.way += moved.way;
    travelled_.turn += moved.turn;
  }
  last_ = start.poses;
  ahead_ = {};
  if (start.duration == 0) ahead_.way = std::numeric_limits<double>::infinity();  // in statics nodes may move anywhere
  constexpr double kMore = 2;
  const double duration = kMore * std::abs(start.duration);
  for (const Vector6& velocity : start.velocities) {
    ahead_.way = std::max(ahead_.way, duration * velocity.head<3>().norm());
    ahead_.turn = std::max(ahead_.turn, duration * velocity.tail<3>().norm());
  }
}

}  // namespace flexarm
