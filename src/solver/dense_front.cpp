#include "solver/dense_front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "math/simd.h"

namespace flexarm {
namespace {

/// A pivot that may wait is taken if it is so large beside its column: growth by its inverse leaves twelve digits.
constexpr double kThreshold = 1e-4;
/// A pivot below that, beside what its column was made of, is round-off.
constexpr double kRoundOff = 8 * std::numeric_limits<double>::epsilon();

/// target -= factor * source.
[[gnu::always_inline]] inline void subtract(double* target, double factor, const double* source, int first, int last) {
  const Lanes factors = broadcast(factor);
  for (int v = first; v < last; ++v) store(load(target + 4 * v) - factors * load(source + 4 * v), target + 4 * v);
}

[[gnu::always_inline]] inline Lanes absolute(const Lanes& value) {
  return value < 0 ? -value : value;
}

/// Largest absolute value.
[[gnu::always_inline]] inline double largest(const double* values, int lanes) {
  Lanes most = {};
  for (int v = 0; v < lanes; ++v) {
    const Lanes size = absolute(load(values + 4 * v));
    most = size > most ? size : most;
  }
  return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
}

}  // namespace

void DenseFront::reserve(int size) {
  const std::size_t lanes = lanes_for(size);
  for (std::vector<int>* labels : {&rows, &columns}) labels->reserve(size);
  for (std::vector<double>* numbers : {&scales_, &reciprocals_}) numbers->reserve(size);
  column_sizes_.reserve(lanes);
  for (FrontMemory* memory : {&values_, &lower_}) memory->reserve(lanes * size);
  right_.reserve(6 * lanes);
}

void DenseFront::clear() {
  for (const int scalar : rows) row_place_[scalar] = -1;
  for (const int scalar : columns) column_place_[scalar] = -1;
  rows.clear();
  columns.clear();
}

void DenseFront::start(int active) {
  active_ = active;
  const int lanes = lanes_for(size());
  stride_ = 4 * lanes;
  values_.assign(static_cast<std::size_t>(lanes) * size(), {});
  for (int i = 0; i < size(); ++i) {
    row_place_[rows[i]] = i;
    column_place_[columns[i]] = i;
  }
}

void DenseFront::add(int row, int column, const double* values, int row_count, int column_count, int distance) {
  const int first_row = row_place_[row], first_column = column_place_[column];
  for (int r = 0; r < row_count; ++r) {
    double* to = this->row(first_row + r) + first_column;
    for (int c = 0; c < column_count; ++c) to[c] += values[distance * c + r];
  }
}

void DenseFront::fold(int slave, int count, const double* left, const double* right, int distance, const int* targets,
                      int target_count) {
  const int place = column_place_[slave], slave_row = row_place_[slave], lanes = lanes_for(size());
  right_.assign(static_cast<std::size_t>(lanes) * count, {});  // by columns of the front
  double* columns_of = right_.data()->lane;
  for (int k = 0; k < count; ++k)
    for (int t = 0; t < target_count; ++t)
      columns_of[stride_ * k + column_place_[targets[t]]] = right[distance * k + t];
  simd::run([&] {
    for (int i = 0; i < size(); ++i) {
      double* values = row(i);
      for (int k = 0; k < count; ++k)
        if (values[place + k] != 0) subtract(values, -values[place + k], columns_of + stride_ * k, 0, lanes);
    }
    for (int t = 0; t < target_count; ++t) {
      double* values = row(row_place_[targets[t]]);
      for (int k = 0; k < count; ++k)
        if (left[distance * k + t] != 0) subtract(values, -left[distance * k + t], row(slave_row + k), 0, lanes);
    }
  });
}

void DenseFront::clear_row(int scalar) {
  std::fill_n(row(row_place_[scalar]), stride_, 0.0);
}

void DenseFront::swap_rows(int a, int b) {
  if (a == b) return;
  std::swap_ranges(row(a), row(a) + stride_, row(b));
  double* lower = lower_.data()->lane;
  for (int k = 0; k < pivots_; ++k) std::swap(lower[stride_ * k + a], lower[stride_ * k + b]);
  std::swap(scales_[a], scales_[b]);
  std::swap(rows[a], rows[b]);
}

void DenseFront::swap_columns(int a, int b) {
  if (a == b) return;
  for (int i = 0; i < active_; ++i) std::swap(row(i)[a], row(i)[b]);
  double* sizes = column_sizes_.data()->lane;
  std::swap(sizes[a], sizes[b]);
  std::swap(columns[a], columns[b]);
}

int DenseFront::eliminate(int candidates, int certain, bool all) {
  candidates_ = candidates;
  pivots_ = 0;
  lower_.assign(static_cast<std::size_t>(stride_ / 4) * candidates, {});
  scales_.resize(active_);
  column_sizes_.assign(lanes_for(candidates), {});
  reciprocals_.resize(candidates);
  bool done = false;
  simd::run([&] { done = scale() && take_pivots(certain, all); });
  return done ? pivots_ : -1;
}

bool DenseFront::scale() {
  const int lanes = lanes_for(active_), candidate_lanes = lanes_for(candidates_);
  double* sizes = column_sizes_.data()->lane;
  for (int i = 0; i < active_; ++i) {
    double* values = row(i);
    std::fill(values + active_, values + stride_, 0.0);  // what was folded
    const double size = largest(values, lanes);
    if (!std::isfinite(size)) return false;
    scales_[i] = size > 0 ? 1 / size : 0.0;
    const Lanes scale = broadcast(scales_[i]);
    for (int v = 0; v < candidate_lanes; ++v) {
      const Lanes old = load(sizes + 4 * v), own = scale * absolute(load(values + 4 * v));
      store(own > old ? own : old, sizes + 4 * v);
    }
  }
  return true;
}

bool DenseFront::take_pivots(int certain, bool all) {
  for (int k = 0; k < certain; ++k)
    if (!take_pivot(k, true)) return false;
  // A column that had no pivot may have one after others. Where all must go, the best come first.
  for (const bool must : {false, true}) {
    if (must && !all) break;
    for (int before = -1; before != pivots_ && pivots_ < candidates_;) {
      before = pivots_;
      for (int k = pivots_; k < candidates_; ++k) take_pivot(k, must);
    }
  }
  return !all || pivots_ == candidates_;
}

std::pair<double, int> DenseFront::largest_row(int column, int first, int last) {
  std::pair<double, int> best(0.0, first);
  for (int i = first; i < last; ++i) {
    const double size = scales_[i] * std::abs(row(i)[column]);
    if (size > best.first) best = {size, i};
  }
  return best;
}

bool DenseFront::take_pivot(int column, bool must) {
  const auto [size, pivot_row] = largest_row(column, pivots_, candidates_);
  if (!(size > kRoundOff * column_sizes_.data()->lane[column])) return false;
  if (!must && size < kThreshold * largest_row(column, candidates_, active_).first) return false;
  swap_rows(pivot_row, pivots_);
  swap_columns(column, pivots_);
  const double* pivot_values = row(pivots_);
  const double reciprocal = reciprocals_[pivots_] = 1 / pivot_values[pivots_];
  double* lower = lower_.data()->lane + static_cast<std::size_t>(stride_) * pivots_;
  for (int i = pivots_ + 1; i < active_; ++i) {
    double* values = row(i);
    const double multiplier = values[pivots_] * reciprocal;
    lower[i] = multiplier;
    if (multiplier != 0) subtract(values, multiplier, pivot_values, pivots_ / 4, lanes_for(active_));
  }
  ++pivots_;
  return true;
}

}  // namespace flexarm
