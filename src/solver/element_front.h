#pragma once
/// Elimination of a beam element's outboard nodes: one front of the block elimination along a tree.

namespace flexarm {

/// Dense block elimination of the nodes 1 ... Nodes - 1 of an element with 6 unknowns per node. With A11 the rows and
/// columns of these nodes, A00 those of node 0 and A01, A10 the couplings:
///   X = A11^-1 A10,  S = A00 - A01 X.
/// A11 is factorised with partial pivoting. The loops run through simd::run().
template <int Nodes>
struct ElementFront {
  static constexpr int kEliminated = 6 * (Nodes - 1);
  /// Doubles of an element's tangent, and of the factors that take its place.
  static constexpr int kSize = 36 * Nodes * Nodes;

  /// `blocks`: the element's tangent, block (i, j) of nodes i, j column-major at 36 (i Nodes + j); replaced by the
  /// factors. `diagonals`: per node what else stands on its 6 x 6 diagonal block, column-major; node 0 receives S
  /// there. `rows`: kEliminated row numbers of the pivots. False if a pivot is zero or not finite.
  static bool eliminate(double* blocks, double* const* diagonals, unsigned char* rows);
  /// Forward elimination of a right-hand side of 6 values per node: r1 <- A11^-1 r1, r0 <- r0 - A01 r1.
  static void forward(const double* factors, const unsigned char* rows, double* const* r);
  /// Back substitution: r1 <- r1 - X r0.
  static void backward(const double* factors, double* const* r);
};

}  // namespace flexarm
