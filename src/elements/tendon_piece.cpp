#include "elements/tendon_piece.h"

#include "elements/tendon_geometry.h"

namespace flexarm {

double nearest_turn(double angle, double reference) {
  return angle + 2 * kPi * std::round((reference - angle) / (2 * kPi));
}

PieceState TendonPiece::find(const PiecePoses& poses, const PieceState& near) const {
  const PieceEnd guides{tendon::frame_of(first_, poses.first), tendon::frame_of(second_, poses.second), {}};
  const tendon::Angles rough = tendon::rough_tangents(first_, second_, guides.first, guides.second);
  return state_at(guides, rough.begin, rough.end, near);
}

PieceEnd TendonPiece::place(const PiecePoses& poses, const PieceState& near) const {
  PieceEnd out{tendon::frame_of(first_, poses.first), tendon::frame_of(second_, poses.second), {}};
  out.state = state_at(out, near.begin, near.end, near);
  if (!std::isfinite(out.state.length)) out.state = find(poses, near);
  return out;
}

PieceState TendonPiece::state_at(const PieceEnd& guides, double begin, double end, const PieceState& near) const {
  const auto [angles, way] = tendon::tangents_near(first_, second_, guides.first, guides.second, {begin, end});
  return {tendon::length_of(way), nearest_turn(angles.begin, near.begin), nearest_turn(angles.end, near.end)};
}

Vector12 TendonPiece::gradient(const PiecePoses& poses, const PieceState& here, const PieceWeights& weights) const {
  const tendon::GuideFrame<double> from = tendon::frame_of(first_, poses.first),
                                   to = tendon::frame_of(second_, poses.second);
  return tendon::vector_gradient<double>(first_, second_, from, to, weights, {here.begin, here.end}).on_nodes(from, to);
}

}  // namespace flexarm
