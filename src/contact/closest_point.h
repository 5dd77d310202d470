#pragma once
/// Where a beam's line is nearest to a point. (docs/notes/contact.md 1.3)

#include <array>
#include <limits>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

/// Numbers for the nodes of one element of a beam; zero beyond its last.
using ElementWeights = std::array<double, 5>;

/// The line through a beam's nodes, which others touch at a distance: a tube.
struct ContactLine {
  int order = 2;                             ///< elements have order + 1 nodes
  std::vector<std::array<int, 5>> elements;  ///< nodes of each; of the model
  std::vector<double> lengths;               ///< of each, undeformed [m]
  double radius = 0;                         ///< of the tube [m]
};

/// Shape functions of an element at xi in [-1, 1], and their first and second derivatives.
struct LineWeights {
  ElementWeights values{}, slopes{}, curvatures{};
};
LineWeights line_weights(int order, double xi);

/// A part of a line, by element + (xi + 1) / 2.
struct LineRange {
  double begin = 0, end = std::numeric_limits<double>::infinity();
};

/// One element at one time, as a polynomial of xi.
struct LinePiece {
  int order = 1;
  Eigen::Matrix<double, 3, 5> coefficients;  ///< of powers [m]
  std::array<double, 9> squares{};           ///< of its square where its middle is the origin, by powers [m^2]
  double reach = 0;                          ///< no point of it is farther from its middle [m]
  double bulge = 0;                          ///< nor from the straight line that its first two are [m]

  Vector3 middle() const { return coefficients.col(0); }
  /// No point of it is nearer to another one [m]; may be < 0.
  double least_distance(const Vector3& point) const;
};
/// `nodes`: where they are, order + 1 of them [m].
LinePiece line_piece(int order, const std::array<Vector3, 5>& nodes);

/// A place of a line and the square of its distance from a point [m^2].
struct ClosestPoint {
  double square = std::numeric_limits<double>::infinity();
  int element = -1;
  double xi = 0;
  bool is_clamped = false;  ///< at an end of what was looked at: it stays there
};
/// Of all xi from `low` to `high` the nearest.
ClosestPoint closest_point(const LinePiece& piece, const Vector3& point, double low, double high);

}  // namespace flexarm
