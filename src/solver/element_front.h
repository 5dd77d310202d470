#pragma once
/// Elimination of a beam element's outboard nodes: one front of the block elimination along a tree.

namespace flexarm {

/// Dense block elimination of the nodes 1 ... Nodes - 1 of an element with `Unknowns` unknowns per node, 6 or in the
/// plane 3. With A11 the rows and columns of these nodes, A00 those of node 0 and A01, A10 the couplings:
///   X = A11^-1 A10,  S = A00 - A01 X.
/// A11 = L U on the diagonal where that is as stable as with a search for pivots, which it nearly always is: inertia
/// and an element's stiffness make A11 almost symmetric and positive definite. Else with partial pivoting. The loops
/// run through simd::run().
template <int Nodes, int Unknowns = 6>
struct ElementFront {
  static constexpr int kEliminated = Unknowns * (Nodes - 1);
  /// Numbers from one column of a block to the next, and of a block.
  static constexpr int kColumn = Unknowns == 3 ? 4 : Unknowns, kBlock = kColumn * Unknowns;
  /// Doubles of an element's tangent, and of the factors that take its place.
  static constexpr int kSize = kBlock * Nodes * Nodes;

  /// `blocks`: the element's tangent, block (i, j) of nodes i, j by columns at kBlock (i Nodes + j); replaced by the
  /// factors. `diagonals`: per node what else stands on its diagonal block, by columns as well; node 0 receives S
  /// there. `rows`: kEliminated row numbers of the pivots. `r`, if not null: goes through forward() on the way. False
  /// if a pivot is zero or not finite.
  static bool eliminate(double* blocks, double* const* diagonals, unsigned char* rows, double* const* r = nullptr);
  /// Forward elimination of a right-hand side of `Unknowns` values per node: r1 <- A11^-1 r1, r0 <- r0 - A01 r1.
  static void forward(const double* factors, const unsigned char* rows, double* const* r);
  /// Back substitution: r1 <- r1 - X r0.
  static void backward(const double* factors, double* const* r);
};

}  // namespace flexarm
