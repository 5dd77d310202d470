#include "flexarm/joints/slide_map.h"

#include <algorithm>
#include <cmath>

#include "flexarm/math/so3.h"

namespace flexarm {
namespace {

using Complex = std::complex<double>;
/// Of complex steps: no cancellation, so as small as it likes.
constexpr double kStep = 1e-30;
/// Relative to the element's length: below it the rotation over Delta X is taken from the curvature in the middle,
/// which is accurate to its square.
constexpr double kShort = 1e-5;
/// Nodal increments that differ by less have nothing to redistribute [rad^2].
constexpr double kUniform = 1e-24;

template <typename S>
double real(const S& value) {
  return std::real(value);
}

/// The line's nodes with scalars of another kind; one of their scalars, or the arc length, may be perturbed.
template <typename S>
struct Configuration {
  const SlideLine& line;
  const std::vector<NodePose>& nodes;
  int perturbed_node = -1, component = 0;  // into line.nodes; 0 to 2: position, 3 to 5: spin

  PoseT<S> operator()(int i) const {
    const NodePose& node = nodes[line.nodes[i]];
    PoseT<S> pose{node.position.template cast<S>(), node.orientation.template cast<S>()};
    if constexpr (std::is_same_v<S, Complex>) {
      if (i == perturbed_node && component < 3) pose.position[component] += Complex(0, kStep);
      if (i == perturbed_node && component >= 3) {
        Vector3T<S> spin = Vector3T<S>::Zero();
        spin[component - 3] = Complex(0, kStep);
        pose.orientation = so3::exp_quaternion(spin) * pose.orientation;
      }
    }
    return pose;
  }
};

/// What a step makes of the line, for rows with scalars S.
template <typename S>
struct Step {
  const SlideLine& line;
  Configuration<S> begin, end;
  double from;
  S to;
  int piece_from, piece_to;
  int first, count;         // active nodes
  double arm_weight = 0.5;  // of the end in moment arms
  /// Weight of node j in the contact, with the same mean as the arms.
  S contact(const S& at_begin, const S& at_end) const { return S(1 - arm_weight) * at_begin + S(arm_weight) * at_end; }
};

template <typename S>
using NodeRows = Eigen::Matrix<S, 6, 1>;

/// Scratch of one kind of scalar; grows once.
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

template <typename S>
void add_weights(const Step<S>& step, int piece, const std::array<S, slide::kMostNodes>& values, const S& factor,
                 std::vector<S>& sum) {
  const SlidePiece& p = step.line.pieces[piece];
  for (int i = 0; i < p.node_count; ++i) sum[p.first_node + i - step.first] += factor * values[i];
}

template <typename S>
void set_weights(const Step<S>& step, Scratch<S>& scratch) {
  const SlidePiece &p = step.line.pieces[step.piece_from], &q = step.line.pieces[step.piece_to];
  add_weights(step, step.piece_from, slide::weights(p, S(step.from)).values, S(1), scratch.begin);
  add_weights(step, step.piece_to, slide::weights(q, step.to).values, S(1), scratch.end);
  if (step.piece_from == step.piece_to) {
    add_weights(step, step.piece_to, slide::divided_differences(q, step.from, step.to), S(1), scratch.difference);
    return;
  }
  // By way of the borders between both elements: each part is free of cancellation.
  const bool forward = step.piece_to > step.piece_from;
  const double leave = forward ? p.end : p.begin, enter = forward ? q.begin : q.end;
  const S change = step.to - step.from;
  add_weights(step, step.piece_from, slide::divided_differences(p, step.from, S(leave)), (leave - step.from) / change,
              scratch.difference);
  add_weights(step, step.piece_to, slide::divided_differences(q, enter, step.to), (step.to - enter) / change,
              scratch.difference);
  scratch.difference[(forward ? p.first_node + p.node_count - 1 : p.first_node) - step.first] -= S(1) / change;
  scratch.difference[(forward ? q.first_node : q.first_node + q.node_count - 1) - step.first] += S(1) / change;
}

/// Tangent-scaled increment from one rotation to another.
template <typename S>
Vector3T<S> increment(const Matrix3T<S>& from, const Matrix3T<S>& to) {
  return cayley::increment(so3::quaternion_from_matrix(Matrix3T<S>(to * from.transpose())));
}

/// How the section's rotation increment splits: fixed + along * Delta X.
template <typename S>
struct RotationSplit {
  Vector3T<S> fixed, along;
};

template <typename S>
RotationSplit<S> split_rotation(const Step<S>& step) {
  const S from(step.from), change = step.to - step.from;
  const Matrix3T<S> at_00 = section_at(step.line, step.piece_from, from, step.begin).rotation,
                    at_01 = section_at(step.line, step.piece_from, from, step.end).rotation,
                    at_10 = section_at(step.line, step.piece_to, step.to, step.begin).rotation,
                    at_11 = section_at(step.line, step.piece_to, step.to, step.end).rotation;
  // Move, then slide; slide, then move.
  const Vector3T<S> a1 = increment(at_00, at_01), b1 = increment(at_01, at_11), b2 = increment(at_00, at_10),
                    a2 = increment(at_10, at_11);
  const SlidePiece& piece = step.line.pieces[step.piece_from];
  Vector3T<S> along1, along2;
  const bool same = step.piece_from == step.piece_to;
  if (std::abs(real(change)) < (same ? kShort : 1e-9) * (piece.end - piece.begin)) {
    const S middle = S(0.5) * (from + step.to);
    const int at = step.line.piece_at(real(middle));
    along1 = section_at(step.line, at, middle, step.end).spatial_curvature;
    along2 = section_at(step.line, at, middle, step.begin).spatial_curvature;
  } else {
    along1 = b1 / change;
    along2 = b2 / change;
  }
  const S c1 = S(1) / (S(1) - S(0.25) * so3::dot(a1, b1)), c2 = S(1) / (S(1) - S(0.25) * so3::dot(a2, b2));
  RotationSplit<S> out;
  out.fixed = S(0.5) * (a1 + a2);
  out.along =
      S(0.5) * (c1 * (cayley::inverse_tangent(a1) * along1) + c2 * (cayley::inverse_tangent(a2).transpose() * along2));
  return out;
}

/// Everything that the rows of SM-EM consist of, except g.
template <typename S>
struct IncrementalRows {
  Vector3T<S> travel, turn;         // rho, kappa: the released row is travel . f + turn . m
  Vector3T<S> arm, redistribution;  // e; delta over the sum of squares
  Vector3T<S> mean_rotation;
};

template <typename S>
IncrementalRows<S> incremental_rows(const Step<S>& step, Scratch<S>& scratch) {
  scratch.resize(step.count);
  set_weights(step, scratch);
  IncrementalRows<S> out;
  out.travel.setZero();
  out.mean_rotation.setZero();
  Vector3T<S> defect = Vector3T<S>::Zero(), interpolated = Vector3T<S>::Zero();  // e / Delta X, sum I_h w
  for (int j = 0; j < step.count; ++j) {
    const PoseT<S> begin = step.begin(step.first + j), end = step.end(step.first + j);
    scratch.rotation[j] = cayley::increment(begin.orientation, end.orientation);
    out.travel += scratch.difference[j] * (S(step.arm_weight) * begin.position + S(1 - step.arm_weight) * end.position);
    defect += S(step.arm_weight * (1 - step.arm_weight)) * scratch.difference[j] * (end.position - begin.position);
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

/// The rows for a slave's residual g, into scratch.rows; returns the released one.
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
  const slide::Weights<S> w = slide::weights(step.line.pieces[step.piece_to], step.to);
  for (int j = 0; j < step.count; ++j) {
    scratch.rows[j].template head<3>() = w.values[j] * force;
    scratch.rows[j].template tail<3>() = w.values[j] * moment;
  }
  const Section<S> section = section_at(step.line, step.piece_to, step.to, step.end);
  return so3::dot(section.tangent, force) + so3::dot(section.spatial_curvature, moment);
}

enum class Form { Incremental, Variational };

template <typename S>
S evaluate(Form form, const Step<S>& step, const Vector6& g, Scratch<S>& scratch) {
  return form == Form::Incremental ? evaluate_incremental(step, g, scratch) : evaluate_variational(step, g, scratch);
}

/// Columns of the slave at the end: dr = I^j dr_j + r' dX, spin = I_g^j spin_j + k dX.
void set_right(const Step<double>& step, SlideMaps& maps) {
  const SlidePiece& piece = step.line.pieces[step.piece_to];
  const slide::Weights<double> w = slide::weights(piece, step.to);
  const Section<double> section = section_at(step.line, step.piece_to, step.to, step.end);
  maps.released_right << section.tangent, section.spatial_curvature;
  for (int j = 0; j < maps.count; ++j) maps.right[j].setZero();
  slide::with_node_count(piece.node_count, [&](auto count) {
    constexpr int N = decltype(count)::value;
    std::array<Quaternion, N> orientation;
    NodalValues<N> values, derivatives;
    for (int i = 0; i < N; ++i) {
      orientation[i] = step.end(piece.first_node + i).orientation;
      values[i] = w.values[i];
      derivatives[i] = w.derivatives[i];
    }
    GeneralisedShapeFunctions<N> functions;
    LocalRotationVariation<N>(LocalRotations<N>(orientation)).evaluate(values, derivatives, functions);
    for (int i = 0; i < N; ++i) {
      Matrix6& right = maps.right[piece.first_node + i - maps.first];
      right.topLeftCorner<3, 3>() = values[i] * Matrix3::Identity();
      right.bottomRightCorner<3, 3>() = functions.values[i];
    }
  });
}

/// Left maps from rows for unit residuals.
void set_left(Form form, const Step<double>& step, Scratch<double>& scratch, SlideMaps& maps) {
  if (form == Form::Variational) {
    maps.released_left = maps.released_right;
    for (int j = 0; j < maps.count; ++j) maps.left[j] = maps.right[j].topLeftCorner<1, 1>()(0, 0) * Matrix6::Identity();
    return;
  }
  const IncrementalRows<double> r = incremental_rows(step, scratch);
  maps.released_left << r.travel, r.turn;
  for (int j = 0; j < maps.count; ++j) {
    const double weight = step.contact(scratch.begin[j], scratch.end[j]);
    maps.left[j] = weight * Matrix6::Identity();
    maps.left[j].topRightCorner<3, 3>() = -weight * so3::hat(r.arm);  // transposed: moment row weight e x f
    maps.left[j].bottomRightCorner<3, 3>() += r.redistribution * (scratch.rotation[j] - r.mean_rotation).transpose();
  }
}

/// d(rows) at constant g by complex steps, column by column.
void set_geometric(Form form, const Step<double>& base, const Vector6& g, SlideMaps& maps) {
  static thread_local Scratch<Complex> scratch;
  Step<Complex> step{base.line,
                     {base.line, base.begin.nodes},
                     {base.line, base.end.nodes},
                     base.from,
                     base.to,
                     base.piece_from,
                     base.piece_to,
                     base.first,
                     base.count,
                     base.arm_weight};
  step.to = Complex(base.to, kStep);
  maps.released_released = evaluate(form, step, g, scratch).imag() / kStep;
  for (int i = 0; i < maps.count; ++i) maps.master_released[i] = scratch.rows[i].imag() / kStep;
  step.to = base.to;
  for (int j = 0; j < maps.count; ++j)
    for (int c = 0; c < 6; ++c) {
      step.end.perturbed_node = base.first + j;
      step.end.component = c;
      maps.released_master[j][c] = evaluate(form, step, g, scratch).imag() / kStep;
      for (int i = 0; i < maps.count; ++i)
        maps.master_master[i * maps.count + j].col(c) = scratch.rows[i].imag() / kStep;
    }
}

void set_maps(Form form, const Step<double>& step, const Vector6& g, SlideMaps& maps, bool with_tangent) {
  static thread_local Scratch<double> scratch;
  maps.first = step.first;
  maps.count = step.count;
  maps.left.resize(step.count);
  maps.right.resize(step.count);
  set_right(step, maps);
  set_left(form, step, scratch, maps);
  if (!with_tangent) return;
  maps.released_master.resize(step.count);
  maps.master_released.resize(step.count);
  maps.master_master.resize(static_cast<std::size_t>(step.count) * step.count);
  set_geometric(form, step, g, maps);
}

Configuration<double> configuration(const SlideLine& line, const std::vector<NodePose>& nodes) {
  return {line, nodes};
}

}  // namespace

SlideMaps::SlideMaps(std::size_t most_nodes) {
  left.reserve(most_nodes);
  right.reserve(most_nodes);
  released_master.reserve(most_nodes);
  master_released.reserve(most_nodes);
  master_master.reserve(most_nodes * most_nodes);
}

NodePose slide_pose(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length) {
  const Section<double> section = section_at(line, line.piece_at(arc_length), arc_length, configuration(line, nodes));
  NodePose pose;
  pose.position = section.position;
  pose.orientation = Quaternion(section.rotation).normalized();
  pose.rotation = pose.orientation.toRotationMatrix();
  return pose;
}

void slide_variational_maps(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length,
                            const Vector6& g, SlideMaps& maps, bool with_tangent) {
  const int piece = line.piece_at(arc_length);
  const Step<double> step{
      line,  configuration(line, nodes),    configuration(line, nodes),   arc_length, arc_length, piece,
      piece, line.pieces[piece].first_node, line.pieces[piece].node_count};
  set_maps(Form::Variational, step, g, maps, with_tangent);
}

void slide_incremental_maps(const SlideLine& line, const std::vector<NodePose>& begin, const std::vector<NodePose>& end,
                            double arc_length_begin, double arc_length_end, const Vector6& g, SlideMaps& maps,
                            bool with_tangent, double arm_weight) {
  const int from = line.piece_at(arc_length_begin), to = line.piece_at(arc_length_end);
  const SlidePiece &low = line.pieces[std::min(from, to)], &high = line.pieces[std::max(from, to)];
  const Step<double> step{line,
                          configuration(line, begin),
                          configuration(line, end),
                          arc_length_begin,
                          arc_length_end,
                          from,
                          to,
                          low.first_node,
                          high.first_node + high.node_count - low.first_node,
                          arm_weight};
  set_maps(Form::Incremental, step, g, maps, with_tangent);
}

}  // namespace flexarm
