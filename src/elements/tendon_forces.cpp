// The forces of a tendon in a step.
#include <algorithm>
#include <cmath>
#include <limits>

#include "elements/tendon_inside.h"
#include "joints/coordinate_step.h"

namespace flexarm {

FunctionStep Tendon::function_of(const ForceStep& step) const {
  if (functions().empty()) return {plan_.rest_length, plan_.rest_length, plan_.rest_length};
  return step.functions[0];
}

std::unique_ptr<ForceWorkspace> Tendon::make_workspace() const {
  auto out = std::make_unique<Workspace>();
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(reach().size());
  out->spans.reserve(plan_.guides.size());
  out->part_steps.resize(parts_);
  out->begin_rates.resize(parts_);
  out->ratios.reserve(plan_.guides.size());
  for (std::vector<PartForces>* sums : {&out->directions, &out->slopes}) {
    sums->resize(parts_);
    for (PartForces& sum : *sums) sum.reset(size);
  }
  return out;
}

void Tendon::begin(const ForceStep& step) const {
  auto& workspace = static_cast<Workspace&>(*step.workspace);
  const Memory memory{step.memory, parts_};
  const Poses poses(step.begin);
  for (int part = 0; part < parts_; ++part)
    workspace.part_steps[part] = {{0, straight_rest(poses, memory, part)}, {}, step.duration, step.at_end};
  workspace.spans.clear();
  for_each_span(memory, [&](const Span& span) {
    const PieceEnd here = span.piece.place(poses.of(span.piece), memory.angles(span.first, span.second));
    workspace.spans.push_back({span, here, here});
    workspace.part_steps[span.part].begin.length += here.state.value(span.length);
    workspace.part_steps[span.part].begin.rest += here.state.value(span.rest);
  });
  if (!has_rates(step)) return;
  for (int part = 0; part < parts_; ++part)
    workspace.begin_rates[part] = stretch_rate(poses, memory, part, step.velocities) - memory.slip_rate(part);
}

/// Whether forces depend on the rates at the end of the step.
bool Tendon::has_rates(const ForceStep& step) const {
  return step.at_end && step.duration != 0 && plan_.law.damping != 0;
}

/// Finds all spans at the end of the step, their angles, and the lengths of all parts without slip.
void Tendon::find_end(const ForceStep& step, const Memory& begin, const NewMemory& end, Workspace& workspace) const {
  const Poses poses(step.end);
  for (int part = 0; part < parts_; ++part) workspace.part_steps[part].end = {0, straight_rest(poses, end, part)};
  for (MovedSpan& moved : workspace.spans) {
    const Span& span = moved.span;
    moved.end = span.piece.place(poses.of(span.piece), begin.angles(span.first, span.second));
    end.goes(span.first) = moved.end.state.begin;
    end.comes(span.second) = moved.end.state.end;
    workspace.part_steps[span.part].end.length += moved.end.state.value(span.length);
    workspace.part_steps[span.part].end.rest += moved.end.state.value(span.rest);
  }
}

/// The rates of all parts at the end of the step, by the rule for rates.
void Tendon::find_rates(const ForceStep& step, const Memory& begin, const Memory& end, Workspace& workspace) const {
  for (int part = 0; part < parts_; ++part) {
    TendonPartStep& out = workspace.part_steps[part];
    const double by_function = shares_[part] * (end.function() - begin.function());
    CoordinateStep change;
    change.begin_rate = workspace.begin_rates[part];
    change.gamma = step.gamma;
    change.step = step.duration;
    // Without the function, whose rate is that of the step.
    change.increment = out.end.length - out.end.rest - out.begin.length + out.begin.rest + by_function;
    out.rate = rate_of(change) - by_function / step.duration;
    out.rate_slope = rate_slope(change);
  }
}

/// The angle by which the line turns at a guide [rad].
double Tendon::contact_angle(const Poses& poses, const Memory& memory, int guide) const {
  const GuidePlace& place = plan_.guides[guide].place;
  if (place.is_circle()) return std::max(place.sense * (memory.goes(guide) - memory.comes(guide)), 0.0);
  const auto [before, behind] = neighbours(memory, guide);
  const Vector3 here = poses.point(place, 0);
  const Vector3 comes = here - poses.point(plan_.guides[before].place, memory.goes(before));
  const Vector3 goes = poses.point(plan_.guides[behind].place, memory.comes(behind)) - here;
  return std::atan2(comes.cross(goes).norm(), comes.dot(goes));
}

/// Finds what the parts do. Returns false if no slip is found with which they are in balance.
bool Tendon::find_steps(const ForceStep& step, const Memory& begin, const Memory& end, Workspace& workspace) const {
  const std::vector<TendonPartStep>& parts = workspace.part_steps;
  std::vector<double>& ratios = workspace.ratios;
  ratios.clear();
  for (const TendonPartStep& part : parts)
    if (!(part.end.rest > 0)) return false;  // nothing is left of the line
  for (int i = 1; i + 1 < static_cast<int>(plan_.guides.size()); ++i) {
    const TendonGuide& guide = plan_.guides[i];
    if (!guide.divides()) continue;
    // The mean of both ends; its derivative is left out of the tangent.
    const double angle =
        guide.grips ? 0 : 0.5 * (contact_angle(Poses(step.begin), begin, i) + contact_angle(Poses(step.end), end, i));
    ratios.push_back(guide.grips ? TendonSlip::kNever : std::exp(guide.friction * angle));
  }
  return workspace.slip.solve(plan_.law, parts, ratios);
}

/// Sums up the directions of all parts, and the derivatives of their lengths at the end. Adds the derivatives of the
/// directions to the tangent.
void Tendon::add_directions(const ForceStep& step, Workspace& workspace, ForceAction& action) const {
  auto& directions = workspace.directions;
  auto& slopes = workspace.slopes;
  const bool with_slope = action.wants_tangent();
  for (std::vector<PartForces>* sums : {&directions, &slopes})
    for (PartForces& sum : *sums) sum.reset(action.residual.size());
  for (const MovedSpan& moved : workspace.spans) {
    const Span& span = moved.span;
    if (span.first_node == span.second_node) continue;  // on one body: nothing changes
    const auto add = [&](const PieceWeights& weights, double force, Eigen::VectorXd& direction,
                         Eigen::VectorXd& slope) {
      const PieceChange change = span.piece.change(moved.begin, moved.end, weights, step.at_end, with_slope);
      const int nodes[2] = {span.first_node, span.second_node};
      for (int i = 0; i < 2; ++i) {
        if (nodes[i] < 0) continue;
        direction.segment<6>(6 * nodes[i]) += change.direction.segment<6>(6 * i);
        if (!with_slope) continue;
        slope.segment<6>(6 * nodes[i]) += change.end_gradient.segment<6>(6 * i);
      }
      if (with_slope) add_slope(span, force, change.direction_slope, action);
    };
    const TendonStep& line = workspace.slip.steps()[span.part];
    add(span.length, line.tension, directions[span.part].length, slopes[span.part].length);
    if (span.winds && !plan_.has_tension)
      add(span.rest, line.release, directions[span.part].rest, slopes[span.part].rest);
  }
  for (std::size_t i = 0; i < plan_.winches.size(); ++i)
    if (winch_nodes_[i] >= 0)
      for (Eigen::VectorXd* sum : {&directions[0].rest, &slopes[0].rest})
        sum->segment<3>(6 * winch_nodes_[i]) += plan_.winches[i].direction;
}

void Tendon::evaluate(const ForceStep& step, const int*, ForceAction& action) const {
  action.residual.setZero();
  action.tangent.setZero();
  for (auto* matrix : {&action.pieces.blocks, &action.pieces.left, &action.pieces.right}) matrix->setZero();
  action.dissipated = action.work = 0;
  const Memory begin{step.memory, parts_};
  const NewMemory end{step.new_memory, parts_};
  std::copy_n(step.memory, memory_size(), step.new_memory);
  const FunctionStep function = function_of(step);
  end.function() = function.end;

  auto& workspace = static_cast<Workspace&>(*step.workspace);
  TendonSlip& slip = workspace.slip;
  find_end(step, begin, end, workspace);
  if (has_rates(step)) find_rates(step, begin, end, workspace);
  if (plan_.has_tension) {
    slip.set_tension(parts_, step.load_factor * std::max(step.at_end ? function.end : function.mean, 0.0));
  } else if (!find_steps(step, begin, end, workspace)) {
    action.dissipated = std::numeric_limits<double>::quiet_NaN();  // the step fails, also if no node can move
    action.residual.setConstant(action.dissipated);
    return;
  }
  add_directions(step, workspace, action);
  add_forces(slip, workspace.directions, workspace.slopes, action);
  for (int part = 0; part < parts_; ++part) {
    const TendonStep& line = slip.steps()[part];
    if (plan_.has_tension) {
      action.work -= line.tension * (workspace.part_steps[part].end.length - workspace.part_steps[part].begin.length);
      continue;
    }
    action.work += line.release * shares_[part] * (end.function() - begin.function());
    action.dissipated += line.dissipated - line.release * slip.gain(part);
    end.rims_at_start(part) -= slip.gain(part);
    end.slip_rate(part) = step.duration != 0 ? slip.gain(part) / step.duration : 0;
  }
  if (!may_lift_) return;
  // Leaving and touching pulleys changes the length by third powers of small angles. The energy is counted.
  if (!find_touched(Poses(step.end), end) || plan_.has_tension) return;
  for (int part = 0; part < parts_; ++part) {
    const TendonLengths& line = workspace.part_steps[part].end;
    action.dissipated += plan_.law.energy({line.length, line.rest + slip.gain(part)});
  }
  action.dissipated -= energy(Poses(step.end), end);
}

/// Adds the change of a force along the direction of a span.
void Tendon::add_slope(const Span& span, double force, const Matrix12& slope, ForceAction& action) const {
  if (action.tangent.size() == 0) {
    const Eigen::Index piece = first_piece_[span.first] + span.second - span.first - 1;
    action.pieces.blocks.middleCols<12>(12 * piece) += force * slope;
    return;
  }
  const int nodes[2] = {span.first_node, span.second_node};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      if (nodes[i] >= 0 && nodes[j] >= 0)
        action.tangent.block<6, 6>(6 * nodes[i], 6 * nodes[j]) += force * slope.block<6, 6>(6 * i, 6 * j);
}

/// The change of both forces of a line of one part by its two lengths, as a product of rank two or less.
void Tendon::set_factors(const TendonStep& line, const PartForces& directions, const PartForces& slopes,
                         PieceTangent& tangent) const {
  if (pieces_.rank == 0) return;
  tangent.left.col(0) = line.by_length * directions.length + line.release_by_length * directions.rest;
  tangent.right.row(0) = slopes.length.transpose();
  if (pieces_.rank == 1) return;  // the rest length depends on no motion
  tangent.left.col(1) = line.by_rest * directions.length + line.release_by_rest * directions.rest;
  tangent.right.row(1) = slopes.rest.transpose();
}

/// Adds tensions along the directions, and the derivatives of the tensions.
void Tendon::add_forces(TendonSlip& slip, const std::vector<PartForces>& directions,
                        const std::vector<PartForces>& slopes, ForceAction& action) const {
  const bool with_slope = action.tangent.size() != 0;
  if (action.pieces.blocks.size() != 0) set_factors(slip.steps()[0], directions[0], slopes[0], action.pieces);
  if (with_slope) slip.find_slopes();
  // The change of what a part gains by slipping, by the lengths of another part.
  const auto gains = [](const Eigen::MatrixXd& by, int part, int other) {
    return (part > 0 ? by(part - 1, other) : 0.0) - (part < by.rows() ? by(part, other) : 0.0);
  };
  for (int part = 0; part < parts_; ++part) {
    const TendonStep& line = slip.steps()[part];
    action.residual += line.tension * directions[part].length + line.release * directions[part].rest;
    for (int other = 0; with_slope && other < parts_; ++other) {
      const bool is_own = part == other;
      const double length = gains(slip.by_length(), part, other), rest = gains(slip.by_rest(), part, other);
      if (!is_own && length == 0 && rest == 0) continue;
      const double tension[2] = {(is_own ? line.by_length : 0) + line.by_rest * length,
                                 (is_own ? line.by_rest : 0) + line.by_rest * rest};
      const double release[2] = {(is_own ? line.release_by_length : 0) + line.release_by_rest * length,
                                 (is_own ? line.release_by_rest : 0) + line.release_by_rest * rest};
      const auto &by_length = slopes[other].length, &by_rest = slopes[other].rest;
      action.tangent.noalias() += directions[part].length * (tension[0] * by_length + tension[1] * by_rest).transpose();
      if (directions[part].rest.isZero(0)) continue;
      action.tangent.noalias() += directions[part].rest * (release[0] * by_length + release[1] * by_rest).transpose();
    }
  }
}

}  // namespace flexarm
