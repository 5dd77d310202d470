#pragma once
/// Eliminates a beam element's outboard nodes: one front of the block elimination along a tree.

namespace flexarm {

/// Dense block elimination of the nodes 1 ... Nodes - 1 of an element, with `Unknowns` unknowns per node: 6, or 3 in
/// the plane. A11 are the rows and columns of these nodes, A00 those of node 0, and A01, A10 the couplings:
///   X = A11^-1 A10,  S = A00 - A01 X.
/// A11 = L U is factorised with pivots on the diagonal if that is as stable as a pivot search. It nearly always is,
/// because inertia and stiffness make A11 almost symmetric and positive definite. Otherwise partial pivoting is used.
/// The loops are compiled by simd::run().
template <int Nodes, int Unknowns = 6>
struct ElementFront {
  static constexpr int kEliminated = Unknowns * (Nodes - 1);
  /// Distance between two columns of a block, and size of a block, in doubles.
  static constexpr int kColumn = Unknowns == 3 ? 4 : Unknowns, kBlock = kColumn * Unknowns;
  /// Number of doubles of an element's tangent, and of the factors that replace it.
  static constexpr int kSize = kBlock * Nodes * Nodes;

  /// `blocks`: the element's tangent; block (i, j) of nodes i and j is column-major at kBlock (i Nodes + j). It is
  /// replaced by the factors. `diagonals`: per node the other contributions to its diagonal block, column-major; that
  /// of node 0 receives S. `rows`: receives the kEliminated row numbers of the pivots. `r`: if not null, right-hand
  /// sides, which get their forward elimination as well. Returns false if a pivot is zero or not finite.
  static bool eliminate(double* blocks, double* const* diagonals, unsigned char* rows, double* const* r = nullptr);
  /// Forward elimination of a right-hand side of `Unknowns` values per node: r1 <- A11^-1 r1, r0 <- r0 - A01 r1.
  static void forward(const double* factors, const unsigned char* rows, double* const* r);
  /// Back substitution: r1 <- r1 - X r0.
  static void backward(const double* factors, double* const* r);
};

}  // namespace flexarm
