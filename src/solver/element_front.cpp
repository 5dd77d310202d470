#include "solver/element_front.h"

#include <cmath>
#include <cstring>
#include <utility>

#include "math/pack.h"
#include "math/simd.h"
#include "solver/front_lanes.h"

namespace flexarm {
namespace {

using LaneMask = long long __attribute__((vector_size(32)));

/// Of a lane j: those behind it, and those before it.
constexpr LaneMask kBehind[] = {{0, -1, -1, -1}, {0, 0, -1, -1}, {0, 0, 0, -1}, {0, 0, 0, 0}};
constexpr LaneMask kBefore[] = {{0, 0, 0, 0}, {-1, 0, 0, 0}, {-1, -1, 0, 0}, {-1, -1, -1, 0}};

[[gnu::always_inline]] inline Lanes kept(const Lanes& lanes, const LaneMask& mask) {
  return reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(lanes) & mask);
}

/// Sizes of a front. Factors: columns of L and U in one matrix (unit diagonal of L left out, reciprocal diagonal of U),
/// padded to whole lanes, then the columns of A01, then the columns of X.
template <int Nodes>
struct Sizes {
  static constexpr int n = ElementFront<Nodes>::kEliminated;
  static constexpr int pivot_lanes = lanes_for(n);   // of the columns of A11 in a row
  static constexpr int row_lanes = pivot_lanes + 2;  // and six of A10
  static constexpr int stride = 4 * pivot_lanes;     // of the columns of L and U
  static constexpr int coupling = stride * n, elimination = coupling + 6 * n;
  static_assert(elimination + 6 * n <= ElementFront<Nodes>::kSize);
};

/// Rows of [A11 A10], and the multipliers of the elimination.
template <int Nodes>
struct Rows {
  static constexpr int n = Sizes<Nodes>::n;
  Lanes value[n][Sizes<Nodes>::row_lanes];
  double lower[n][n];

  [[gnu::always_inline]] inline double* row(int i) { return reinterpret_cast<double*>(value[i]); }
  [[gnu::always_inline]] inline double* right(int i) {
    return reinterpret_cast<double*>(value[i] + Sizes<Nodes>::pivot_lanes);
  }
};

template <int Nodes>
[[gnu::always_inline]] inline void gather(const double* blocks, double* const* diagonals, Rows<Nodes>& rows) {
  // What fills the lanes up.
  for (auto& row : rows.value) row[Sizes<Nodes>::pivot_lanes - 1] = row[Sizes<Nodes>::row_lanes - 1] = Lanes{};
  for (int i = 1; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j) {
      const double* block = blocks + 36 * (i * Nodes + j);
      for (int r = 0; r < 6; ++r) {
        double* to = j == 0 ? rows.right(6 * (i - 1) + r) : rows.row(6 * (i - 1) + r) + 6 * (j - 1);
        if (i == j)
          for (int c = 0; c < 6; ++c) to[c] = block[6 * c + r] + diagonals[i][6 * c + r];
        else
          for (int c = 0; c < 6; ++c) to[c] = block[6 * c + r];
      }
    }
}

/// LU with partial pivoting of A11, carried out on A10 as well.
template <int Nodes>
[[gnu::always_inline]] inline bool factorise(Rows<Nodes>& rows, double* reciprocal, unsigned char* pivots) {
  constexpr int n = Sizes<Nodes>::n, lanes = Sizes<Nodes>::row_lanes;
  for (int i = 0; i < n; ++i) pivots[i] = static_cast<unsigned char>(i);
#pragma GCC unroll 24
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
    reciprocal[k] = 1 / rows.row(k)[k];
    for (int i = k + 1; i < n; ++i) {
      const double multiplier = rows.row(i)[k] * reciprocal[k];
      rows.lower[i][k] = multiplier;
      for (int v = k / 4; v < lanes; ++v) rows.value[i][v] -= multiplier * rows.value[k][v];
    }
  }
  return true;
}

template <int Nodes>
[[gnu::always_inline]] inline bool eliminate_front(double* blocks, double* const* diagonals, unsigned char* pivots) {
  using S = Sizes<Nodes>;
  constexpr int n = S::n, right = S::pivot_lanes;
  Rows<Nodes> rows;
  double reciprocal[n];
  gather<Nodes>(blocks, diagonals, rows);
  if (!factorise<Nodes>(rows, reciprocal, pivots)) return false;
  for (int k = n - 1; k >= 0; --k) {  // X; column by column, so that rows do not wait for each other
    const Lanes first = reciprocal[k] * rows.value[k][right], second = reciprocal[k] * rows.value[k][right + 1];
    rows.value[k][right] = first;
    rows.value[k][right + 1] = second;
    for (int i = k - 1; i >= 0; --i) {
      const double upper = rows.row(i)[k];
      rows.value[i][right] -= upper * first;
      rows.value[i][right + 1] -= upper * second;
    }
  }
  for (int r = 0; r < 6; ++r) {  // S
    Lanes sums[2] = {Lanes{}, Lanes{}};
    for (int j = 0; j < n; ++j) {
      const double coupling = blocks[36 * (1 + j / 6) + 6 * (j % 6) + r];
      sums[0] += coupling * rows.value[j][right];
      sums[1] += coupling * rows.value[j][right + 1];
    }
    for (int c = 0; c < 6; ++c) diagonals[0][6 * c + r] += blocks[6 * c + r] - sums[c / 4][c % 4];
  }
  double coupling[6 * n];
  std::memcpy(coupling, blocks + 36, sizeof(coupling));  // the blocks (0, j) stand in a row
  for (int c = 0; c < n; ++c)
    for (int r = 0; r < S::stride; ++r)
      blocks[S::stride * c + r] = r >= n ? 0.0 : r > c ? rows.lower[r][c] : r == c ? reciprocal[c] : rows.row(r)[c];
  std::memcpy(blocks + S::coupling, coupling, sizeof(coupling));
  for (int c = 0; c < 6; ++c)
    for (int r = 0; r < n; ++r) blocks[S::elimination + n * c + r] = rows.right(r)[c];
  return true;
}

template <int Nodes>
[[gnu::always_inline]] inline void forward_front(const double* factors, const unsigned char* pivots, double* const* r) {
  constexpr int n = Sizes<Nodes>::n;
  constexpr int lanes = Sizes<Nodes>::pivot_lanes;
  Lanes values[lanes] = {};
  double* y = reinterpret_cast<double*>(values);
  for (int i = 0; i < n; ++i) y[i] = r[1 + pivots[i] / 6][pivots[i] % 6];
#pragma GCC unroll 24
  for (int j = 0; j < n; ++j) {
    const Lanes pivot = broadcast(values[j / 4][j % 4]);
    for (int v = j / 4; v < lanes; ++v) {
      Lanes column = load(factors + Sizes<Nodes>::stride * j + 4 * v);
      if (v == j / 4) column = kept(column, kBehind[j % 4]);
      values[v] -= column * pivot;
    }
  }
#pragma GCC unroll 24
  for (int j = n - 1; j >= 0; --j) {
    const double pivot = values[j / 4][j % 4] * factors[Sizes<Nodes>::stride * j + j];
    for (int v = 0; v <= j / 4; ++v) {
      Lanes column = load(factors + Sizes<Nodes>::stride * j + 4 * v);
      if (v == j / 4) column = kept(column, kBefore[j % 4]);
      values[v] -= column * broadcast(pivot);
    }
    values[j / 4][j % 4] = pivot;
  }
  double inboard[6] = {};
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < 6; ++i) inboard[i] += factors[Sizes<Nodes>::coupling + 6 * j + i] * y[j];
  for (int i = 0; i < 6; ++i) r[0][i] -= inboard[i];
  for (int i = 0; i < n; ++i) r[1 + i / 6][i % 6] = y[i];
}

template <int Nodes>
[[gnu::always_inline]] inline void backward_front(const double* factors, double* const* r) {
  constexpr int n = Sizes<Nodes>::n;
  double x[n];
  for (int i = 0; i < n; ++i) x[i] = r[1 + i / 6][i % 6];
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < n; ++i) x[i] -= factors[Sizes<Nodes>::elimination + n * j + i] * r[0][j];
  for (int i = 0; i < n; ++i) r[1 + i / 6][i % 6] = x[i];
}

}  // namespace

template <int Nodes>
bool ElementFront<Nodes>::eliminate(double* blocks, double* const* diagonals, unsigned char* rows) {
  bool done = false;
  simd::run([&] { done = eliminate_front<Nodes>(blocks, diagonals, rows); });
  return done;
}

template <int Nodes>
void ElementFront<Nodes>::forward(const double* factors, const unsigned char* rows, double* const* r) {
  simd::run([&] { forward_front<Nodes>(factors, rows, r); });
}

template <int Nodes>
void ElementFront<Nodes>::backward(const double* factors, double* const* r) {
  simd::run([&] { backward_front<Nodes>(factors, r); });
}

template struct ElementFront<2>;
template struct ElementFront<3>;
template struct ElementFront<4>;
template struct ElementFront<5>;

}  // namespace flexarm
