// The formulas of the rows are templates on their scalar type, and contain no derivatives.
#include "joints/slide_rows.h"

#include <algorithm>
#include <complex>
#include <vector>

#include "joints/slide_section.h"
#include "math/so3.h"

namespace flexarm::test {
namespace {

using Complex = std::complex<double>;
/// Complex steps have no cancellation, so this may be as small as desired.
constexpr double kComplexStep = 1e-30;
/// The same constants as in src/joints/slide_increment.cpp.
constexpr double kShort = 1e-5, kUniform = 1e-24;

template <typename S>
double real(const S& value) {
  return std::real(value);
}

/// The line's nodes with another scalar type. One scalar of a node, or the arc length, may be perturbed.
template <typename S>
struct Configuration {
  const SlideLine& line;
  const std::vector<NodePose>& nodes;
  int perturbed_node = -1, component = 0;  // index into line.nodes; component 0 to 2: position, 3 to 5: spin

  PoseT<S> operator()(int i) const {
    const NodePose& node = nodes[line.nodes[i]];
    PoseT<S> pose{node.position.template cast<S>(), node.orientation.template cast<S>()};
    if constexpr (std::is_same_v<S, Complex>) {
      if (i == perturbed_node && component < 3) pose.position[component] += Complex(0, kComplexStep);
      if (i == perturbed_node && component >= 3) {
        Vector3T<S> spin = Vector3T<S>::Zero();
        spin[component - 3] = Complex(0, kComplexStep);
        pose.orientation = so3::exp_quaternion(spin) * pose.orientation;
      }
    }
    return pose;
  }
};

/// Differences between the forms of the incremental maps.
struct ContactRule {
  double weight = 0.5;        ///< c: weight of the end of the step in the nodes' weights
  double arm_weight = 0.5;    ///< weight of the end in moment arms, if `moves_arm`
  bool moves_arm = false;     ///< errors of the arms are added to the moments (SM-EM)
  bool is_in_middle = false;  ///< the contact holds only in the middle of the step
};

ContactRule contact_rule(SlideStep step, double arm_weight) {
  switch (step) {
    case SlideStep::MidContact:
      return {0.5, arm_weight, false, true};
    case SlideStep::EndContact:
      return {0.5, arm_weight, false, false};
    case SlideStep::EnterMid:
      return {1.0, arm_weight, false, true};
    case SlideStep::EnterEnd:
      return {1.0, arm_weight, false, false};
    case SlideStep::BeginWeights:
      return {0.0, arm_weight, false, false};
    case SlideStep::SmEm:
      break;
  }
  return {arm_weight, arm_weight, true, false};
}

/// Data of the line over a step, for rows with scalars S.
template <typename S>
struct Step {
  const SlideLine& line;
  Configuration<S> begin, end;
  double from;
  S to;
  int piece_from, piece_to;
  int first, count;  // active nodes
  ContactRule rule;
  /// Weight of a node in the contact.
  S contact(const S& at_begin, const S& at_end) const {
    return S(1 - rule.weight) * at_begin + S(rule.weight) * at_end;
  }
};

template <typename S>
using NodeRows = Eigen::Matrix<S, 6, 1>;

/// Scratch memory for one scalar type; it grows once.
template <typename S>
struct Scratch {
  std::vector<S> begin, end, difference;
  std::vector<Vector3T<S>> rotation;
  std::vector<NodeRows<S>> rows;
  void resize(std::size_t count) {
    begin.assign(count, S(0));
    end.assign(count, S(0));
    difference.assign(count, S(0));
    rotation.resize(count);
    rows.resize(count);
  }
};

template <typename S, typename W>
void add_weights(const Step<S>& step, const slide::LineWeights<W>& weights, const S& factor, std::vector<S>& sum) {
  for (int i = 0; i < weights.count; ++i) sum[weights.first + i - step.first] += factor * weights.values[i];
}

template <typename S>
void set_weights(const Step<S>& step, Scratch<S>& scratch) {
  const SlideLine& line = step.line;
  const SlidePiece &p = line.pieces[step.piece_from], &q = line.pieces[step.piece_to];
  add_weights(step, slide::line_weights(line, step.piece_from, step.from), S(1), scratch.begin);
  add_weights(step, slide::line_weights(line, step.piece_to, step.to), S(1), scratch.end);
  if (step.piece_from == step.piece_to) {
    add_weights(step, slide::line_differences(line, step.piece_to, step.from, step.to), S(1), scratch.difference);
    return;
  }
  // Split at the borders between both elements, so that each part is free of cancellation.
  const bool forward = step.piece_to > step.piece_from;
  const double leave = forward ? p.end : p.begin, enter = forward ? q.begin : q.end;
  const S change = step.to - step.from;
  add_weights(step, slide::line_differences(line, step.piece_from, step.from, leave), (leave - step.from) / change,
              scratch.difference);
  add_weights(step, slide::line_differences(line, step.piece_to, enter, step.to), (step.to - enter) / change,
              scratch.difference);
  scratch.difference[(forward ? p.end_node() - 1 : p.first_node) - step.first] -= S(1) / change;
  scratch.difference[(forward ? q.first_node : q.end_node() - 1) - step.first] += S(1) / change;
}

/// Tangent-scaled increment from one rotation to another.
template <typename S>
Vector3T<S> increment(const Matrix3T<S>& from, const Matrix3T<S>& to) {
  return cayley::increment(so3::quaternion_from_matrix(Matrix3T<S>(to * from.transpose())));
}

/// The section's rotation increment, split into fixed + along * Delta X.
template <typename S>
struct RotationSplit {
  Vector3T<S> fixed, along;
};

template <typename S>
RotationSplit<S> split_rotation(const Step<S>& step) {
  const S from(step.from), change = step.to - step.from;
  const Matrix3T<S> at_00 = frame_at(step.line, step.piece_from, from, step.begin).rotation,
                    at_01 = frame_at(step.line, step.piece_from, from, step.end).rotation,
                    at_10 = frame_at(step.line, step.piece_to, step.to, step.begin).rotation,
                    at_11 = frame_at(step.line, step.piece_to, step.to, step.end).rotation;
  // Two sequences: 1 moves the nodes, then slides; 2 slides, then moves the nodes.
  const Vector3T<S> a1 = increment(at_00, at_01), b1 = increment(at_01, at_11), b2 = increment(at_00, at_10),
                    a2 = increment(at_10, at_11);
  const SlidePiece& piece = step.line.pieces[step.piece_from];
  Vector3T<S> along1, along2;
  const bool same = step.piece_from == step.piece_to;
  if (std::abs(real(change)) < (same ? kShort : 1e-9) * piece.length()) {
    const S middle = S(0.5) * (from + step.to);
    const int at = step.line.piece_at(real(middle));
    along1 = frame_at(step.line, at, middle, step.end).spatial_curvature;
    along2 = frame_at(step.line, at, middle, step.begin).spatial_curvature;
  } else {
    along1 = b1 / change;
    along2 = b2 / change;
  }
  const S c1 = S(1) / (S(1) - S(0.25) * so3::dot(a1, b1)), c2 = S(1) / (S(1) - S(0.25) * so3::dot(a2, b2));
  RotationSplit<S> out;
  const S end(step.rule.weight), begin(1 - step.rule.weight);
  out.fixed = begin * a1 + end * a2;
  out.along = begin * c1 * (cayley::inverse_tangent(a1) * along1) +
              end * c2 * (cayley::inverse_tangent(a2).transpose() * along2);
  return out;
}

/// All quantities in the rows, except g.
template <typename S>
struct IncrementalRows {
  Vector3T<S> travel, turn;         // rho, kappa: the released row is travel . f + turn . m
  Vector3T<S> arm, redistribution;  // e; delta divided by the sum of squares
  Vector3T<S> mean_rotation;
};

template <typename S>
IncrementalRows<S> incremental_rows(const Step<S>& step, Scratch<S>& scratch) {
  scratch.resize(step.count);
  set_weights(step, scratch);
  const double c = step.rule.weight, a = step.rule.arm_weight;
  IncrementalRows<S> out;
  out.travel.setZero();
  out.mean_rotation.setZero();
  Vector3T<S> defect = Vector3T<S>::Zero(), interpolated = Vector3T<S>::Zero();  // e / Delta X, sum of I_h w
  for (int j = 0; j < step.count; ++j) {
    const PoseT<S> begin = step.begin(step.first + j), end = step.end(step.first + j);
    scratch.rotation[j] = cayley::increment(begin.orientation, end.orientation);
    out.travel += scratch.difference[j] * (S(c) * begin.position + S(1 - c) * end.position);
    if (step.rule.moves_arm) defect += S(a * (1 - a)) * scratch.difference[j] * (end.position - begin.position);
    interpolated += step.contact(scratch.begin[j], scratch.end[j]) * scratch.rotation[j];
    out.mean_rotation += S(1.0 / step.count) * scratch.rotation[j];
  }
  out.travel -= so3::cross(interpolated, defect);
  out.arm = (step.to - step.from) * defect;
  const RotationSplit<S> rotation = split_rotation(step);
  out.turn = rotation.along;
  S spread(0);
  for (int j = 0; j < step.count; ++j) {
    const Vector3T<S> d = scratch.rotation[j] - out.mean_rotation;
    spread += so3::dot(d, d);
  }
  out.redistribution.setZero();
  if (real(spread) > kUniform) out.redistribution = (rotation.fixed - interpolated) / spread;
  return out;
}

/// Writes the rows for a slave's residual g into scratch.rows, and returns the released row.
template <typename S>
S evaluate_incremental(const Step<S>& step, const Vector6& g, Scratch<S>& scratch) {
  const IncrementalRows<S> r = incremental_rows(step, scratch);
  const Vector3T<S> force = g.head<3>().template cast<S>(), moment = g.tail<3>().template cast<S>();
  const S share = so3::dot(r.redistribution, moment);
  const Vector3T<S> turned = moment + so3::cross(r.arm, force);
  for (int j = 0; j < step.count; ++j) {
    const S weight = step.contact(scratch.begin[j], scratch.end[j]);
    scratch.rows[j].template head<3>() = weight * force;
    scratch.rows[j].template tail<3>() = weight * turned + share * (scratch.rotation[j] - r.mean_rotation);
  }
  return so3::dot(r.travel, force) + so3::dot(r.turn, moment);
}

template <typename S>
S evaluate_variational(const Step<S>& step, const Vector6& g, Scratch<S>& scratch) {
  scratch.resize(step.count);
  const Vector3T<S> force = g.head<3>().template cast<S>(), moment = g.tail<3>().template cast<S>();
  const slide::LineWeights<S> w = slide::line_weights(step.line, step.piece_to, step.to);
  for (int j = 0; j < step.count; ++j) {
    scratch.rows[j].template head<3>() = w.values[j] * force;
    scratch.rows[j].template tail<3>() = w.values[j] * moment;
  }
  const Section<S> section = section_at(step.line, step.piece_to, step.to, step.end);
  return so3::dot(section.tangent, force) + so3::dot(section.spatial_curvature, moment);
}

}  // namespace

SlideRows slide_rows(const SlideTravel& travel, const Vector6& g, bool incremental) {
  const SlideLine& line = travel.line;
  const int to = line.piece_at(travel.to), from = incremental ? line.piece_at(travel.from) : to;
  const NodeRange active = line.support(std::min(from, to), std::max(from, to));
  const int count = active.end - active.first;
  Step<Complex> step{line,
                     {line, travel.begin},
                     {line, travel.end},
                     incremental ? travel.from : travel.to,
                     Complex(travel.to),
                     from,
                     to,
                     active.first,
                     count,
                     contact_rule(travel.step(), travel.arm_weight)};
  Scratch<Complex> scratch;
  const auto evaluate = [&] {
    Eigen::VectorXcd out(1 + 6 * count);
    out[0] = incremental ? evaluate_incremental(step, g, scratch) : evaluate_variational(step, g, scratch);
    for (int j = 0; j < count; ++j) out.segment<6>(1 + 6 * j) = scratch.rows[j];
    return out;
  };
  SlideRows out{evaluate().real(), Eigen::MatrixXd(1 + 6 * count, 1 + 6 * count)};
  step.to += Complex(0, kComplexStep);
  out.derivatives.col(0) = evaluate().imag() / kComplexStep;
  step.to = travel.to;
  for (int column = 0; column < 6 * count; ++column) {
    step.end.perturbed_node = active.first + column / 6;
    step.end.component = column % 6;
    out.derivatives.col(1 + column) = evaluate().imag() / kComplexStep;
  }
  return out;
}

}  // namespace flexarm::test
