// Computes the incremental maps of a slider over a step, and their derivatives. (joints.md 4.3 to 4.5)
#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "joints/slide_rotation.h"
#include "joints/slide_step.h"
#include "math/so3.h"

namespace flexarm {
namespace {

using slide::Complex;
using slide::RotationSplit;

/// Travels Delta X below this, relative to the element's length, are short: the rotation over Delta X is computed from
/// the curvature in the middle of the travel, with an error of second order. The curvature jumps at borders of
/// elements, so there this is done only for travels where division by Delta X would fail.
constexpr double kShort = 1e-5, kShortOverBorder = 1e-9;
/// If the nodes' rotation increments differ by less than this (sum of squares), no moment is redistributed [rad^2].
constexpr double kUniform = 1e-24;
/// Largest number of nodes that take part in a step (active nodes).
constexpr int kMostActive = (SlideLine::kMostPieces + 2) * slide::kMostNodes;

/// Weights of the active nodes. The first active node is the line's node `first`.
template <typename S>
using ActiveWeights = std::array<S, kMostActive>;

template <typename S, typename T, typename F>
void add_weights(const slide::LineWeights<T>& weights, const F& factor, int first, ActiveWeights<S>& sum) {
  assert(weights.first >= first);
  assert(weights.first + weights.count - first <= kMostActive && "a longer way is taken in shorter steps");
  for (int i = 0; i < weights.count; ++i) sum[weights.first + i - first] += factor * weights.values[i];
}

ActiveWeights<double> active_weights(const slide::Place& place, int first) {
  ActiveWeights<double> out{};
  add_weights(place.weights, 1.0, first, out);
  return out;
}

/// Returns the divided differences D of the nodes' weights between two arc lengths, which may lie in different pieces.
template <typename S>
ActiveWeights<S> divided_difference(const SlideLine& line, int piece_from, double from, int piece_to, const S& to,
                                    int first) {
  ActiveWeights<S> out{};
  if (piece_from == piece_to) {
    add_weights(slide::line_differences(line, piece_to, from, to), 1.0, first, out);
    return out;
  }
  // Split the travel at the borders where it leaves the first piece and enters the last one. No part has cancellation.
  const SlidePiece &p = line.pieces[piece_from], &q = line.pieces[piece_to];
  const bool forward = piece_to > piece_from;
  const double leave = forward ? p.end : p.begin, enter = forward ? q.begin : q.end;
  const S change = to - from;
  add_weights(slide::line_differences(line, piece_from, from, leave), S((leave - from) / change), first, out);
  add_weights(slide::line_differences(line, piece_to, enter, to), S((to - enter) / change), first, out);
  out[(forward ? p.end_node() - 1 : p.first_node) - first] -= S(1) / change;
  out[(forward ? q.first_node : q.end_node() - 1) - first] += S(1) / change;
  return out;
}

/// Computes the maps of one step: first the rows, then their derivatives.
class IncrementalMaps {
 public:
  IncrementalMaps(const SlideTravel& travel, const Vector6& g, SlideMaps& maps, bool with_tangent)
      : travel_(travel),
        line_(travel.line),
        begin_{travel.line, travel.begin},
        end_{travel.line, travel.end},
        places_(travel),
        piece_from_(places_.begin().piece),
        piece_to_(places_.end().piece),
        begin_frames_to_(frames_of(piece_to_, begin_, places_.begin())),
        end_frames_from_(frames_of(piece_from_, end_, places_.end())),
        change_(travel.to - travel.from),
        rule_(slide::contact_rule(travel.step(), travel.arm_weight)),
        force_(g.head<3>()),
        moment_(g.tail<3>()),
        maps_(maps),
        begin_weights_(active_weights(places_.begin(), first_active())),
        end_weights_(active_weights(places_.end(), first_active())),
        differences_(divided_difference(line_, piece_from_, travel.from, piece_to_, travel.to, first_active())) {
    slide::set_active(line_, piece_from_, piece_to_, with_tangent, maps);
    if (with_tangent) set_variations();
    set_rows();
    if (!with_tangent) return;
    set_columns();
    set_node_derivatives();
    set_arc_length_derivatives();
  }

 private:
  /// Returns the frames of a piece in the configuration `nodes`, reusing those of `place` if it is in this piece.
  slide::PieceFrames<double> frames_of(int piece, const slide::LineNodes& nodes, const slide::Place& place) const {
    return piece == place.piece ? place.frames : slide::piece_frames<double>(line_, piece, nodes);
  }
  void set_variations() {
    const slide::BorderVariations borders(line_, piece_from_, end_);
    from_.emplace(line_, piece_from_, travel_.from, end_, end_frames_from_, borders);
    if (piece_to_ == piece_from_)
      to_.emplace(line_, piece_to_, travel_.to, end_, places_.end().frames, borders);
    else
      to_.emplace(line_, piece_to_, travel_.to, end_, places_.end().frames,
                  slide::BorderVariations(line_, piece_to_, end_));
  }
  double contact(int j) const { return (1 - rule_.weight) * begin_weights_[j] + rule_.weight * end_weights_[j]; }

  int first_active() const {
    return line_.support(std::min(piece_from_, piece_to_), std::max(piece_from_, piece_to_)).first;
  }
  bool is_short() const {
    const double limit = piece_from_ == piece_to_ ? kShort : kShortOverBorder;
    return std::abs(change_) < limit * line_.pieces[piece_from_].length();
  }
  double middle() const { return 0.5 * (travel_.from + travel_.to); }

  RotationSplit split_rotation() const {
    const slide::Frame<double>&at_00 = places_.begin().frame, &at_11 = places_.end().frame;
    const slide::Frame<double> at_10 = frame_at(line_, piece_to_, travel_.to, begin_frames_to_);
    const Matrix3 at_01 =
        from_ ? from_->rotation : frame_at(line_, piece_from_, travel_.from, end_frames_from_).rotation;
    const slide::TravelledFrames frames{
        at_00.rotation, at_01, at_10.rotation, at_11.rotation, at_10.spatial_curvature, at_11.spatial_curvature};
    if (!is_short()) return {frames, rule_.weight, change_, false, Vector3::Zero(), Vector3::Zero()};
    const int piece = line_.piece_at(middle());
    return {frames,
            rule_.weight,
            change_,
            true,
            frame_at(line_, piece, middle(), begin_).spatial_curvature,
            frame_at(line_, piece, middle(), end_).spatial_curvature};
  }

  void set_rows() {
    const double c = rule_.weight;
    Vector3 travel = Vector3::Zero();
    mean_rotation_.setZero();
    for (int j = 0; j < maps_.count; ++j) {
      const PoseT<double> begin = begin_(maps_.first + j), end = end_(maps_.first + j);
      rotations_[j] = cayley::increment(begin.orientation, end.orientation);
      displacements_[j] = end.position - begin.position;
      travel += differences_[j] * (c * begin.position + (1 - c) * end.position);
      defect_ += rule_.arm_product * differences_[j] * displacements_[j];
      interpolated_ += contact(j) * rotations_[j];
      mean_rotation_ += rotations_[j] / maps_.count;
    }
    travel -= interpolated_.cross(defect_);
    const RotationSplit& rotation = split_.emplace(split_rotation());
    for (int j = 0; j < maps_.count; ++j) spread_ += (rotations_[j] - mean_rotation_).squaredNorm();
    Vector3 redistribution = Vector3::Zero();
    if (spread_ > kUniform) redistribution = (rotation.fixed() - interpolated_) / spread_;
    share_ = redistribution.dot(moment_);
    maps_.released_left << travel, rotation.along();
    const Matrix3 arm = so3::hat(Vector3(change_ * defect_));
    for (int j = 0; j < maps_.count; ++j) {  // moment row: weight (m + arm x f) + (redistribution.m) (w_j - mean)
      maps_.left[j].diagonal().setConstant(contact(j));
      maps_.left[j].topRightCorner<3, 3>() = -contact(j) * arm;
      maps_.left[j].bottomRightCorner<3, 3>() += redistribution * (rotations_[j] - mean_rotation_).transpose();
    }
  }

  /// Sets the columns of the slave at the end of the step: dr = I^j dr_j + r' dX, spin = I_g^j spin_j + k dX. If the
  /// contact holds in the middle of the step, dr = d(2 I^j_c r_{j,1/2}).
  void set_columns() {
    const slide::LineWeights<double>& w = places_.end().weights;
    const double c = rule_.weight;
    Vector3 tangent = Vector3::Zero();
    for (int j = 0; j < maps_.count; ++j)
      maps_.right[j].topLeftCorner<3, 3>().diagonal().setConstant(rule_.is_in_middle ? contact(j) : end_weights_[j]);
    for (int i = 0; i < w.count; ++i) {
      const int j = w.first + i - maps_.first;
      maps_.right[j].bottomRightCorner<3, 3>() = to_->values[i];
      const Vector3 end = end_(w.first + i).position;
      tangent += w.derivatives[i] * (rule_.is_in_middle ? Vector3(c * (2 * end - displacements_[j])) : end);
      slopes_[j] = c * w.derivatives[i];
    }
    maps_.released_right << tangent, to_->spatial_curvature;
  }

  /// Adds a gradient with respect to the spins of the frames as rows with respect to the nodes' spins.
  void add_frames(const RotationSplit::Gradient& gradient, std::array<Vector3, kMostActive>& rows) const {
    for (int i = 0; i < from_->count; ++i)
      rows[from_->first + i - maps_.first] += from_->values[i].transpose() * gradient.at_01;
    for (int i = 0; i < to_->count; ++i)
      rows[to_->first + i - maps_.first] += to_->values[i].transpose() * gradient.at_11;
  }

  void set_node_derivatives() {
    const double c = rule_.weight;
    std::array<Vector3, kMostActive> turn, shared;
    std::fill_n(turn.begin(), maps_.count, Vector3::Zero());
    std::fill_n(shared.begin(), maps_.count, Vector3::Zero());
    slope_begin_.setZero();
    slope_end_.setZero();
    std::optional<FrameVariation> middle_frame;
    if (is_short()) {
      const int piece = line_.piece_at(middle());
      middle_frame.emplace(line_, piece, middle(), end_);
      const Complex at(middle(), 0.5 * slide::kComplexStep);
      const auto slope = [&](const std::vector<NodePose>& nodes) {
        return Vector3(frame_at(line_, piece, at, slide::ComplexLineNodes{line_, nodes}).spatial_curvature.imag() /
                       slide::kComplexStep);
      };
      slope_begin_ = slope(travel_.begin);
      slope_end_ = slope(travel_.end);
    }
    along_ = split_->of_along(moment_, slope_begin_, slope_end_);
    add_frames(along_, turn);
    if (middle_frame) {
      const Vector3 lever = middle_frame->spatial_curvature.cross(along_.curvature);
      for (int i = 0; i < middle_frame->count; ++i)
        turn[middle_frame->first + i - maps_.first] +=
            middle_frame->derivatives[i].transpose() * along_.curvature + middle_frame->values[i].transpose() * lever;
    }
    const bool redistributes = spread_ > kUniform;
    if (redistributes) {
      fixed_ = split_->of_fixed(moment_);
      add_frames(fixed_, shared);
    }
    const Vector3 lever = defect_.cross(force_), turned = force_.cross(interpolated_);
    for (int k = 0; k < maps_.count; ++k) {
      const Matrix3 inverse = cayley::inverse_tangent(rotations_[k]);
      const double D = differences_[k];
      maps_.released_master[k] << (1 - c) * D * force_ - rule_.arm_product * D * turned,
          turn[k] - contact(k) * (inverse.transpose() * lever);
      const Matrix3 moved = -rule_.arm_product * change_ * D * so3::hat(force_);
      Vector3 row = Vector3::Zero();
      if (redistributes)
        row = (shared[k] -
               inverse.transpose() * Vector3(contact(k) * moment_ + 2 * share_ * (rotations_[k] - mean_rotation_))) /
              spread_;
      for (int j = 0; j < maps_.count; ++j) {
        auto& block = maps_.moment_master[j * maps_.count + k];
        block.leftCols<3>() = contact(j) * moved;
        if (redistributes)
          block.rightCols<3>() =
              (rotations_[j] - mean_rotation_) * row.transpose() + share_ * ((j == k) - 1.0 / maps_.count) * inverse;
        else
          block.rightCols<3>().setZero();
      }
    }
  }

  void set_arc_length_derivatives() {
    const double c = rule_.weight;
    const ActiveWeights<Complex> moved = divided_difference(line_, piece_from_, travel_.from, piece_to_,
                                                            Complex(travel_.to, slide::kComplexStep), maps_.first);
    Vector3 travel = Vector3::Zero(), interpolated = Vector3::Zero(), defect = Vector3::Zero();
    for (int j = 0; j < maps_.count; ++j) {
      const double D = moved[j].imag() / slide::kComplexStep;
      travel += D * (end_(maps_.first + j).position - c * displacements_[j]);
      interpolated += slopes_[j] * rotations_[j];
      defect += rule_.arm_product * D * displacements_[j];
    }
    travel -= interpolated.cross(defect_) + interpolated_.cross(defect);
    maps_.released_released = travel.dot(force_) + along_.arc_length;
    const Vector3 turned = moment_ + change_ * defect_.cross(force_),
                  change = (change_ * defect + defect_).cross(force_);
    const double share = spread_ > kUniform ? (fixed_.arc_length - interpolated.dot(moment_)) / spread_ : 0.0;
    for (int j = 0; j < maps_.count; ++j)
      maps_.master_released[j] << slopes_[j] * force_,
          slopes_[j] * turned + contact(j) * change + share * (rotations_[j] - mean_rotation_);
  }

  const SlideTravel& travel_;
  const SlideLine& line_;
  slide::LineNodes begin_, end_;
  slide::TravelPlaces places_;  // travel.from at the beginning, travel.to at the end
  int piece_from_, piece_to_;
  slide::PieceFrames<double> begin_frames_to_, end_frames_from_;
  double change_;  // Delta X
  slide::ContactRule rule_;
  Vector3 force_, moment_;
  SlideMaps& maps_;
  ActiveWeights<double> begin_weights_, end_weights_, differences_;  // I_n, I_{n+1}, D
  std::optional<FrameVariation> from_, to_;  // of the frames at travel.from and travel.to, both at the end
  std::optional<RotationSplit> split_;
  RotationSplit::Gradient along_, fixed_;
  Vector3 slope_begin_, slope_end_;
  std::array<Vector3, kMostActive> rotations_, displacements_;  // increments of the active nodes
  std::array<double, kMostActive> slopes_{};                    // d(contact(j))/dX
  // defect_: e / Delta X (joints.md 4.5). interpolated_: sum of I_c^j w_j over the active nodes, with their rotation
  // increments w_j. mean_rotation_: mean of w_j.
  Vector3 defect_ = Vector3::Zero(), interpolated_ = Vector3::Zero(), mean_rotation_;
  // spread_: sum of the squares of w_j - mean. share_: the moment of node j gets share_ (w_j - mean) by redistribution.
  double spread_ = 0, share_ = 0;
};

}  // namespace

void slide_incremental_maps(const SlideTravel& travel, const Vector6& g, SlideMaps& maps, bool with_tangent) {
  assert(travel.begin.size() == travel.end.size());
  IncrementalMaps(travel, g, maps, with_tangent);
}

}  // namespace flexarm
