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
  const tendon::Chord<double> chord = tendon::tangents_near(first_, second_, guides.first, guides.second, {begin, end});
  return {tendon::length_of(chord.way), nearest_turn(chord.begin, near.begin), nearest_turn(chord.end, near.end)};
}

Vector12 TendonPiece::gradient(const PiecePoses& poses, const PieceState& here, const PieceWeights& weights) const {
  const tendon::GuideFrame<double> from = tendon::frame_of(first_, poses.first),
                                   to = tendon::frame_of(second_, poses.second);
  const tendon::Chord<double> chord(first_, second_, from, to, here.begin, here.end);
  return tendon::vector_gradient(first_, second_, weights, chord).on_nodes(from, to);
}

}  // namespace flexarm
