#pragma once
/// How far two changes, one after the other, agree: what is extrapolated for output has no overshoot and does not ring.

#include <algorithm>

#include <Eigen/Core>

namespace flexarm {

/// They differ by less than a third of their sum: one is at most twice the other.
template <class Change>
bool belong_to_smooth_motion(const Change& last, const Change& before) {
  return (last - before).norm() <= 1.0 / 3 * (last + before).norm();
}

/// Of the last change, as far as the one before has it, too; zero if they oppose each other.
template <class Change>
Change agreed_part(const Change& last, const Change& before) {
  const double agreement = last.dot(before);
  return agreement > 0 ? Change(std::min(agreement / last.squaredNorm(), 1.0) * last) : Change(Change::Zero());
}

}  // namespace flexarm
