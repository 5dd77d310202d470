#pragma once
/// Sections of a slide line between its nodes, for scalars of any kind.

#include <array>
#include <type_traits>

#include "flexarm/math/cayley.h"
#include "flexarm/math/local_rotation.h"
#include "flexarm/model/slide_line.h"

namespace flexarm {

/// A node's pose with scalars of any kind (complex steps).
template <typename S>
struct PoseT {
  Vector3T<S> position;
  QuaternionT<S> orientation;
};

/// The section of the line at an arc length X.
template <typename S>
struct Section {
  Vector3T<S> position, tangent;  ///< r, dr/dX
  Matrix3T<S> rotation;           ///< Lambda
  Vector3T<S> spatial_curvature;  ///< k = Lambda Upsilon: spin per change of X [1/m]
};

namespace slide {

constexpr int kMostNodes = 5;  ///< of an element

/// Calls visit(std::integral_constant<int, N>) for the number of nodes of a piece.
template <class Visit>
decltype(auto) with_node_count(int count, const Visit& visit) {
  switch (count) {
    case 2:
      return visit(std::integral_constant<int, 2>());
    case 3:
      return visit(std::integral_constant<int, 3>());
    case 4:
      return visit(std::integral_constant<int, 4>());
    default:
      return visit(std::integral_constant<int, 5>());
  }
}

/// Lagrange functions of a piece and their derivatives over the arc length.
template <typename S>
struct Weights {
  std::array<S, kMostNodes> values, derivatives;
};
template <typename S>
Weights<S> weights(const SlidePiece& piece, const S& arc_length) {
  Weights<S> out;
  const double scale = 2 / (piece.end - piece.begin);
  const S xi = scale * (arc_length - piece.begin) - S(1);
  for (int i = 0; i < piece.node_count; ++i) {
    S value(1), derivative(0);
    for (int k = 0; k < piece.node_count; ++k) {
      if (k == i) continue;
      const double slope = 1 / (node_coordinate(piece.node_count, i) - node_coordinate(piece.node_count, k));
      const S factor = slope * (xi - node_coordinate(piece.node_count, k));
      derivative = derivative * factor + value * slope;
      value *= factor;
    }
    out.values[i] = value;
    out.derivatives[i] = scale * derivative;
  }
  return out;
}

/// (I(to) - I(from)) / (to - from) of a piece's Lagrange functions, free of cancellation: [fg] = [f] g(to) + f(from)
/// [g].
template <typename S>
std::array<S, kMostNodes> divided_differences(const SlidePiece& piece, double from, const S& to) {
  std::array<S, kMostNodes> out;
  const double scale = 2 / (piece.end - piece.begin);
  const double xi_from = scale * (from - piece.begin) - 1;
  const S xi_to = scale * (to - piece.begin) - S(1);
  for (int i = 0; i < piece.node_count; ++i) {
    double at_from = 1;
    S difference(0);
    for (int k = 0; k < piece.node_count; ++k) {
      if (k == i) continue;
      const double node = node_coordinate(piece.node_count, k);
      const double slope = 1 / (node_coordinate(piece.node_count, i) - node);
      difference = difference * (slope * (xi_to - node)) + at_from * slope;
      at_from *= slope * (xi_from - node);
    }
    out[i] = scale * difference;
  }
  return out;
}

}  // namespace slide

/// The section at arc length X; `poses(i)`: PoseT<S> of the line's node i.
template <typename S, class Poses>
Section<S> section_at(const SlideLine& line, int piece_index, const S& arc_length, const Poses& poses) {
  const SlidePiece& piece = line.pieces[piece_index];
  const slide::Weights<S> w = slide::weights(piece, arc_length);
  Section<S> out;
  out.position.setZero();
  out.tangent.setZero();
  slide::with_node_count(piece.node_count, [&](auto count) {
    constexpr int N = decltype(count)::value;
    std::array<QuaternionT<S>, N> orientation;
    for (int i = 0; i < N; ++i) {
      const PoseT<S> pose = poses(piece.first_node + i);
      orientation[i] = pose.orientation;
      out.position += w.values[i] * pose.position;
      out.tangent += w.derivatives[i] * pose.position;
    }
    const LocalRotations<N, S> local(orientation);
    Vector3T<S> theta = Vector3T<S>::Zero(), slope = Vector3T<S>::Zero();
    for (int i = 0; i < N; ++i) {
      theta += w.values[i] * local.rotation_vectors()[i];
      slope += w.derivatives[i] * local.rotation_vectors()[i];
    }
    const so3::ExponentialMap<S> map(theta);
    out.rotation = map.rotation() * local.reference_rotation();
    // Local vectors are kept in space, so T theta' is the spin per arc length in space.
    out.spatial_curvature = map.tangent() * slope;
  });
  return out;
}

}  // namespace flexarm
