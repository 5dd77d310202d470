#include "solver/element_front.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "math/pack.h"
#include "math/simd.h"
#include "solver/front_lanes.h"

namespace flexarm {
namespace {

using LaneMask = long long __attribute__((vector_size(32)));

/// Masks for a lane j: the lanes after it, and the lanes before it.
constexpr LaneMask kBehind[] = {{0, -1, -1, -1}, {0, 0, -1, -1}, {0, 0, 0, -1}, {0, 0, 0, 0}};
constexpr LaneMask kBefore[] = {{0, 0, 0, 0}, {-1, 0, 0, 0}, {-1, -1, 0, 0}, {-1, -1, -1, 0}};

[[gnu::always_inline]] inline Lanes kept(const Lanes& lanes, const LaneMask& mask) {
  return reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(lanes) & mask);
}

/// Sizes of a front. Layout of the factors: columns of L and U in one matrix (without the unit diagonal of L, with the
/// reciprocal diagonal of U), padded to whole lanes; then the columns of A01; then the columns of X.
template <int Nodes, int U>
struct Sizes {
  static constexpr int n = ElementFront<Nodes, U>::kEliminated;
  static constexpr int pivot_lanes = lanes_for(n);  // lanes of a row of A11
  static constexpr int right_lanes = lanes_for(U);
  static constexpr int row_lanes = pivot_lanes + right_lanes;  // including the row of A10
  static constexpr int stride = 4 * pivot_lanes;               // of the columns of L and U
  static constexpr int column = ElementFront<Nodes, U>::kColumn, block = ElementFront<Nodes, U>::kBlock;
  static constexpr int coupling = stride * n, elimination = coupling + column * n;
  static_assert(elimination + U * n <= ElementFront<Nodes, U>::kSize);
};

/// Rows of [A11 A10 r1], and the multipliers of the elimination. The right-hand side is stored in the first number of
/// the lanes that the columns of A10 leave unused.
template <int Nodes, int U>
struct Rows {
  static constexpr int n = Sizes<Nodes, U>::n;
  static_assert(U < 4 * Sizes<Nodes, U>::right_lanes);
  Lanes value[n][Sizes<Nodes, U>::row_lanes];
  double lower[n][n];

  [[gnu::always_inline]] inline double* row(int i) { return reinterpret_cast<double*>(value[i]); }
  [[gnu::always_inline]] inline double* right(int i) {
    return reinterpret_cast<double*>(value[i] + Sizes<Nodes, U>::pivot_lanes);
  }
};

template <int Nodes, int U>
[[gnu::always_inline]] inline void gather(const double* blocks, double* const* diagonals, double* const* r,
                                          Rows<Nodes, U>& rows) {
  using S = Sizes<Nodes, U>;
  // Clear the padding of the lanes.
  for (auto& row : rows.value) row[Sizes<Nodes, U>::pivot_lanes - 1] = row[Sizes<Nodes, U>::row_lanes - 1] = Lanes{};
  for (int i = 1; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j) {
      const double* block = blocks + S::block * (i * Nodes + j);
      for (int k = 0; k < U; ++k) {
        double* to = j == 0 ? rows.right(U * (i - 1) + k) : rows.row(U * (i - 1) + k) + U * (j - 1);
        if (i == j)
          for (int c = 0; c < U; ++c) to[c] = block[S::column * c + k] + diagonals[i][S::column * c + k];
        else
          for (int c = 0; c < U; ++c) to[c] = block[S::column * c + k];
      }
    }
  for (int i = 0; i < S::n && r; ++i) rows.right(i)[U] = r[1 + i / U][i % U];
}

/// Subtracts the pivot's row from the rows below, so that column k becomes zero there.
template <int Nodes, int U>
[[gnu::always_inline]] inline void clear_below(Rows<Nodes, U>& rows, int k, double* reciprocal) {
  constexpr int n = Sizes<Nodes, U>::n, lanes = Sizes<Nodes, U>::row_lanes;
  reciprocal[k] = 1 / rows.row(k)[k];
  for (int i = k + 1; i < n; ++i) {
    const double multiplier = rows.row(i)[k] * reciprocal[k];
    rows.lower[i][k] = multiplier;
    for (int v = k / 4; v < lanes; ++v) rows.value[i][v] -= multiplier * rows.value[k][v];
  }
}

/// L U factorisation with pivots on the diagonal, applied to A10 and r1 as well. A pivot is the original diagonal entry
/// minus products of multipliers and entries. If all pivots are positive, and none is larger than twice its original
/// entry, these products are no larger than the matrix, and round-off is no worse than with a pivot search. (If A11 is
/// symmetric and positive definite, all products are positive and pivots only decrease. The criterion does not depend
/// on the scaling of rows and columns.) Returns false if the criterion is not met.
template <int Nodes, int U>
[[gnu::always_inline]] inline bool factorise_on_diagonal(Rows<Nodes, U>& rows, double* reciprocal) {
  constexpr int n = Sizes<Nodes, U>::n;
  double entry[n];
  for (int k = 0; k < n; ++k) entry[k] = rows.row(k)[k];
  bool stays_small = true;
#pragma GCC unroll 24
  for (int k = 0; k < n; ++k) {
    const double pivot = rows.row(k)[k];
    stays_small = stays_small && pivot >= kSmallestPivot && pivot <= std::min(2 * entry[k], kLargestPivot);
    clear_below(rows, k, reciprocal);
  }
  return stays_small;
}

/// L U factorisation with partial pivoting.
template <int Nodes, int U>
[[gnu::noinline]] bool factorise_with_pivots(Rows<Nodes, U>& rows, double* reciprocal, unsigned char* pivots) {
  constexpr int n = Sizes<Nodes, U>::n, lanes = Sizes<Nodes, U>::row_lanes;
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    double largest = std::abs(rows.row(k)[k]);
    for (int i = k + 1; i < n; ++i) {
      const double size = std::abs(rows.row(i)[k]);
      if (size > largest) largest = size, pivot = i;
    }
    if (!(largest > 0) || !std::isfinite(largest)) return false;
    if (pivot != k) {
      for (int v = 0; v < lanes; ++v) std::swap(rows.value[k][v], rows.value[pivot][v]);
      for (int c = 0; c < k; ++c) std::swap(rows.lower[k][c], rows.lower[pivot][c]);
      std::swap(pivots[k], pivots[pivot]);
    }
    clear_below(rows, k, reciprocal);
  }
  return true;
}

template <int Nodes, int U>
[[gnu::always_inline]] inline bool eliminate_front(double* blocks, double* const* diagonals, unsigned char* pivots,
                                                   double* const* r) {
  using S = Sizes<Nodes, U>;
  constexpr int n = S::n, right = S::pivot_lanes;
  Rows<Nodes, U> rows;
  double reciprocal[n];
  for (int i = 0; i < n; ++i) pivots[i] = static_cast<unsigned char>(i);
  gather<Nodes, U>(blocks, diagonals, r, rows);
  if (__builtin_expect(!factorise_on_diagonal<Nodes, U>(rows, reciprocal), 0)) {
    gather<Nodes, U>(blocks, diagonals, r, rows);
    if (!factorise_with_pivots<Nodes, U>(rows, reciprocal, pivots)) return false;
  }
  for (int k = n - 1; k >= 0; --k) {  // computes X column by column, so that the rows are independent of each other
    Lanes solved[S::right_lanes];
    for (int v = 0; v < S::right_lanes; ++v)
      rows.value[k][right + v] = solved[v] = reciprocal[k] * rows.value[k][right + v];
    for (int i = k - 1; i >= 0; --i) {
      const double upper = rows.row(i)[k];
      for (int v = 0; v < S::right_lanes; ++v) rows.value[i][right + v] -= upper * solved[v];
    }
  }
  for (int i = 0; i < U; ++i) {  // computes S
    Lanes sums[S::right_lanes] = {};
    for (int j = 0; j < n; ++j) {
      const double coupling = blocks[S::block * (1 + j / U) + S::column * (j % U) + i];
      for (int v = 0; v < S::right_lanes; ++v) sums[v] += coupling * rows.value[j][right + v];
    }
    for (int c = 0; c < U; ++c) diagonals[0][S::column * c + i] += blocks[S::column * c + i] - sums[c / 4][c % 4];
    if (r) r[0][i] -= sums[U / 4][U % 4];
  }
  for (int i = 0; i < n && r; ++i) r[1 + i / U][i % U] = rows.right(i)[U];
  double coupling[S::column * n];
  std::memcpy(coupling, blocks + S::block, sizeof(coupling));  // the blocks (0, j) are contiguous
  for (int c = 0; c < n; ++c)
    for (int i = 0; i < S::stride; ++i)
      blocks[S::stride * c + i] = i >= n ? 0.0 : i > c ? rows.lower[i][c] : i == c ? reciprocal[c] : rows.row(i)[c];
  std::memcpy(blocks + S::coupling, coupling, sizeof(coupling));
  for (int c = 0; c < U; ++c)
    for (int i = 0; i < n; ++i) blocks[S::elimination + n * c + i] = rows.right(i)[c];
  return true;
}

template <int Nodes, int U>
[[gnu::always_inline]] inline void forward_front(const double* factors, const unsigned char* pivots, double* const* r) {
  constexpr int n = Sizes<Nodes, U>::n;
  constexpr int lanes = Sizes<Nodes, U>::pivot_lanes;
  Lanes values[lanes] = {};
  double* y = reinterpret_cast<double*>(values);
  for (int i = 0; i < n; ++i) y[i] = r[1 + pivots[i] / U][pivots[i] % U];
#pragma GCC unroll 24
  for (int j = 0; j < n; ++j) {
    const Lanes pivot = broadcast(values[j / 4][j % 4]);
    for (int v = j / 4; v < lanes; ++v) {
      Lanes column = load(factors + Sizes<Nodes, U>::stride * j + 4 * v);
      if (v == j / 4) column = kept(column, kBehind[j % 4]);
      values[v] -= column * pivot;
    }
  }
#pragma GCC unroll 24
  for (int j = n - 1; j >= 0; --j) {
    const double pivot = values[j / 4][j % 4] * factors[Sizes<Nodes, U>::stride * j + j];
    for (int v = 0; v <= j / 4; ++v) {
      Lanes column = load(factors + Sizes<Nodes, U>::stride * j + 4 * v);
      if (v == j / 4) column = kept(column, kBefore[j % 4]);
      values[v] -= column * broadcast(pivot);
    }
    values[j / 4][j % 4] = pivot;
  }
  double inboard[U] = {};
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < U; ++i)
      inboard[i] += factors[Sizes<Nodes, U>::coupling + Sizes<Nodes, U>::column * j + i] * y[j];
  for (int i = 0; i < U; ++i) r[0][i] -= inboard[i];
  for (int i = 0; i < n; ++i) r[1 + i / U][i % U] = y[i];
}

template <int Nodes, int U>
[[gnu::always_inline]] inline void backward_front(const double* factors, double* const* r) {
  constexpr int n = Sizes<Nodes, U>::n;
  double x[n];
  for (int i = 0; i < n; ++i) x[i] = r[1 + i / U][i % U];
  for (int j = 0; j < U; ++j)
    for (int i = 0; i < n; ++i) x[i] -= factors[Sizes<Nodes, U>::elimination + n * j + i] * r[0][j];
  for (int i = 0; i < n; ++i) r[1 + i / U][i % U] = x[i];
}

}  // namespace

template <int Nodes, int U>
bool ElementFront<Nodes, U>::eliminate(double* blocks, double* const* diagonals, unsigned char* rows,
                                       double* const* r) {
  bool done = false;
  simd::run([&] { done = eliminate_front<Nodes, U>(blocks, diagonals, rows, r); });
  return done;
}

template <int Nodes, int U>
void ElementFront<Nodes, U>::forward(const double* factors, const unsigned char* rows, double* const* r) {
  simd::run([&] { forward_front<Nodes, U>(factors, rows, r); });
}

template <int Nodes, int U>
void ElementFront<Nodes, U>::backward(const double* factors, double* const* r) {
  simd::run([&] { backward_front<Nodes, U>(factors, r); });
}

template struct ElementFront<2, 6>;
template struct ElementFront<3, 6>;
template struct ElementFront<4, 6>;
template struct ElementFront<5, 6>;
template struct ElementFront<2, 3>;
template struct ElementFront<3, 3>;
template struct ElementFront<4, 3>;
template struct ElementFront<5, 3>;

}  // namespace flexarm
