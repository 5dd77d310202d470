#pragma once
/// Lagrange shape functions on the Gauss-Lobatto points of the parent interval [-1, 1].
///
/// With these nodes, the interpolation error of a smooth curve is orthogonal to polynomials of degree order - 2
/// (order = Nodes - 1). So the order of convergence 2 (Nodes - 1) of end values also holds for curved centrelines. With
/// equally spaced nodes it does not hold from four nodes on (4 instead of 6, from the error of Simpson's 3/8 rule).

#include <Eigen/Core>

namespace flexarm {

/// One number per node of an element, e.g. the shape functions at a point.
template <int Nodes, typename S = double>
using NodalValues = Eigen::Matrix<S, Nodes, 1>;

/// Shape functions at one point [-], and their derivatives, per unit of the coordinate to which they are scaled.
template <int Nodes>
struct ShapeFunctions {
  NodalValues<Nodes> values;
  NodalValues<Nodes> derivatives;
};

/// Parent coordinate of a node of an element with 2 to 5 nodes: -1 for node 0, +1 for the last one.
constexpr double node_coordinate(int nodes, int node) {
  constexpr double kInner4 = 0.44721359549995793928183473374626;  // sqrt(1/5)
  constexpr double kInner5 = 0.65465367070797714379829245624686;  // sqrt(3/7)
  if (node == 0) return -1.0;
  if (node == nodes - 1) return 1.0;
  if (2 * node == nodes - 1) return 0.0;
  return (2 * node < nodes - 1 ? -1.0 : 1.0) * (nodes == 4 ? kInner4 : kInner5);
}
template <int Nodes>
constexpr double node_coordinate(int node) {
  static_assert(Nodes >= 2 && Nodes <= 5, "elements have 2 to 5 nodes");
  return node_coordinate(Nodes, node);
}

/// Lagrange functions and their derivatives with respect to xi, at the parent coordinate xi (any real number).
template <int Nodes>
ShapeFunctions<Nodes> lagrange(double xi) {
  ShapeFunctions<Nodes> result;
  for (int i = 0; i < Nodes; ++i) {
    // Product rule for the factors (xi - xi_k) / (xi_i - xi_k), one after the other.
    double value = 1.0, derivative = 0.0;
    for (int k = 0; k < Nodes; ++k) {
      if (k == i) continue;
      const double slope = 1.0 / (node_coordinate<Nodes>(i) - node_coordinate<Nodes>(k));
      const double factor = (xi - node_coordinate<Nodes>(k)) * slope;
      derivative = derivative * factor + value * slope;
      value *= factor;
    }
    result.values[i] = value;
    result.derivatives[i] = derivative;
  }
  return result;
}

}  // namespace flexarm
