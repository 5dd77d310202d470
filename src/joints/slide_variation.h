#pragma once
/// The variation of a section's frame on a slide line with the spins of the line's nodes.

#include "joints/slide_section.h"

namespace flexarm {

namespace slide {

/// The variation by a piece's own interpolation, without smoothing; see FrameVariation.
struct ElementVariation {
  int first = 0, count = 0;
  std::array<Matrix3, kMostNodes> values, derivatives;
  Matrix3 rotation;
  Vector3 spatial_curvature;
};

template <class Poses>
ElementVariation element_variation(const SlidePiece& piece, double arc_length, const Poses& poses) {
  const LagrangeWeights<double> w = lagrange_weights(piece, arc_length);
  ElementVariation out;
  out.first = w.first;
  out.count = w.count;
  with_node_count(piece.node_count, [&](auto number) {
    constexpr int N = decltype(number)::value;
    std::array<Quaternion, N> orientation;
    NodalValues<N> values, derivatives;
    for (int i = 0; i < N; ++i) {
      orientation[i] = poses(piece.first_node + i).orientation;
      values[i] = w.values[i];
      derivatives[i] = w.derivatives[i];
    }
    GeneralisedShapeFunctions<N> functions;
    const InterpolatedRotation<double> section =
        LocalRotationVariation<N>(LocalRotations<N>(orientation)).evaluate(values, derivatives, functions);
    out.rotation = section.rotation;
    out.spatial_curvature = section.rotation * section.curvature;
    for (int i = 0; i < N; ++i) {
      out.values[i] = functions.values[i];
      out.derivatives[i] = functions.derivatives[i];
    }
  });
  return out;
}

/// The element variations on both sides of a piece's smoothed borders, in the order of for_each_smoothed_border(). All
/// frame variations in the piece need them.
struct BorderVariations {
  template <class Poses>
  BorderVariations(const SlideLine& line, int index, const Poses& poses) {
    int border = 0;
    for_each_smoothed_border(line, index, [&](int neighbour, double at, double, const Hermite&) {
      own[border] = element_variation(line.pieces[index], at, poses);
      others[border++] = element_variation(line.pieces[neighbour], at, poses);
    });
  }

  std::array<ElementVariation, 2> own, others;
};

}  // namespace slide

/// The variation of a section's frame: spin of the section = sum_i values[i] spin_{first + i}, with the spins of the
/// line's nodes. The derivatives are d(values)/dX, so that the spatial curvature varies by
/// d(k) = sum_i derivatives[i] spin_{first + i} + spin x k. The values sum to I, the derivatives to 0.
struct FrameVariation {
  template <class Poses>
  FrameVariation(const SlideLine& line, int index, double arc_length, const Poses& poses)
      : FrameVariation(line, index, arc_length, poses, slide::piece_frames<double>(line, index, poses),
                       slide::BorderVariations(line, index, poses)) {}

  template <class Poses>
  FrameVariation(const SlideLine& line, int index, double arc_length, const Poses& poses,
                 const slide::PieceFrames<double>& frames, const slide::BorderVariations& borders) {
    const NodeRange support = line.support(index, index);
    first = support.first;
    count = support.end - support.first;
    for (int i = 0; i < count; ++i) values[i].setZero(), derivatives[i].setZero();
    const slide::ElementVariation plain = slide::element_variation(line.pieces[index], arc_length, poses);
    rotation = plain.rotation;
    spatial_curvature = plain.spatial_curvature;
    if (!line.smooth) {
      add(plain, Matrix3::Identity(), Matrix3::Zero());
      return;
    }
    const auto [turn, slope] = slide::frame_smoothing(line, index, arc_length, frames.jumps);
    const so3::ExponentialMap<double> map(turn);
    const Matrix3 tangent = map.tangent(), turned = map.rotation(), tangent_derivative = map.tangent_derivative(slope);
    const Vector3 slope_spin = tangent * slope;
    add(plain, turned, so3::hat(slope_spin) * turned);
    rotation = turned * plain.rotation;
    spatial_curvature = slope_spin + turned * plain.spatial_curvature;
    int border = 0;
    slide::for_each_smoothed_border(
        line, index, [&](int neighbour, double, double share, const slide::Hermite& hermite) {
          const double value = hermite.value(arc_length), derivative = hermite.slope(arc_length);
          // d(jump of k) = sum of (neighbour's I_g' - own I_g') spin + spin of the border's node x (jump of k).
          const Matrix3 left = value * tangent, left_derivative = value * tangent_derivative + derivative * tangent;
          const auto add_side = [&](int piece, double sign, const slide::ElementVariation& at) {
            // The node of this piece at the border; beams that are welded together have one each.
            const SlidePiece& side = line.pieces[piece];
            const int node = (piece == std::max(index, neighbour) ? side.first_node : side.end_node() - 1) - first;
            const Matrix3 spun = sign * so3::hat(at.spatial_curvature);
            values[node] -= left * spun;
            derivatives[node] -= left_derivative * spun;
            for (int i = 0; i < at.count; ++i) {
              values[at.first + i - first] += sign * left * at.derivatives[i];
              derivatives[at.first + i - first] += sign * left_derivative * at.derivatives[i];
            }
          };
          add_side(neighbour, share, borders.others[border]);
          add_side(index, -share, borders.own[border++]);
        });
  }

  int first = 0, count = 0;
  std::array<Matrix3, slide::kMostWeights> values, derivatives;
  Matrix3 rotation;
  Vector3 spatial_curvature;

 private:
  void add(const slide::ElementVariation& plain, const Matrix3& rotation, const Matrix3& rotation_derivative) {
    for (int i = 0; i < plain.count; ++i) {
      values[plain.first + i - first] = rotation * plain.values[i];
      derivatives[plain.first + i - first] = rotation_derivative * plain.values[i] + rotation * plain.derivatives[i];
    }
  }
};

}  // namespace flexarm
