#pragma once
/// Lagrange shape functions on equally spaced nodes of the parent interval [-1, 1].

#include <Eigen/Core>

namespace flexarm {

/// One number per node of an element, e.g. the shape functions at a point.
template <int Nodes>
using NodalValues = Eigen::Matrix<double, Nodes, 1>;

/// Shape functions and their derivatives at one point. [-], and per unit of whatever coordinate they were scaled to.
template <int Nodes>
struct ShapeFunctions {
  NodalValues<Nodes> values;
  NodalValues<Nodes> derivatives;
};

/// Parent coordinate of a node: -1 for node 0, +1 for the last one.
template <int Nodes>
constexpr double node_coordinate(int node) {
  static_assert(Nodes >= 2 && Nodes <= 5, "elements have 2 to 5 nodes");
  return 2.0 * node / (Nodes - 1) - 1.0;
}

/// Lagrange functions and their derivatives with respect to xi, at the parent coordinate xi (any real number).
template <int Nodes>
ShapeFunctions<Nodes> lagrange(double xi) {
  ShapeFunctions<Nodes> result;
  for (int i = 0; i < Nodes; ++i) {
    // Product rule, one factor (xi - xi_k) / (xi_i - xi_k) after the other.
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
