#pragma once
/// One lane of a pack or of a matrix of packs; a double has one lane.

#include "math/pack.h"

namespace flexarm {

inline void set_lane(double& to, int, double value) {
  to = value;
}
inline void set_lane(Pack& to, int lane, double value) {
  to.set(lane, value);
}
inline double get_lane(const double& from, int) {
  return from;
}
inline double get_lane(const Pack& from, int lane) {
  return from[lane];
}

template <class To, class From>
void set_lane(Eigen::MatrixBase<To>& to, int lane, const Eigen::MatrixBase<From>& value) {
  for (Eigen::Index j = 0; j < to.cols(); ++j)
    for (Eigen::Index i = 0; i < to.rows(); ++i) set_lane(to.derived().coeffRef(i, j), lane, value.derived()(i, j));
}
template <class From>
auto get_lane(const Eigen::MatrixBase<From>& from, int lane) {
  Eigen::Matrix<double, From::RowsAtCompileTime, From::ColsAtCompileTime> value;
  for (Eigen::Index j = 0; j < from.cols(); ++j)
    for (Eigen::Index i = 0; i < from.rows(); ++i) value(i, j) = get_lane(from.derived().coeff(i, j), lane);
  return value;
}

/// targets[lane][i] += values[i][lane] for the first `lanes` lanes, Count consecutive numbers each: a transposition.
/// `set`: = in the place of +=.
template <int Count, bool set = false>
[[gnu::always_inline]] inline void add_lanes(const Pack* values, int lanes, double* const* targets) {
  // A typedef: clang does not heed the alignment of an alias by `using`.
  typedef double Unaligned __attribute__((vector_size(sizeof(Pack::Vector)), aligned(alignof(double)), may_alias));
  constexpr int whole = Count / Pack::kLanes * Pack::kLanes;
  for (int i = 0; i < whole; i += Pack::kLanes) {
    const Pack::Vector &a = values[i].values(), &b = values[i + 1].values(), &c = values[i + 2].values(),
                       &d = values[i + 3].values();
    const Pack::Vector ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                       ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7),
                       cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                       cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    const Pack::Vector rows[Pack::kLanes] = {
        __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5), __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5),
        __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7), __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7)};
    for (int lane = 0; lane < lanes; ++lane) {
      Unaligned* target = reinterpret_cast<Unaligned*>(targets[lane] + i);
      *target = set ? rows[lane] : *target + rows[lane];
    }
  }
  for (int lane = 0; lane < lanes; ++lane)
    for (int i = whole; i < Count; ++i) targets[lane][i] = values[i][lane] + (set ? 0.0 : targets[lane][i]);
}

}  // namespace flexarm
