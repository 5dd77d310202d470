#include "contact/closest_point.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "math/shape_functions.h"

namespace flexarm {
namespace {

using ShapePowers = Eigen::Matrix<double, 5, 5>;

/// Returns the coefficients of the shape functions: row i has those of node i, by powers of xi.
ShapePowers powers_of(int order) {
  ShapePowers out = ShapePowers::Zero();
  const int nodes = order + 1;
  for (int i = 0; i < nodes; ++i) {
    out(i, 0) = 1;
    int degree = 0;
    for (int k = 0; k < nodes; ++k) {
      if (k == i) continue;
      const double at = node_coordinate(nodes, k), slope = 1 / (node_coordinate(nodes, i) - at);
      for (int d = degree + 1; d > 0; --d) out(i, d) = slope * (out(i, d - 1) - at * out(i, d));
      out(i, 0) *= -at * slope;
      ++degree;
    }
  }
  return out;
}

const ShapePowers& shape_powers(int order) {
  static const std::array<ShapePowers, 5> all = {ShapePowers::Zero(), powers_of(1), powers_of(2), powers_of(3),
                                                 powers_of(4)};
  return all[order];
}

/// Half of the squared distance between a point and a line piece, as a polynomial of xi.
class HalfSquare {
 public:
  HalfSquare(const LinePiece& piece, const Vector3& point) : degree_(2 * piece.order), powers_(piece.squares) {
    const Vector3 middle = piece.middle() - point;
    powers_[0] = middle.squaredNorm();
    for (int k = 1; k <= piece.order; ++k) powers_[k] += 2 * middle.dot(piece.coefficients.col(k));
    for (int k = 0; k <= degree_; ++k) powers_[k] *= 0.5;
  }

  double value(double xi) const {
    double out = powers_[degree_];
    for (int k = degree_ - 1; k >= 0; --k) out = xi * out + powers_[k];
    return out;
  }
  /// Returns the first and second derivatives with respect to xi.
  std::pair<double, double> derivatives(double xi) const {
    double value = powers_[degree_], slope = 0, half_curvature = 0;
    for (int k = degree_ - 1; k >= 0; --k) {
      half_curvature = xi * half_curvature + slope;
      slope = xi * slope + value;
      value = xi * value + powers_[k];
    }
    return {slope, 2 * half_curvature};
  }

 private:
  int degree_;
  std::array<double, 9> powers_;
};

/// Returns the position of a piece at xi.
Vector3 place_at(const LinePiece& piece, double xi) {
  Vector3 out = piece.coefficients.col(piece.order);
  for (int k = piece.order - 1; k >= 0; --k) out = xi * out + piece.coefficients.col(k);
  return out;
}

}  // namespace

LineWeights line_weights(int order, double xi) {
  const ShapePowers& powers = shape_powers(order);
  LineWeights out;
  for (int i = 0; i <= order; ++i)
    for (int k = order; k >= 0; --k) {
      out.curvatures[i] = xi * out.curvatures[i] + 2 * out.slopes[i];
      out.slopes[i] = xi * out.slopes[i] + out.values[i];
      out.values[i] = xi * out.values[i] + powers(i, k);
    }
  return out;
}

LinePiece line_piece(int order, const std::array<Vector3, 5>& nodes) {
  assert(order >= 1 && order <= 4);
  const ShapePowers& powers = shape_powers(order);
  LinePiece out;
  out.order = order;
  out.coefficients.setZero();
  for (int k = 0; k <= order; ++k)
    for (int i = 0; i <= order; ++i) out.coefficients.col(k) += powers(i, k) * nodes[i];
  for (int i = 1; i <= order; ++i)
    for (int k = 1; k <= order; ++k) out.squares[i + k] += out.coefficients.col(i).dot(out.coefficients.col(k));
  for (int k = 2; k <= order; ++k) out.bulge += out.coefficients.col(k).norm();
  out.reach = out.bulge + out.coefficients.col(1).norm();
  return out;
}

double LinePiece::least_distance(const Vector3& point) const {
  const Vector3 along = coefficients.col(1), from = point - coefficients.col(0);
  const double square = along.squaredNorm();
  const double xi = square > 0 ? std::clamp(along.dot(from) / square, -1.0, 1.0) : 0.0;
  return (from - xi * along).norm() - bulge;
}

ClosestPoint closest_point(const LinePiece& piece, const Vector3& point, double low, double high) {
  const HalfSquare half_square(piece, point);
  // The polynomial has the degree 2 order. Between two of so many samples it has at most one minimum, except if the
  // line winds strongly within an element.
  const int spans = 2 * piece.order;
  double begin = low, end = high, xi = low, least = std::numeric_limits<double>::infinity();
  const auto sample = [&](int i) { return i == spans ? high : low + (high - low) * i / spans; };
  for (int i = 0; i <= spans; ++i) {
    const double at = sample(i), value = half_square.value(at);
    if (value >= least) continue;
    least = value;
    xi = at;
    begin = sample(std::max(i - 1, 0));
    end = sample(std::min(i + 1, spans));
  }
  constexpr int kMostLooks = 60;
  constexpr double kSmall = 1e-9;               // after one more Newton step the error is the square of this
  bool knows_begin = false, knows_end = false;  // whether the minimum is known to be between xi and begin, end
  for (int look = 0; look < kMostLooks; ++look) {
    const auto [slope, rise] = half_square.derivatives(xi);
    if (slope == 0 || (slope < 0 && xi == high) || (slope > 0 && xi == low)) break;
    if (rise > 0 && std::abs(slope) <= kSmall * rise) {
      xi = std::clamp(xi - slope / rise, low, high);
      break;
    }
    (slope < 0 ? begin : end) = xi;
    (slope < 0 ? knows_begin : knows_end) = true;
    double next = xi - slope / rise;
    if (!(rise > 0) || next <= begin || next >= end) {
      if (slope < 0)
        next = knows_end ? 0.5 * (begin + end) : end;
      else
        next = knows_begin ? 0.5 * (begin + end) : begin;
    }
    if (next == xi) break;
    xi = next;
  }
  ClosestPoint out;
  out.square = (place_at(piece, xi) - point).squaredNorm();
  out.xi = xi;
  const double slope = half_square.derivatives(xi).first;
  out.is_clamped = (xi <= low && slope > 0) || (xi >= high && slope < 0);
  return out;
}

}  // namespace flexarm
