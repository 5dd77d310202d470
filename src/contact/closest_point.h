#pragma once
/// Finds the place of a beam's line that is nearest to a point. (docs/notes/contact.md 1.3)

#include <array>
#include <limits>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

/// One number for each node of a beam element. Unused entries are zero.
using ElementWeights = std::array<double, 5>;

/// The line through a beam's nodes, as the axis of a tube that other bodies can touch.
struct ContactLine {
  int order = 2;                             ///< elements have order + 1 nodes
  std::vector<std::array<int, 5>> elements;  ///< nodes of each element, indices into Model::nodes
  std::vector<double> lengths;               ///< undeformed length of each element [m]
  double radius = 0;                         ///< of the tube [m]
};

/// Shape functions of an element at xi in [-1, 1], and their first and second derivatives.
struct LineWeights {
  ElementWeights values{}, slopes{}, curvatures{};
};
LineWeights line_weights(int order, double xi);

/// A part of a line. Its ends are given as element index + (xi + 1) / 2.
struct LineRange {
  double begin = 0, end = std::numeric_limits<double>::infinity();
};

/// One element of a line in one configuration, as a polynomial of xi.
struct LinePiece {
  int order = 1;
  Eigen::Matrix<double, 3, 5> coefficients;  ///< column k: of xi^k [m]
  std::array<double, 9> squares{};           ///< coefficients of (position - middle())^2, by powers of xi [m^2]
  double reach = 0;                          ///< bound of the distance of its points from middle() [m]
  double bulge = 0;                          ///< bound of the deviation from the linear part of the polynomial [m]

  Vector3 middle() const { return coefficients.col(0); }
  /// Returns a lower bound of the distance between the piece and a point [m]; may be < 0.
  double least_distance(const Vector3& point) const;
};
/// Returns the piece with these positions of its order + 1 nodes [m].
LinePiece line_piece(int order, const std::array<Vector3, 5>& nodes);

/// A place of a line, and the square of its distance from a point [m^2].
struct ClosestPoint {
  double square = std::numeric_limits<double>::infinity();
  int element = -1;
  double xi = 0;
  bool is_clamped = false;  ///< the place is at an end of the searched range, and small motions do not move it
};
/// Finds the nearest place with xi from `low` to `high`. Does not set the element.
ClosestPoint closest_point(const LinePiece& piece, const Vector3& point, double low, double high);

}  // namespace flexarm
