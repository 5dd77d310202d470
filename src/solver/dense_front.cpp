#include "solver/dense_front.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "math/simd.h"

namespace flexarm {
namespace {

/// A pivot that may be postponed is taken if it is at least this large relative to its column. The growth by its
/// inverse then leaves twelve correct digits.
constexpr double kThreshold = 1e-4;
/// A pivot below this, relative to the original size of its column, is round-off.
constexpr double kRoundOff = 8 * std::numeric_limits<double>::epsilon();

/// target -= factor * source.
[[gnu::always_inline]] inline void subtract(double* target, double factor, const double* source, int first, int last) {
  const Lanes factors = broadcast(factor);
  for (int v = first; v < last; ++v) store(load(target + 4 * v) - factors * load(source + 4 * v), target + 4 * v);
}

/// The same for four rows at once, so that the source is loaded only once.
[[gnu::always_inline]] inline void subtract_four(double* rows, int stride, const double* factors, const double* source,
                                                 int first, int last) {
  const Lanes f0 = broadcast(factors[0]), f1 = broadcast(factors[1]), f2 = broadcast(factors[2]),
              f3 = broadcast(factors[3]);
  double *r0 = rows, *r1 = r0 + stride, *r2 = r1 + stride, *r3 = r2 + stride;
  for (int v = 4 * first; v < 4 * last; v += 4) {
    const Lanes values = load(source + v);
    store(load(r0 + v) - f0 * values, r0 + v);
    store(load(r1 + v) - f1 * values, r1 + v);
    store(load(r2 + v) - f2 * values, r2 + v);
    store(load(r3 + v) - f3 * values, r3 + v);
  }
}

/// Subtracts `count` pivots at once from four rows of a border. The four rows and `Vectors` vectors of columns stay in
/// registers. `factors`: of the first pivot and the four rows; `upper`: row of the first pivot.
template <int Vectors>
[[gnu::always_inline]] inline void subtract_products(double* rows, int stride, const double* factors, int factor_stride,
                                                     const double* upper, int count) {
  Lanes sums[4][Vectors];
  for (int r = 0; r < 4; ++r)
    for (int v = 0; v < Vectors; ++v) sums[r][v] = load(rows + stride * r + 4 * v);
  for (int k = 0; k < count; ++k, factors += factor_stride, upper += stride) {
    Lanes values[Vectors];
    for (int v = 0; v < Vectors; ++v) values[v] = load(upper + 4 * v);
    for (int r = 0; r < 4; ++r) {
      const Lanes factor = broadcast(factors[r]);
      for (int v = 0; v < Vectors; ++v) sums[r][v] -= factor * values[v];
    }
  }
  for (int r = 0; r < 4; ++r)
    for (int v = 0; v < Vectors; ++v) store(sums[r][v], rows + stride * r + 4 * v);
}

[[gnu::always_inline]] inline Lanes absolute(const Lanes& value) {
  using Bits = long long __attribute__((vector_size(32)));
  constexpr long long kAllButTheSign = std::numeric_limits<long long>::max();
  const Bits mask = {kAllButTheSign, kAllButTheSign, kAllButTheSign, kAllButTheSign};
  return reinterpret_cast<Lanes>(reinterpret_cast<Bits>(value) & mask);
}

[[gnu::always_inline]] inline Lanes larger(const Lanes& a, const Lanes& b) {
  return a > b ? a : b;
}

/// Largest absolute value. Even and odd vectors are independent chains, so that they can run in parallel.
[[gnu::always_inline]] inline double largest(const double* values, int lanes) {
  Lanes even = {}, odd = {};
  int v = 0;
  for (; v + 2 <= lanes; v += 2) {
    even = larger(absolute(load(values + 4 * v)), even);
    odd = larger(absolute(load(values + 4 * v + 4)), odd);
  }
  if (v < lanes) even = larger(absolute(load(values + 4 * v)), even);
  const Lanes most = larger(even, odd);
  return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
}

/// The data and operations of DenseFront::eliminate(), in a form that simd::run() compiles as a whole.
struct Elimination {
  int active, candidates, stride, lower_stride;
  double *values, *lower, *column_sizes, *scales, *reciprocals;
  int *row_names, *column_names;
  int pivots = 0;

  [[gnu::always_inline]] inline double* row(int i) { return values + static_cast<std::size_t>(stride) * i; }
  /// Computes the scales of rows and columns, for rows in which pivots are searched or with which pivots are compared.
  [[gnu::always_inline]] inline bool scale(int rows_in_all) {
    const int lanes = lanes_for(active), candidate_lanes = lanes_for(candidates);
    for (int i = 0; i < rows_in_all; ++i) {
      double* own = row(i);
      for (int k = active; k < 4 * lanes; ++k) own[k] = 0;  // clear the columns of folded variables
      const double size = largest(own, lanes);
      if (!std::isfinite(size)) return false;
      scales[i] = size > 0 ? 1 / size : 0.0;
      const Lanes scale = broadcast(scales[i]);
      for (int v = 0; v < candidate_lanes; ++v) {
        store(larger(scale * absolute(load(own + 4 * v)), load(column_sizes + 4 * v)), column_sizes + 4 * v);
      }
    }
    return true;
  }

  [[gnu::always_inline]] inline bool take_pivots(const std::vector<int>& certain, bool all) {
    for (const int end : certain) {
      const int first = pivots, group = end < certain.back() ? end : candidates;
      while (pivots < end)
        if (!take_pivot(pivots, true, group, group)) return false;
      clear_below(first, group);
    }
    // A column without a sufficient pivot may get one after other eliminations. If all must be taken, the best come
    // first.
    for (const bool must : {false, true}) {
      if (must && !all) break;
      for (int before = -1; before != pivots && pivots < candidates;) {
        before = pivots;
        for (int k = pivots; k < candidates; ++k) take_pivot(k, must, candidates, active);
      }
    }
    return !all || pivots == candidates;
  }

 private:
  [[gnu::always_inline]] inline double* multipliers(int k) {
    return lower + static_cast<std::size_t>(lower_stride) * k;
  }

  /// Largest absolute value of a column within a range of rows, scaled by rows; its row is written to `at`.
  [[gnu::always_inline]] inline double largest_entry(int column, int first, int last, int& at) {
    double most = 0;
    at = first;
    for (int i = first; i < last; ++i) {
      const double size = scales[i] * std::abs(row(i)[column]);
      if (size > most) most = size, at = i;
    }
    return most;
  }

  /// Eliminates a column if the rows below `searched` have a sufficient pivot for it; updates the rows below
  /// `last_row`.
  [[gnu::always_inline]] inline bool take_pivot(int column, bool must, int searched, int last_row) {
    int pivot_row, other;
    const double size = largest_entry(column, pivots, searched, pivot_row);
    if (!(size > kRoundOff * column_sizes[column])) return false;
    if (!must && size < kThreshold * largest_entry(column, candidates, active, other)) return false;
    swap_rows(pivot_row, pivots);
    swap_columns(column, pivots);
    const double* pivot_values = row(pivots);
    const double reciprocal = reciprocals[pivots] = 1 / pivot_values[pivots];
    double* factors = multipliers(pivots);
    for (int i = pivots / 4 * 4; i <= pivots; ++i) factors[i] = 0;
    for (int i = active; i < stride; ++i) factors[i] = 0;
    const int first = pivots / 4, last = lanes_for(active);
    int i = pivots + 1;
    for (; i + 4 <= last_row; i += 4) {
      bool couples = false;  // a border has zeros where it is not coupled yet
      for (int k = i; k < i + 4; ++k) {
        factors[k] = row(k)[pivots] * reciprocal;
        couples = couples || factors[k] != 0;
      }
      if (couples) subtract_four(row(i), stride, factors + i, pivot_values, first, last);
    }
    for (; i < last_row; ++i) {
      factors[i] = row(i)[pivots] * reciprocal;
      subtract(row(i), factors[i], pivot_values, first, last);
    }
    ++pivots;
    return true;
  }

  /// Subtracts all pivots from `first_pivot` on from the rows in which these pivots were not searched.
  [[gnu::always_inline]] inline void clear_below(int first_pivot, int first_row) {
    if (pivots == first_pivot) return;
    for (int k = first_pivot; k < pivots; ++k) {
      double* factors = multipliers(k);
      for (int i = first_row; i < active; ++i) factors[i] = row(i)[k];
    }
    const int lanes = lanes_for(active - first_row);
    for (int k = first_pivot; k < pivots; ++k) {
      double* own = multipliers(k) + first_row;
      const Lanes reciprocal = broadcast(reciprocals[k]);
      for (int v = 0; v < lanes; ++v) store(load(own + 4 * v) * reciprocal, own + 4 * v);
      for (int j = k + 1; j < pivots; ++j) subtract(multipliers(j) + first_row, row(k)[j], own, 0, lanes);
    }
    for (int k = first_pivot; k < pivots; ++k) std::fill(multipliers(k) + active, multipliers(k) + lower_stride, 0.0);
    const int first = pivots / 4, last = lanes_for(active), count = pivots - first_pivot;
    const double *factors = multipliers(first_pivot), *upper = row(first_pivot);
    int i = first_row;
    for (; i + 4 <= active; i += 4) {
      int v = first;
      for (; v + 2 <= last; v += 2)
        subtract_products<2>(row(i) + 4 * v, stride, factors + i, lower_stride, upper + 4 * v, count);
      if (v < last) subtract_products<1>(row(i) + 4 * v, stride, factors + i, lower_stride, upper + 4 * v, count);
    }
    for (; i < active; ++i)
      for (int k = first_pivot; k < pivots; ++k) subtract(row(i), multipliers(k)[i], row(k), first, last);
  }

  [[gnu::always_inline]] inline void swap_rows(int a, int b) {
    if (a == b) return;
    for (int v = 0; v < stride; v += 4) {
      const Lanes kept = load(row(a) + v);
      store(load(row(b) + v), row(a) + v);
      store(kept, row(b) + v);
    }
    for (int k = 0; k < pivots; ++k) std::swap(multipliers(k)[a], multipliers(k)[b]);
    std::swap(scales[a], scales[b]);
    std::swap(row_names[a], row_names[b]);
  }

  [[gnu::always_inline]] inline void swap_columns(int a, int b) {
    if (a == b) return;
    for (int i = 0; i < active; ++i) std::swap(row(i)[a], row(i)[b]);
    std::swap(column_sizes[a], column_sizes[b]);
    std::swap(column_names[a], column_names[b]);
  }
};

}  // namespace

void DenseFront::reserve(int size) {
  const std::size_t lanes = lanes_for(size);
  for (std::vector<int>* labels : {&rows, &columns}) labels->reserve(size);
  for (std::vector<double>* numbers : {&scales_, &reciprocals_}) numbers->reserve(size);
  column_sizes_.reserve(lanes);
  values_.reserve(lanes * size);
  lower_.reserve((lanes + 1) * size);
  right_.reserve(6 * lanes);
}

void DenseFront::clear() {
  for (const int scalar : rows) row_place_[scalar] = -1;
  for (const int scalar : columns) column_place_[scalar] = -1;
  rows.clear();
  columns.clear();
}

void DenseFront::start(int active) {
  assert(active >= 0 && active <= size() && columns.size() == rows.size());
  active_ = active;
  const int lanes = lanes_for(size());
  stride_ = 4 * lanes;
  const std::size_t fours = static_cast<std::size_t>(lanes) * size();
  if (values_.size() < fours) values_.resize(fours);
  std::fill_n(numbers(values_), 4 * fours, 0.0);
  for (int i = 0; i < size(); ++i) {
    row_place_[rows[i]] = i;
    column_place_[columns[i]] = i;
  }
}

void DenseFront::add(int row, int column, const double* values, int row_count, int column_count, int distance) {
  const int first_row = row_place_[row], first_column = column_place_[column];
  assert(first_row >= 0 && first_row + row_count <= size() && "scalars of the front");
  assert(first_column >= 0 && first_column + column_count <= size() && "scalars of the front");
  if (column_count == 6) {  // the most frequent case, as an unrolled loop
    for (int r = 0; r < row_count; ++r) {
      double* to = this->row(first_row + r) + first_column;
      for (int c = 0; c < 6; ++c) to[c] += values[distance * c + r];
    }
    return;
  }
  for (int r = 0; r < row_count; ++r) {
    double* to = this->row(first_row + r) + first_column;
    for (int c = 0; c < column_count; ++c) to[c] += values[distance * c + r];
  }
}

void DenseFront::fold(int slave, int count, const double* left, const double* right, int distance, const int* targets,
                      int target_count) {
  const int place = column_place_[slave], slave_row = row_place_[slave], lanes = lanes_for(size()),
            rows_in_all = size();
  assert(place >= 0 && slave_row >= 0 && "scalars of the front");
  right_.assign(static_cast<std::size_t>(lanes) * count, {});  // indexed by columns of the front
  double *columns_of = numbers(right_), *values = numbers(values_);
  for (int k = 0; k < count; ++k)
    for (int t = 0; t < target_count; ++t)
      columns_of[stride_ * k + column_place_[targets[t]]] = right[distance * k + t];
  const int* places = row_place_.data();
  const int stride = stride_;
  simd::run([&] {
    for (int i = 0; i < rows_in_all; ++i) {
      double* own = values + stride * i;
      for (int k = 0; k < count; ++k)
        if (own[place + k] != 0) subtract(own, -own[place + k], columns_of + stride * k, 0, lanes);
    }
    for (int t = 0; t < target_count; ++t) {
      double* own = values + stride * places[targets[t]];
      for (int k = 0; k < count; ++k)
        if (left[distance * k + t] != 0)
          subtract(own, -left[distance * k + t], values + stride * (slave_row + k), 0, lanes);
    }
  });
}

void DenseFront::clear_row(int scalar) {
  assert(row_place_[scalar] >= 0);
  std::fill_n(row(row_place_[scalar]), stride_, 0.0);
}

int DenseFront::eliminate(int candidates, const std::vector<int>& certain, bool all) {
  assert(candidates >= 0 && candidates <= active_);
  assert(certain.empty() || certain.back() <= candidates);
  lower_.resize(std::max(lower_.size(), static_cast<std::size_t>(lower_stride() / 4) * candidates));
  scales_.resize(active_);
  column_sizes_.assign(lanes_for(candidates), {});
  reciprocals_.resize(candidates);
  Elimination elimination{active_,
                          candidates,
                          stride_,
                          lower_stride(),
                          numbers(values_),
                          numbers(lower_),
                          numbers(column_sizes_),
                          scales_.data(),
                          reciprocals_.data(),
                          rows.data(),
                          columns.data()};
  bool done = false;
  const int searched = !certain.empty() && certain.back() == candidates ? candidates : active_;
  simd::run([&] { done = elimination.scale(searched) && elimination.take_pivots(certain, all); });
  return done ? elimination.pivots : -1;
}

}  // namespace flexarm
