#pragma once
/// Access to single lanes of packs and of matrices of packs. A double counts as one lane.

#include <array>
#include <cassert>
#include <cstring>

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

/// Returns four lanes by their indices: 0 to 3 are the lanes of `a`, 4 to 7 those of `b`.
template <int i, int j, int k, int l>
[[gnu::always_inline]] inline Pack shuffled(const Pack::Vector& a, const Pack::Vector& b) {
#if defined(__clang__) || __GNUC__ >= 12
  return Pack(__builtin_shufflevector(a, b, i, j, k, l));
#else
  return Pack(__builtin_shuffle(a, b, Pack::Mask{i, j, k, l}));
#endif
}

/// Transposes four vectors: result k is {a[k], b[k], c[k], d[k]}.
[[gnu::always_inline]] inline std::array<Pack::Vector, 4> transposed(const Pack::Vector& a, const Pack::Vector& b,
                                                                     const Pack::Vector& c, const Pack::Vector& d) {
  const Pack ab_even = shuffled<0, 4, 2, 6>(a, b), ab_odd = shuffled<1, 5, 3, 7>(a, b),
             cd_even = shuffled<0, 4, 2, 6>(c, d), cd_odd = shuffled<1, 5, 3, 7>(c, d);
  return {shuffled<0, 1, 4, 5>(ab_even.values(), cd_even.values()).values(),
          shuffled<0, 1, 4, 5>(ab_odd.values(), cd_odd.values()).values(),
          shuffled<2, 3, 6, 7>(ab_even.values(), cd_even.values()).values(),
          shuffled<2, 3, 6, 7>(ab_odd.values(), cd_odd.values()).values()};
}

// A typedef, since clang ignores the alignment in an alias by `using`.
typedef double UnalignedLanes __attribute__((vector_size(sizeof(Pack::Vector)), aligned(alignof(double)), may_alias));

/// Does targets[lane][i] += values[i][lane] for the first `lanes` lanes, with Count consecutive numbers each. With
/// `set`, assigns and does not add.
template <int Count, bool set = false>
[[gnu::always_inline]] inline void add_lanes(const Pack* values, int lanes, double* const* targets) {
  assert(lanes >= 0 && lanes <= Pack::kLanes);
  constexpr int whole = Count / Pack::kLanes * Pack::kLanes;
  const auto add = [&](int lane, int i, const Pack::Vector& row) {
    UnalignedLanes* target = reinterpret_cast<UnalignedLanes*>(targets[lane] + i);
    *target = set ? row : *target + row;
  };
  for (int i = 0; i < whole; i += Pack::kLanes) {
    const std::array<Pack::Vector, 4> rows =
        transposed(values[i].values(), values[i + 1].values(), values[i + 2].values(), values[i + 3].values());
    add(0, i, rows[0]);
    if (lanes > 1) add(1, i, rows[1]);
    if (lanes > 2) add(2, i, rows[2]);
    if (lanes > 3) add(3, i, rows[3]);
  }
  for (int lane = 0; lane < lanes; ++lane)
    for (int i = whole; i < Count; ++i) targets[lane][i] = values[i][lane] + (set ? 0.0 : targets[lane][i]);
}

/// Does values[i][lane] = sources[lane][i] for all lanes, with Count consecutive numbers each.
template <int Count>
[[gnu::always_inline]] inline void load_lanes(const double* const* sources, Pack* values) {
  constexpr int whole = Count / Pack::kLanes * Pack::kLanes;
  for (int i = 0; i < whole; i += Pack::kLanes) {
    Pack::Vector of_lane[Pack::kLanes];
    for (int lane = 0; lane < Pack::kLanes; ++lane) std::memcpy(&of_lane[lane], sources[lane] + i, sizeof(of_lane[0]));
    const std::array<Pack::Vector, 4> rows = transposed(of_lane[0], of_lane[1], of_lane[2], of_lane[3]);
    for (int k = 0; k < Pack::kLanes; ++k) values[i + k] = Pack(rows[k]);
  }
  for (int i = whole; i < Count; ++i) values[i] = Pack(sources[0][i], sources[1][i], sources[2][i], sources[3][i]);
}

}  // namespace flexarm
