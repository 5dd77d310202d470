#pragma once
/// Interpolates sections of a slide line between its nodes. Templates on the scalar, since derivatives use complex
/// steps.
///
/// A plain line has the interpolation of the elements, whose tangents jump at the borders of elements. A smooth line
/// adds cubic Hermite functions H to each element, with which the tangents at a border become an average of both
/// elements' tangents. Frames are smoothed in the same way, by rotations: r + H (jump of r'), exp(H (jump of k))
/// Lambda. Nodes do not move. (joints.md 4.1, beyond.md 2)

#include <array>
#include <cassert>
#include <type_traits>

#include "math/cayley.h"
#include "math/local_rotation.h"
#include "model/slide_line.h"

namespace flexarm {

/// A node's pose with scalars of any type (for complex steps).
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

constexpr int kMostNodes = 5;                 ///< of an element
constexpr int kMostWeights = 3 * kMostNodes;  ///< nodes on which a section depends

/// Coordinates of a piece's nodes in the parent interval [-1, 1], for one number of nodes.
struct PieceNodes {
  std::array<double, kMostNodes> coordinates{};
  std::array<std::array<double, kMostNodes>, kMostNodes> reciprocal_distances{};  ///< 1 / (xi_i - xi_k)
};
/// By number of nodes.
inline constexpr auto kPieceNodes = [] {
  std::array<PieceNodes, kMostNodes + 1> table{};
  for (int count = 2; count <= kMostNodes; ++count)
    for (int i = 0; i < count; ++i) {
      table[count].coordinates[i] = node_coordinate(count, i);
      for (int k = 0; k < count; ++k)
        if (k != i)
          table[count].reciprocal_distances[i][k] = 1 / (node_coordinate(count, i) - node_coordinate(count, k));
    }
  return table;
}();

/// Calls visit(std::integral_constant<int, N>) for the number of nodes of a piece.
template <class Visit>
decltype(auto) with_node_count(int count, const Visit& visit) {
  assert(count >= 2 && count <= kMostNodes);
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

/// Weights of the nodes `first`, first + 1, ... of a line at an arc length: r = sum of values[i] r_{first + i}.
template <typename S, int Most>
struct Weights {
  int first = 0, count = 0;
  std::array<S, Most> values, derivatives;  ///< `derivatives`: with respect to the arc length [1/m]
};
template <typename S>
using LagrangeWeights = Weights<S, kMostNodes>;
template <typename S>
using LineWeights = Weights<S, kMostWeights>;

/// Returns the Lagrange functions of a piece.
template <typename S>
LagrangeWeights<S> lagrange_weights(const SlidePiece& piece, const S& arc_length) {
  assert(piece.node_count >= 2 && piece.node_count <= kMostNodes && piece.length() > 0);
  LagrangeWeights<S> out;
  out.first = piece.first_node;
  out.count = piece.node_count;
  const double scale = 2 / piece.length();
  const S xi = scale * (arc_length - piece.begin) - S(1);
  const PieceNodes& nodes = kPieceNodes[piece.node_count];
  for (int i = 0; i < piece.node_count; ++i) {
    S value(1), derivative(0);
    for (int k = 0; k < piece.node_count; ++k) {
      if (k == i) continue;
      const double slope = nodes.reciprocal_distances[i][k];
      const S factor = slope * (xi - nodes.coordinates[k]);
      derivative = derivative * factor + value * slope;
      value *= factor;
    }
    out.values[i] = value;
    out.derivatives[i] = scale * derivative;
  }
  return out;
}

/// Returns (I(to) - I(from)) / (to - from) for a piece's Lagrange functions. To avoid cancellation, the divided
/// differences [.] of the factors are combined by [fg] = [f] g(to) + f(from) [g].
template <typename S>
std::array<S, kMostNodes> lagrange_differences(const SlidePiece& piece, double from, const S& to) {
  assert(piece.node_count >= 2 && piece.node_count <= kMostNodes && piece.length() > 0);
  std::array<S, kMostNodes> out;
  const double scale = 2 / piece.length();
  const double xi_from = scale * (from - piece.begin) - 1;
  const S xi_to = scale * (to - piece.begin) - S(1);
  const PieceNodes& nodes = kPieceNodes[piece.node_count];
  for (int i = 0; i < piece.node_count; ++i) {
    double at_from = 1;
    S difference(0);
    for (int k = 0; k < piece.node_count; ++k) {
      if (k == i) continue;
      const double node = nodes.coordinates[k], slope = nodes.reciprocal_distances[i][k];
      difference = difference * (slope * (xi_to - node)) + at_from * slope;
      at_from *= slope * (xi_from - node);
    }
    out[i] = scale * difference;
  }
  return out;
}

/// A cubic polynomial over a piece that is 0 at both ends, with the slopes 1 at one end and 0 at the other.
struct Hermite {
  double begin, length;
  bool at_end;
  template <typename S>
  S value(const S& arc_length) const {
    const S xi = (arc_length - begin) / length;
    return at_end ? length * xi * xi * (xi - 1.0) : length * xi * (1.0 - xi) * (1.0 - xi);
  }
  template <typename S>
  S slope(const S& arc_length) const {
    const S xi = (arc_length - begin) / length;
    return at_end ? xi * (3.0 * xi - 2.0) : (1.0 - xi) * (1.0 - 3.0 * xi);
  }
  /// Returns (H(to) - H(from)) / (to - from) without cancellation.
  template <typename S>
  S difference(double from, const S& to) const {
    const double s = (from - begin) / length;
    const S t = (to - begin) / length;
    const S cubic = s * s + s * t + t * t, square = s + t;
    return at_end ? cubic - square : 1.0 - 2.0 * square + cubic;
  }
};

/// Calls visit(neighbour's index, arc length of the border, share, Hermite) for each border of a piece where a smooth
/// line differs from the elements. The tangent of the line there is the piece's tangent + share (the neighbour's - the
/// piece's). The share depends on the lengths of both pieces, such that both sides have the same tangent.
template <class Visit>
void for_each_smoothed_border(const SlideLine& line, int index, const Visit& visit) {
  assert(index >= 0 && index < static_cast<int>(line.pieces.size()));
  if (!line.smooth) return;
  const SlidePiece& piece = line.pieces[index];
  for (const bool at_end : {false, true}) {
    const int neighbour = at_end ? index + 1 : index - 1;
    if (neighbour < 0 || neighbour >= static_cast<int>(line.pieces.size())) continue;
    const double share = piece.length() / (piece.length() + line.pieces[neighbour].length());
    visit(neighbour, at_end ? piece.end : piece.begin, share, Hermite{piece.begin, piece.length(), at_end});
  }
}

/// Adds the smoothing of a piece to `weights`: the jumps of the tangents at its borders, times factors.
/// `factors(hermite)` returns the pair of factors for the values and the derivatives.
template <typename S, class Factors>
void add_smoothing(const SlideLine& line, int index, const Factors& factors, LineWeights<S>& weights) {
  for_each_smoothed_border(line, index, [&](int neighbour, double border, double share, const Hermite& hermite) {
    const auto [value, derivative] = factors(hermite);
    for (const auto& [piece, sign] : {std::pair{neighbour, share}, std::pair{index, -share}}) {
      const LagrangeWeights<double> jump = lagrange_weights(line.pieces[piece], border);
      for (int i = 0; i < jump.count; ++i) {
        weights.values[jump.first + i - weights.first] += sign * jump.derivatives[i] * value;
        weights.derivatives[jump.first + i - weights.first] += sign * jump.derivatives[i] * derivative;
      }
    }
  });
}

template <typename S>
LineWeights<S> empty_weights(const SlideLine& line, int index) {
  const NodeRange support = line.support(index, index);
  LineWeights<S> out;
  out.first = support.first;
  out.count = support.end - support.first;
  out.values.fill(S(0));
  assert(out.count <= kMostWeights);
  out.derivatives.fill(S(0));
  return out;
}

/// Returns the weights of the line's nodes at an arc length in the piece `index`.
template <typename S>
LineWeights<S> line_weights(const SlideLine& line, int index, const S& arc_length) {
  LineWeights<S> out = empty_weights<S>(line, index);
  const LagrangeWeights<S> plain = lagrange_weights(line.pieces[index], arc_length);
  for (int i = 0; i < plain.count; ++i) {
    out.values[plain.first + i - out.first] = plain.values[i];
    out.derivatives[plain.first + i - out.first] = plain.derivatives[i];
  }
  add_smoothing(
      line, index,
      [&](const Hermite& hermite) { return std::pair<S, S>(hermite.value(arc_length), hermite.slope(arc_length)); },
      out);
  return out;
}

/// Returns the divided differences of line_weights() between two arc lengths in the piece `index`, as `values`.
template <typename S>
LineWeights<S> line_differences(const SlideLine& line, int index, double from, const S& to) {
  LineWeights<S> out = empty_weights<S>(line, index);
  const SlidePiece& piece = line.pieces[index];
  const std::array<S, kMostNodes> plain = lagrange_differences(piece, from, to);
  for (int i = 0; i < piece.node_count; ++i) out.values[piece.first_node + i - out.first] = plain[i];
  add_smoothing(
      line, index, [&](const Hermite& hermite) { return std::pair<S, S>(hermite.difference(from, to), S(0)); }, out);
  return out;
}

/// Rotation and spatial curvature of a section.
template <typename S>
struct Frame {
  Matrix3T<S> rotation;
  Vector3T<S> spatial_curvature;
};
/// Local rotations of a piece's nodes, from which all its frames are interpolated.
template <typename S>
struct PieceRotations {
  Matrix3T<S> reference;
  std::array<Vector3T<S>, kMostNodes> vectors;
};
template <typename S, class Poses>
PieceRotations<S> piece_rotations(const SlidePiece& piece, const Poses& poses) {
  PieceRotations<S> out;
  with_node_count(piece.node_count, [&](auto count) {
    constexpr int N = decltype(count)::value;
    std::array<QuaternionT<S>, N> orientation;
    for (int i = 0; i < N; ++i) orientation[i] = poses(piece.first_node + i).orientation;
    const LocalRotations<N, S> local(orientation);
    for (int i = 0; i < N; ++i) out.vectors[i] = local.rotation_vectors()[i];
    out.reference = local.reference_rotation();
  });
  return out;
}

template <typename S>
Frame<S> element_frame(const SlidePiece& piece, const S& arc_length, const PieceRotations<S>& rotations) {
  const LagrangeWeights<S> w = lagrange_weights(piece, arc_length);
  Vector3T<S> theta = Vector3T<S>::Zero(), slope = Vector3T<S>::Zero();
  for (int i = 0; i < w.count; ++i) {
    theta += w.values[i] * rotations.vectors[i];
    slope += w.derivatives[i] * rotations.vectors[i];
  }
  const so3::ExponentialMap<S> map(theta);
  // The local rotation vectors have world axes, so T theta' is the spin per arc length in world axes.
  return {map.rotation() * rotations.reference, map.tangent() * slope};
}

/// Data from which all frames of a line in one piece are computed: the piece's local rotations, and for each smoothed
/// border share * jump of k, in the order of for_each_smoothed_border().
template <typename S>
struct PieceFrames {
  PieceRotations<S> rotations;
  std::array<Vector3T<S>, 2> jumps;
};
template <typename S, class Poses>
PieceFrames<S> piece_frames(const SlideLine& line, int index, const Poses& poses) {
  PieceFrames<S> out;
  out.rotations = piece_rotations<S>(line.pieces[index], poses);
  int count = 0;
  for_each_smoothed_border(line, index, [&](int neighbour, double border, double share, const Hermite&) {
    const SlidePiece& other = line.pieces[neighbour];
    out.jumps[count++] =
        S(share) * (element_frame(other, S(border), piece_rotations<S>(other, poses)).spatial_curvature -
                    element_frame(line.pieces[index], S(border), out.rotations).spatial_curvature);
  });
  return out;
}

/// Returns the rotation vector that smooths a frame, psi = sum H (jump of k), and its derivative with respect to the
/// arc length.
template <typename S>
std::pair<Vector3T<S>, Vector3T<S>> frame_smoothing(const SlideLine& line, int index, const S& arc_length,
                                                    const std::array<Vector3T<S>, 2>& jumps) {
  Vector3T<S> turn = Vector3T<S>::Zero(), slope = Vector3T<S>::Zero();
  int count = 0;
  for_each_smoothed_border(line, index, [&](int, double, double, const Hermite& hermite) {
    const Vector3T<S>& jump = jumps[count++];
    turn += hermite.value(arc_length) * jump;
    slope += hermite.slope(arc_length) * jump;
  });
  return {turn, slope};
}

}  // namespace slide

/// Returns rotation and curvature of the line at an arc length in the piece `index`.
template <typename S>
slide::Frame<S> frame_at(const SlideLine& line, int index, const S& arc_length, const slide::PieceFrames<S>& frames) {
  slide::Frame<S> frame = slide::element_frame(line.pieces[index], arc_length, frames.rotations);
  if (!line.smooth) return frame;
  const auto [turn, slope] = slide::frame_smoothing(line, index, arc_length, frames.jumps);
  const so3::ExponentialMap<S> map(turn);
  const Matrix3T<S> rotation = map.rotation();
  frame.rotation = (rotation * frame.rotation).eval();
  frame.spatial_curvature = (map.tangent() * slope + rotation * frame.spatial_curvature).eval();
  return frame;
}
/// The same from `poses(i)`: PoseT<S> of the line's node i.
template <typename S, class Poses>
slide::Frame<S> frame_at(const SlideLine& line, int index, const S& arc_length, const Poses& poses) {
  return frame_at(line, index, arc_length, slide::piece_frames<S>(line, index, poses));
}

namespace slide {

/// A section at one arc length of its line in one configuration: data for its pose and for the maps of a step.
struct Place {
  int piece = 0;                ///< index in the line's pieces
  PieceFrames<double> frames;   ///< of the piece, in world axes
  LineWeights<double> weights;  ///< of the line's nodes at the arc length [-]; derivatives [1/m]
  Frame<double> frame;          ///< rotation from section to world axes; curvature in world axes [1/m]
};

}  // namespace slide

/// Returns the section at an arc length in the piece `index`. `poses(i)`: PoseT<S> of the line's node i.
template <typename S, class Poses>
Section<S> section_at(const SlideLine& line, int index, const S& arc_length, const Poses& poses) {
  const slide::Frame<S> frame = frame_at(line, index, arc_length, poses);
  Section<S> out{Vector3T<S>::Zero(), Vector3T<S>::Zero(), frame.rotation, frame.spatial_curvature};
  const slide::LineWeights<S> w = slide::line_weights(line, index, arc_length);
  for (int i = 0; i < w.count; ++i) {
    const PoseT<S> pose = poses(w.first + i);
    out.position += w.values[i] * pose.position;
    out.tangent += w.derivatives[i] * pose.position;
  }
  return out;
}

}  // namespace flexarm
