#include "contact/closest_point.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "math/shape_functions.h"

namespace flexarm {
namespace {

using ShapePowers = Eigen::Matrix<double, 5, 5>;

/// Row i: coefficients of the shape function of node i by powers of xi.
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

/// A place of a piece less a point, and its derivatives by xi.
struct LineOffset {
  Vector3 value, slope, curvature;
};
LineOffset offset_at(const LinePiece& piece, const Vector3& point, double xi) {
  LineOffset out{piece.coefficients.col(piece.order), Vector3::Zero(), Vector3::Zero()};
  for (int k = piece.order - 1; k >= 0; --k) {
    out.curvature = xi * out.curvature + 2 * out.slope;
    out.slope = xi * out.slope + out.value;
    out.value = xi * out.value + piece.coefficients.col(k);
  }
  out.value -= point;
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
  // The squared distance has degree 2 order: between so many samples it has no more than one valley, but for lines that
  // wind within an element.
  const int spans = 2 * piece.order;
  ClosestPoint out;
  double begin = low, end = high;
  const auto sample = [&](int i) { return i == spans ? high : low + (high - low) * i / spans; };
  for (int i = 0; i <= spans; ++i) {
    const double xi = sample(i), square = offset_at(piece, point, xi).value.squaredNorm();
    if (square >= out.square) continue;
    out.square = square;
    out.xi = xi;
    begin = sample(std::max(i - 1, 0));
    end = sample(std::min(i + 1, spans));
  }
  constexpr int kMostLooks = 60;
  constexpr double kTiny = 1e-15;
  bool knows_begin = false, knows_end = false;  // which side of the valley they are on
  double xi = out.xi;
  for (int look = 0; look < kMostLooks; ++look) {
    const LineOffset offset = offset_at(piece, point, xi);
    const double slope = offset.value.dot(offset.slope);
    if (slope == 0 || (slope < 0 && xi == high) || (slope > 0 && xi == low)) break;
    (slope < 0 ? begin : end) = xi;
    (slope < 0 ? knows_begin : knows_end) = true;
    const double rise = offset.slope.squaredNorm() + offset.value.dot(offset.curvature);
    double next = xi - slope / rise;
    if (!(rise > 0) || next <= begin || next >= end) {
      if (slope < 0)
        next = knows_end ? 0.5 * (begin + end) : end;
      else
        next = knows_begin ? 0.5 * (begin + end) : begin;
    }
    const bool is_there = std::abs(next - xi) <= kTiny;
    xi = next;
    if (is_there) break;
  }
  const LineOffset offset = offset_at(piece, point, xi);
  out.square = offset.value.squaredNorm();
  out.xi = xi;
  const double slope = offset.value.dot(offset.slope);
  out.is_clamped = (xi <= low && slope > 0) || (xi >= high && slope < 0);
  return out;
}

}  // namespace flexarm
