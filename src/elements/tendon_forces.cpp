// The forces of a tendon in a step.
#include <algorithm>
#include <cmath>
#include <limits>

#include "elements/tendon_inside.h"
#include "joints/coordinate_step.h"

namespace flexarm {

/// If an equilibrium is asked for a part of the forces, the tendon is only shortened by that part. A tendon of steel
/// would otherwise pull with all its stiffness at once.
FunctionStep Tendon::function_of(const ForceStep& step) const {
  FunctionStep out{plan_.rest_length, plan_.rest_length, plan_.rest_length};
  if (!functions().empty()) out = step.functions[0];
  if (plan_.has_tension || step.load_factor == 1) return out;
  for (double* length : {&out.begin, &out.end, &out.mean})
    *length = length_at_start_ + step.load_factor * (*length - length_at_start_);
  return out;
}

std::unique_ptr<ForceWorkspace> Tendon::make_workspace() const {
  auto out = std::make_unique<Workspace>();
  out->spans.reserve(plan_.guides.size());
  out->part_steps.resize(parts_);
  out->begin_rates.resize(parts_);
  out->ratios.reserve(plan_.guides.size());
  for (std::vector<PartForces>* sums : {&out->directions, &out->slopes}) {
    sums->resize(parts_);
    for (int part = 0; part < parts_; ++part) (*sums)[part].reset(part_nodes_[part].size());
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
  workspace.slip.begin(parts_);
  double slip = 0;  // as fast as in the last step
  for (int part = 0; part + 1 < parts_; ++part)
    workspace.slip.guess()[part] = slip -= memory.slip_rate(part) * step.duration;
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
    for (int part = 0; part < parts_; ++part) (*sums)[part].reset(part_nodes_[part].size());
  for (const MovedSpan& moved : workspace.spans) {
    const Span& span = moved.span;
    if (span.first_node == span.second_node) continue;  // on one body: nothing changes
    const auto add = [&](const PieceWeights& weights, double force, Eigen::VectorXd& direction,
                         Eigen::VectorXd& slope) {
      const PieceChange change = span.piece.change(moved.begin, moved.end, weights, step.at_end, with_slope);
      const int places[2] = {span.first_place, span.second_place};
      for (int i = 0; i < 2; ++i) {
        if (places[i] < 0) continue;
        direction.segment<6>(6 * places[i]) += change.direction.segment<6>(6 * i);
        if (!with_slope) continue;
        slope.segment<6>(6 * places[i]) += change.end_gradient.segment<6>(6 * i);
      }
      if (with_slope) add_slope(span, force, change.direction_slope, action);
    };
    const TendonStep& line = workspace.slip.steps()[span.part];
    add(span.length, line.tension, directions[span.part].length, slopes[span.part].length);
    if (span.winds && !plan_.has_tension)
      add(span.rest, line.release, directions[span.part].rest, slopes[span.part].rest);
  }
  for (std::size_t i = 0; i < plan_.winches.size(); ++i)
    if (winch_places_[i] >= 0)
      for (Eigen::VectorXd* sum : {&directions[0].rest, &slopes[0].rest})
        sum->segment<3>(6 * winch_places_[i]) += plan_.winches[i].direction;
}

void Tendon::evaluate(const ForceStep& step, const int*, ForceAction& action) const {
  action.residual.setZero();
  action.tangent.setZero();
  action.pieces.set_zero();
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
  add_forces(workspace, action);
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

/// Adds tensions along the directions, and the derivatives of the tensions.
void Tendon::add_forces(Workspace& workspace, ForceAction& action) const {
  for (int part = 0; part < parts_; ++part) {
    const TendonStep& line = workspace.slip.steps()[part];
    const PartForces& directions = workspace.directions[part];
    for (std::size_t i = 0; i < part_nodes_[part].size(); ++i) {
      const auto at = static_cast<Eigen::Index>(6 * i);
      action.residual.segment<6>(6 * part_nodes_[part][i]) +=
          line.tension * directions.length.segment<6>(at) + line.release * directions.rest.segment<6>(at);
    }
  }
  if (pieces_.rank > 0 && action.pieces.blocks.size() != 0) set_groups(workspace, action.pieces);
  if (action.tangent.size() != 0) add_products(workspace, action.tangent);
}

/// The changes of the forces by the lengths of their parts, and of the slips, by auxiliary variables
/// (docs/notes/lines.md 5).
void Tendon::set_groups(const Workspace& workspace, PieceTangent& tangent) const {
  const Eigen::Index rank = pieces_.rank;
  Eigen::Index at = 0;
  for (int part = 0; part < parts_; ++part) {
    const TendonStep& line = workspace.slip.steps()[part];
    const PartForces &directions = workspace.directions[part], &slopes = workspace.slopes[part];
    const Eigen::Index size = directions.length.size();
    auto left = tangent.left.middleRows(at, size);
    auto right = tangent.right.middleCols(at, size);
    at += size;
    left.col(0) = line.by_length * directions.length + line.release_by_length * directions.rest;
    right.row(0) = slopes.length.transpose();
    if (rank == 1) continue;  // the rest length depends on no motion
    left.col(1) = line.by_rest * directions.length + line.release_by_rest * directions.rest;
    right.row(1) = slopes.rest.transpose();
    if (rank == 2) continue;  // nothing slips
    auto before = tangent.inner.middleCols<3>(9 * part), own = tangent.inner.middleCols<3>(9 * part + 3),
         behind = tangent.inner.middleCols<3>(9 * part + 6);
    if (part > 0) before(1, 2) = -1;  // what the rest length gains
    if (part + 1 == parts_) continue;
    own(1, 2) = 1;
    const SlipRow row = workspace.slip.row(part);
    if (!row.slips) continue;
    own.row(2) << row.by_length[0], row.by_rest[0], 0;
    behind.row(2) << row.by_length[1], row.by_rest[1], 0;
  }
}

/// The same changes, for a dense tangent.
void Tendon::add_products(Workspace& workspace, Eigen::Map<Eigen::MatrixXd>& tangent) const {
  auto& [slip_slopes, by_length, by_rest, pull, push] = workspace.dense;
  const std::vector<PartForces>& slopes = workspace.slopes;
  slip_slopes.setZero(parts_ - 1, tangent.cols());
  const auto add = [&](auto&& sum, double factor, const Eigen::VectorXd& slope, int part) {
    for (std::size_t i = 0; i < part_nodes_[part].size(); ++i)
      sum.template segment<6>(6 * part_nodes_[part][i]) +=
          factor * slope.segment<6>(static_cast<Eigen::Index>(6 * i)).transpose();
  };
  for (int guide = 0; guide + 1 < parts_; ++guide) {
    const SlipRow row = workspace.slip.row(guide);
    for (int k = 0; row.slips && k < 2; ++k) {
      add(slip_slopes.row(guide), -row.by_length[k], slopes[guide + k].length, guide + k);
      add(slip_slopes.row(guide), -row.by_rest[k], slopes[guide + k].rest, guide + k);
    }
  }
  workspace.slip.find_slopes(slip_slopes);
  for (int part = 0; part < parts_; ++part) {
    const TendonStep& line = workspace.slip.steps()[part];
    const PartForces& directions = workspace.directions[part];
    by_length.setZero(tangent.cols()), by_rest.setZero(tangent.cols());
    add(by_length, 1, slopes[part].length, part);
    add(by_rest, 1, slopes[part].rest, part);
    if (part > 0) by_rest += slip_slopes.row(part - 1);
    if (part + 1 < parts_) by_rest -= slip_slopes.row(part);
    pull = line.by_length * by_length + line.by_rest * by_rest;
    push = line.release_by_length * by_length + line.release_by_rest * by_rest;
    const bool winds = !directions.rest.isZero(0);
    for (std::size_t i = 0; i < part_nodes_[part].size(); ++i) {
      auto rows = tangent.middleRows<6>(6 * part_nodes_[part][i]);
      const auto at = static_cast<Eigen::Index>(6 * i);
      rows.noalias() += directions.length.segment<6>(at) * pull;
      if (winds) rows.noalias() += directions.rest.segment<6>(at) * push;
    }
  }
}

}  // namespace flexarm
