#include "simulation/linear_scaling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "math/dense_eigenpairs.h"
#include "math/hessenberg.h"
#include "math/least_squares.h"
#include "math/long_product.h"
#include "math/picked.h"

namespace flexarm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRoundOff = std::numeric_limits<double>::epsilon();
/// A stiffness is zero if it is not larger than this many times the round-off of its terms.
constexpr double kAboveRoundOff = 100;

/// Mode shapes and modal coordinates: positions y = shapes q, and q = coordinates y.
struct Shapes {
  MatrixXd shapes, coordinates;
};

/// For each of these position states, its index among the model's coordinates. Empty if one of them is no coordinate.
std::vector<Index> places_of(const LinearModel& model, const std::vector<Index>& states) {
  std::vector<Index> places;
  for (const Index state : states) {
    const auto found =
        std::find(model.coordinates.begin(), model.coordinates.end(), model.states[static_cast<std::size_t>(state)]);
    if (found == model.coordinates.end()) return {};
    places.push_back(found - model.coordinates.begin());
  }
  return places;
}

/// Modes with unit norm in the mass matrix, the stiffest first. None if the mass matrix is not positive definite.
std::optional<Shapes> modes_of(const MatrixXd& mass, const MatrixXd& stiffness) {
  if (!(mass.diagonal().minCoeff() > 0)) return std::nullopt;
  // The scales are needed since translations and rotations of thin beams have masses of very different sizes.
  const VectorXd scales =
      mass.diagonal().unaryExpr([](double m) { return std::exp2(std::round(-0.5 * std::log2(m))); });
  const MatrixXd m = scales.asDiagonal() * mass * scales.asDiagonal();
  const MatrixXd k = scales.asDiagonal() * (0.5 * (stiffness + stiffness.transpose())) * scales.asDiagonal();
  const SymmetricEigenpairs masses = symmetric_eigenpairs(m);
  if (!(masses.values[0] > kRoundOff)) return std::nullopt;
  const MatrixXd whitening = masses.vectors * masses.values.cwiseSqrt().cwiseInverse().asDiagonal();
  MatrixXd shapes = whitening * symmetric_eigenpairs(whitening.transpose() * k * whitening).vectors;
  MatrixXd modal = shapes.transpose() * k * shapes;
  // Round-off of the stiff modes has mixed the soft ones. The modal stiffness is accurate enough to separate them.
  diagonalise(modal, shapes);
  std::vector<Index> order(static_cast<std::size_t>(modal.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::abs(modal(a, a)) > std::abs(modal(b, b)); });
  const MatrixXd sorted = picked_columns(shapes, order);
  const MatrixXd projection = sorted.transpose() * m;
  return Shapes{scales.asDiagonal() * sorted,
                square_solution(projection * sorted, projection) * scales.cwiseInverse().asDiagonal()};
}

/// Whether x = {y, y'}, and inputs only change y''.
bool is_of_second_order(const LinearModel& model) {
  const Index count = model.positions;
  return 2 * count == model.a.rows() && model.mass.rows() == static_cast<Index>(model.coordinates.size()) &&
         model.a.topLeftCorner(count, count).isZero(0) && model.b.topRows(count).isZero(0) &&
         model.a.topRightCorner(count, count) == MatrixXd::Identity(count, count);
}

/// Shapes of all positions. Positions that an input drives have no acceleration of their own; they come last,
/// unchanged.
std::optional<Shapes> shapes_of(const LinearModel& model) {
  const Index count = model.positions;
  if (count == 0 || !is_of_second_order(model)) return std::nullopt;
  std::vector<Index> own, driven;
  for (Index i = 0; i < count; ++i) (model.a.row(count + i).isZero(0) ? driven : own).push_back(i);
  const std::vector<Index> places = places_of(model, own);
  if (places.empty()) return std::nullopt;
  const std::optional<Shapes> modes =
      modes_of(picked(model.mass, places, places), picked(model.stiffness, places, places));
  if (!modes) return std::nullopt;
  Shapes out{MatrixXd::Zero(count, count), MatrixXd::Zero(count, count)};
  for (std::size_t i = 0; i < own.size(); ++i) {
    out.shapes.row(own[i]).head(modes->shapes.cols()) = modes->shapes.row(static_cast<Index>(i));
    out.coordinates.col(own[i]).head(modes->shapes.cols()) = modes->coordinates.col(static_cast<Index>(i));
  }
  for (std::size_t i = 0; i < driven.size(); ++i) {
    const Index last = modes->shapes.cols() + static_cast<Index>(i);
    out.shapes(driven[i], last) = out.coordinates(last, driven[i]) = 1;
  }
  return out;
}

/// Positions in coordinates that belong to `shapes`: products with the inverse of `shapes`. In these products, large
/// terms of slow modes cancel. So they are computed with more digits than the matrices have, and none of those is lost.
class LongCoordinates {
 public:
  /// `inverse`: that of `shapes`, to the digits of a double.
  LongCoordinates(const MatrixXd& shapes, const MatrixXd& inverse) : shapes_(shapes), inverse_(inverse) {
    // One iteration of Newton's method adds digits.
    const LongMatrix identity = LongMatrix::Identity(shapes.rows(), shapes.cols());
    correction_ = inverse * (identity - long_product(shapes, inverse)).cast<double>();
  }
  MatrixXd inverse() const { return inverse_ + correction_; }
  /// inverse * columns.
  MatrixXd of(const LongMatrix& columns) const {
    const MatrixXd head = columns.cast<double>(), rest = (columns - head.cast<long double>()).cast<double>();
    const MatrixXd small = inverse_ * rest + correction_ * head;  // correction_ * rest is below the last digit
    return (long_product(inverse_, head) + small.cast<long double>()).cast<double>();
  }
  /// inverse * matrix * shapes.
  MatrixXd of_map(const MatrixXd& matrix) const { return of(long_product(matrix, shapes_)); }

 private:
  const MatrixXd &shapes_, &inverse_;
  MatrixXd correction_;
};

/// States in modal coordinates: position and rate of each mode side by side.
ScaledStates by_modes(const LinearModel& model, const Shapes& modes) {
  const Index count = model.positions;
  const LongCoordinates coordinates(modes.shapes, modes.coordinates);
  const MatrixXd stiffness = model.a.bottomLeftCorner(count, count);
  const MatrixXd by_place = coordinates.of_map(stiffness),
                 by_rate = coordinates.of_map(model.a.bottomRightCorner(count, count));
  const MatrixXd inverse = coordinates.inverse();
  const MatrixXd inputs = coordinates.of(model.b.bottomRows(count).cast<long double>());
  ScaledStates out;
  out.a = out.basis = out.inverse = MatrixXd::Zero(2 * count, 2 * count);
  out.b = MatrixXd::Zero(2 * count, model.b.cols());
  for (Index i = 0; i < count; ++i) {
    for (Index half = 0; half < 2; ++half) {
      out.basis.col(2 * i + half).segment(half * count, count) = modes.shapes.col(i);
      out.inverse.row(2 * i + half).segment(half * count, count) = inverse.row(i);
    }
    out.a(2 * i, 2 * i + 1) = 1;
    for (Index j = 0; j < count; ++j) {
      out.a(2 * i + 1, 2 * j) = by_place(i, j);
      out.a(2 * i + 1, 2 * j + 1) = by_rate(i, j);
    }
    out.b.row(2 * i + 1) = inputs.row(i);
  }
  const VectorXd round_off =
      kRoundOff * (inverse.cwiseAbs() * stiffness.cwiseAbs() * modes.shapes.cwiseAbs()).diagonal();
  for (Index i = 0; i < count; ++i)
    if (std::abs(by_place(i, i)) <= kAboveRoundOff * round_off[i])
      out.zero = std::max({out.zero, std::sqrt(kAboveRoundOff * round_off[i]), std::numeric_limits<double>::min()});
  return out;
}

void require_sizes(const LinearModel& model) {
  const Index states = model.a.rows();
  const auto require = [](bool ok, const char* what, Index rows, Index columns, const std::string& expected) {
    if (!ok)
      throw std::invalid_argument(
          fmt::format("model: {} has {} rows and {} columns, expected {}", what, rows, columns, expected));
  };
  require(model.a.cols() == states, "a", states, model.a.cols(), "as many of both");
  require(model.b.rows() == states, "b", model.b.rows(), model.b.cols(), fmt::format("{} rows as a has", states));
  require(model.c.cols() == states, "c", model.c.rows(), model.c.cols(), fmt::format("{} columns as a has", states));
  require(model.d.rows() == model.c.rows() && model.d.cols() == model.b.cols(), "d", model.d.rows(), model.d.cols(),
          fmt::format("{} and {} as c and b have", model.c.rows(), model.b.cols()));
  if (model.positions < 0 || model.positions > states)
    throw std::invalid_argument(
        fmt::format("model: {} positions, expected 0 to {}, of the states", model.positions, states));
}

}  // namespace

ScaledStates scaled_states(const LinearModel& model) {
  require_sizes(model);
  ScaledStates out;
  if (const std::optional<Shapes> modes = shapes_of(model)) {
    out = by_modes(model, *modes);
    std::vector<Index> positions(static_cast<std::size_t>(model.positions));
    std::iota(positions.begin(), positions.end(), 0);
    out.places = places_of(model, positions);
  } else {
    out.a = model.a;
    out.b = model.b;
    out.basis = out.inverse = MatrixXd::Identity(model.a.rows(), model.a.cols());
    out.zero = std::numeric_limits<double>::infinity();
  }
  Balanced balanced = flexarm::balanced(std::move(out.a));
  out.a = std::move(balanced.matrix);
  // The error of an eigenvalue solver splits a double pole by its square root.
  if (out.zero > 0) out.zero = std::max(out.zero, std::sqrt(kAboveRoundOff * kRoundOff * out.a.norm()));
  out.basis = out.basis * balanced.scales.asDiagonal();
  out.inverse = balanced.scales.cwiseInverse().asDiagonal() * out.inverse;
  out.b = balanced.scales.cwiseInverse().asDiagonal() * out.b;
  out.c = model.c * out.basis;
  return out;
}

}  // namespace flexarm
