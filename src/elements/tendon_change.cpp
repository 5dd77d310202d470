// The change of a piece of a line over a step.
#include <type_traits>

#include "elements/tendon_geometry.h"
#include "elements/tendon_piece.h"

namespace flexarm {
namespace tendon {
namespace {

/// If a step changes a piece's scalar products by less than this part of their size, the mean gradient gives the change
/// of a functional to round-off: its error is of third order.
constexpr double kTiny = 1e-5;

/// Adds to `direction` what makes its product with the motion equal to the change of the functional (Gonzalez 1996). It
/// acts along the gradients of those scalar products of the vectors of both guides of which the functional consists.
template <class S>
class Correction {
 public:
  using V = Eigen::Matrix<S, 3, 1>;
  Correction(const GuidePlace& a, const GuidePlace& b, const GuideFrame<double>& begin_a, const GuideFrame<S>& end_a,
             const GuideFrame<double>& begin_b, const GuideFrame<S>& end_b)
      : mean_a_(mixed(begin_a, end_a, 0.5)), mean_b_(mixed(begin_b, end_b, 0.5)) {
    for (int i = 0; i < 12; ++i) sum_[i] = S(0);
    const Vector3 begin_way = begin_b.centre - begin_a.centre;
    const V end_way = end_b.centre - end_a.centre;
    size_ = begin_way.squaredNorm();
    if (a.is_circle()) add_way(0, in_axes(end_a, end_way), in_axes(begin_a, begin_way), mean_a_);
    if (b.is_circle()) add_way(1, in_axes(end_b, end_way), in_axes(begin_b, begin_way), mean_b_);
    if (!a.is_circle() || !b.is_circle()) return;
    const double scale = a.radius * b.radius;
    add_axis(scale, in_axes(end_a, end_b.first), in_axes(begin_a, begin_b.first), mean_b_.first);
    add_axis(scale, in_axes(end_a, end_b.second), in_axes(begin_a, begin_b.second), mean_b_.second);
    add_axis(scale, in_axes(end_a, end_b.normal), in_axes(begin_a, begin_b.normal), mean_b_.normal);
  }
  bool is_tiny() const { return !(value_of(squares_) > kTiny * kTiny * size_); }
  Eigen::Matrix<S, 12, 1> of(const S& missing) const {
    Eigen::Matrix<S, 12, 1> out;
    for (int i = 0; i < 12; ++i) out[i] = missing / squares_ * sum_[i];
    return out;
  }

 private:
  template <class T>
  static Eigen::Matrix<T, 3, 1> in_axes(const GuideFrame<T>& frame, const Eigen::Matrix<T, 3, 1>& v) {
    return {dot(frame.first, v), dot(frame.second, v), dot(frame.normal, v)};
  }
  /// The sum of the axes of a frame, times the changes of scalar products with them.
  V summed(const GuideFrame<S>& frame, const S& factor, const V& end, const Vector3& begin) {
    V change, out;
    for (int i = 0; i < 3; ++i) change[i] = factor * (end[i] - begin[i]);
    squares_ += dot(change, change);
    for (int i = 0; i < 3; ++i)
      out[i] = change[0] * frame.first[i] + change[1] * frame.second[i] + change[2] * frame.normal[i];
    return out;
  }
  /// Scalar products of the vector between the centres with the axes of a guide.
  void add_way(int body, const V& end, const Vector3& begin, const GuideFrame<S>& frame) {
    const V force = summed(frame, S(1), end, begin), way = mean_b_.centre - mean_a_.centre;
    const V moment_a = cross(mean_a_.arm, force), moment_b = cross(mean_b_.arm, force), moment = cross(force, way);
    for (int i = 0; i < 3; ++i) {
      sum_[i] -= force[i];
      sum_[3 + i] -= moment_a[i];
      sum_[6 + i] += force[i];
      sum_[9 + i] += moment_b[i];
      sum_[6 * body + 3 + i] += moment[i];
    }
  }
  /// Scalar products of the axes of the first guide with an axis of the second one.
  void add_axis(double scale, const V& end, const Vector3& begin, const V& axis) {
    const V moment = cross(summed(mean_a_, S(scale), end, begin), axis);
    for (int i = 0; i < 3; ++i) {
      sum_[3 + i] += scale * moment[i];
      sum_[9 + i] -= scale * moment[i];
    }
  }

  GuideFrame<S> mean_a_, mean_b_;
  Eigen::Matrix<S, 12, 1> sum_;
  S squares_{0};
  double size_ = 0;
};

template <class S>
struct Change {
  Eigen::Matrix<S, 12, 1> direction;
  S end;
};

template <class S>
Change<S> change_of(const GuidePlace& a, const GuidePlace& b, const GuideFrame<double>& begin_a,
                    const GuideFrame<S>& end_a, const GuideFrame<double>& begin_b, const GuideFrame<S>& end_b,
                    const PieceState& before, const PieceState& after, const PieceWeights& weights, bool at_end) {
  Change<S> out;
  const Angles begin{before.begin, before.end}, end{after.begin, after.end};
  if constexpr (std::is_same_v<S, double>)
    out.end = after.value(weights);
  else
    out.end = functional(a, b, weights, with_derivatives(a, b, end_a, end_b, end));
  const double weight = at_end ? 1 : 0.5;
  const GuideFrame<S> mean_a = mixed(begin_a, end_a, weight), mean_b = mixed(begin_b, end_b, weight);
  if (!a.is_circle() && !b.is_circle() && !at_end) {
    // The mean vector over the mean length gives the change of a length exactly.
    const S length = length_of(typename GuideFrame<S>::V(end_b.centre - end_a.centre));
    const S mean = 0.5 * (before.length + length);
    VectorGradient<S> gradient;
    gradient.by_way = (weights.straight / mean) * (mean_b.centre - mean_a.centre);
    for (auto* axes : {gradient.by_first, gradient.by_second})
      for (int i = 0; i < 2; ++i) axes[i] = typename GuideFrame<S>::V(S(0), S(0), S(0));
    out.direction = gradient.on_nodes(mean_a, mean_b);
    return out;
  }
  const Angles middle{(1 - weight) * begin.begin + weight * end.begin, (1 - weight) * begin.end + weight * end.end};
  const Chord<double> mean = tangents_near(a, b, values_of(mean_a), values_of(mean_b), middle);
  const VectorGradient<S> gradient = [&] {
    if constexpr (std::is_same_v<S, double>)
      return vector_gradient(a, b, weights, mean);
    else
      return vector_gradient(a, b, weights, with_derivatives(a, b, mean_a, mean_b, {mean.begin, mean.end}));
  }();
  out.direction = gradient.on_nodes(mean_a, mean_b);
  if (at_end) return out;
  const Correction<S> correction(a, b, begin_a, end_a, begin_b, end_b);
  if (correction.is_tiny()) return out;
  const S missing = out.end - before.value(weights) - gradient.change(begin_a, end_a, begin_b, end_b);
  out.direction += correction.of(missing);
  return out;
}

}  // namespace
}  // namespace tendon

PieceChange TendonPiece::change(const PieceEnd& begin, const PieceEnd& end, const PieceWeights& weights, bool at_end,
                                bool with_slope) const {
  PieceChange out;
  if (!with_slope) {
    out.direction = tendon::change_of<double>(first_, second_, begin.first, end.first, begin.second, end.second,
                                              begin.state, end.state, weights, at_end)
                        .direction;
    return out;
  }
  const tendon::GuideFrame<tendon::Dual> moving_a = tendon::moving(end.first, first_, 0),
                                         moving_b = tendon::moving(end.second, second_, 6);
  const tendon::Change<tendon::Dual> change = tendon::change_of<tendon::Dual>(
      first_, second_, begin.first, moving_a, begin.second, moving_b, begin.state, end.state, weights, at_end);
  for (int i = 0; i < 12; ++i) {
    out.direction[i] = change.direction[i].value();
    out.direction_slope.row(i) = change.direction[i].derivatives().transpose();
  }
  out.end_gradient = change.end.derivatives();
  return out;
}

}  // namespace flexarm
