#include "integrators/step_system.h"

#include <algorithm>
#include <cmath>

#include "elements/load.h"
#include "joints/joint_forces.h"
#include "math/cayley.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// Most nodes that a slider may touch in a step.
std::size_t slide_node_count(const Model& model) {
  std::size_t most = 0;
  for (const SlideLine& line : model.slide_lines) {
    const int pieces = static_cast<int>(line.pieces.size());
    for (int p = 0; p < pieces; ++p) {
      const NodeRange active = line.support(p, std::min(p + SlideLine::kMostPieces, pieces) - 1);
      most = std::max(most, static_cast<std::size_t>(active.end - active.first));
    }
  }
  return most;
}

}  // namespace

StepSystem::StepSystem(const Model& model, const Scheme& scheme, BackendChoice backend)
    : model_(model),
      scheme_(scheme),
      dof_(model),
      rows_(model, dof_),
      backend_(make_tangent_backend(model, dof_, backend)),
      begin_(model.nodes),
      end_(model.nodes),
      released_(model.initial_released),
      increments_(model.nodes.size(), Vector3::Zero()),
      inverse_tangents_(model.nodes.size(), Matrix3::Identity()),
      reference_(model, scheme),
      begin_points_(model.stiffness_point_count),
      end_points_(model.stiffness_point_count),
      conserving_beams_(model, scheme),
      conserving_nodes_(model, scheme),
      begin_mass_rotations_(model.mass_point_count),
      end_mass_rotations_(model.mass_point_count),
      end_mass_points_(model.mass_point_count),
      end_strain_rates_(model.stiffness_point_count, Vector6::Zero()),
      end_strain_memory_(conserving_beams_.has_memory() ? model.stiffness_point_count : 0),
      interpolated_(model.nodes),
      interpolated_spins_(model.nodes.size(), Matrix3::Identity()),
      end_forces_(model.nodes.size(), Vector6::Zero()),
      end_reactions_(model.nodes.size(), Vector6::Zero()),
      end_momentum_rates_(model.mass_point_count + model.nodes.size(), Vector3::Zero()),
      history_values_(model.histories.size()),
      begin_history_values_(model.histories.size()),
      applied_(model.coordinates.size(), 0.0),
      slide_maps_(slide_node_count(model)),
      friction_slide_maps_(slide_node_count(model)),
      mimic_maps_(dof_.mimics.size()),
      begin_velocities_(model.nodes.size()),
      begin_rates_(model.joints.size()),
      carrier_of_(model.coordinates.size(), -1),
      capacities_(model.coordinates.size(), 0.0),
      residual_(Eigen::VectorXd::Zero(dof_.unknowns)) {
  for (const LoopClosure& closure : model.closures)
    multipliers_.push_back(ReleasedVector::Zero(static_cast<Eigen::Index>(closure.constraints.size())));
  find_friction();
}

NodeStep StepSystem::node_step(std::size_t node) const {
  NodeStep step{begin_[node], end_[node], state_->nodes[node], increments_[node], inverse_tangents_[node], step_};
  if (is_interpolated()) step.momentum_rate = state_->momentum_rates[model_.mass_point_count + node];
  return step;
}

void StepSystem::add_nodal_force(int node, const Vector6& force, Eigen::Matrix<double, 6, 3> rotational,
                                 bool of_configuration, bool with_tangent) {
  if (scheme_.hht != HhtForm::None) end_forces_[node] += force;
  if (!is_interpolated()) {
    Eigen::Map<Vector6>(rows_.at(node)) += force;
  } else if (scheme_.hht == HhtForm::Kinematics) {
    if (of_configuration) rotational = (rotational * interpolated_spins_[node]).eval();
  } else if (with_tangent) {
    rotational.topRows<3>() *= 1 + scheme_.alpha;
    rotational.bottomRows<3>() =
        (interpolated_moment(node, Vector3::Zero(), Vector3::Zero(), false).slope * rotational.bottomRows<3>()).eval();
  }
  if (with_tangent) Eigen::Map<Matrix6>(backend_->diagonal_block(node)).rightCols<3>() += rotational;
}

void StepSystem::add_nodal_forces(bool with_tangent) {
  const std::vector<NodePose>& end = is_interpolated() ? interpolated_ : end_;
  const Eigen::Matrix<double, 6, 3> none = Eigen::Matrix<double, 6, 3>::Zero();
  for (std::size_t i = 0; i < end_.size(); ++i) {
    const NodalInertia& inertia = model_.inertias[i];
    const int node = static_cast<int>(i);
    if (inertia.total_mass > 0) {
      Vector6 weight = Vector6::Zero();
      weight.head<3>() = -load_factor_ * inertia.total_mass * model_.gravity;
      add_nodal_force(node, weight, none, true, false);
    }
    if (static_ || inertia.rotary_damping.isZero(0)) continue;
    if (with_tangent) inverse_tangents_[i] = cayley::inverse_tangent(increments_[i]);
    const NodalAction damping = nodal_damping_action(inertia, scheme_, node_step(i));
    Eigen::Matrix<double, 6, 3> rotational = none;
    rotational.bottomRows<3>() = damping.rotational;
    add_nodal_force(node, damping.residual, rotational, false, with_tangent);
    dissipated_ += damping.dissipated;
  }
  const LoadPoint point = static_ || !scheme_.is_incremental() ? LoadPoint::End : LoadPoint::Mean;
  for (const NodalLoad& load : model_.loads) {
    const LoadAction action = load_action(load, load_factor_ * history_values_[load.history],
                                          begin_[load.node].rotation, end[load.node].rotation, point);
    add_nodal_force(load.node, -action.wrench, -action.derivative, true, with_tangent);
  }
}

void StepSystem::add_nodal_inertia(bool with_tangent) {
  if (scheme_.stress == StressRule::Conjugate) {
    Balance balance{rows_, with_tangent ? backend_.get() : nullptr};
    conserving_nodes_.add(motion(), balance);
    return;
  }
  for (std::size_t i = 0; i < end_.size(); ++i) {
    const NodalInertia& inertia = model_.inertias[i];
    if (inertia.empty()) continue;
    const NodalAction action = nodal_inertia_action(inertia, scheme_, node_step(i), with_tangent);
    Eigen::Map<Vector6>(rows_.at(static_cast<int>(i))) += action.residual;
    end_momentum_rates_[model_.mass_point_count + i] = action.residual.tail<3>();
    if (!with_tangent) continue;
    Eigen::Map<Matrix6> tangent(backend_->diagonal_block(static_cast<int>(i)));
    tangent.topLeftCorner<3, 3>().diagonal().array() += action.translational;
    tangent.bottomRightCorner<3, 3>() += action.rotational;
  }
}

double StepSystem::effort_at(const Coordinate& coordinate, std::size_t index) const {
  const double commanded = state_->commands[index];
  double effort = 0;
  if (!std::isnan(commanded))
    effort = commanded;
  else if (coordinate.effort >= 0)
    effort = history_values_[coordinate.effort];
  if (coordinate.effort_limit > 0) effort = std::clamp(effort, -coordinate.effort_limit, coordinate.effort_limit);
  return load_factor_ * effort;
}

CoordinateStep StepSystem::coordinate_step(std::size_t index, double increment) const {
  const Coordinate& coordinate = model_.coordinates[index];
  const int j = coordinate.joint, k = coordinate.component;
  CoordinateStep step;
  step.begin = state_->released[j].displacement[k % 3];
  step.end = released_[j].displacement[k % 3];
  step.increment = increment;
  step.step = step_;
  if (!scheme_.is_incremental()) step.gamma = scheme_.gamma, step.begin_rate = static_ ? 0.0 : begin_rates_[j][k];
  return step;
}

void StepSystem::add_joint_efforts(int j, bool with_tangent) {
  const JointMap& joint = model_.joints[j];
  const int count = released_count(joint.kind), variable = dof_.variable_of_joint(j);
  if (count == 0) return;
  double* residual = rows_.at(variable);
  Eigen::Map<ReleasedSquare> tangent(backend_->diagonal_block(variable), count, count);
  ReleasedVector change = ReleasedVector::Zero(count);
  if (!static_) change = released_increment(joint, state_->released[j], released_[j]);
  for (int k = 0; k < count; ++k) {
    const std::size_t index = model_.first_coordinate[j] + k;
    const Coordinate& coordinate = model_.coordinates[index];
    const PassiveEffort passive = passive_effort(coordinate, coordinate_step(index, change[k]));
    dissipated_ += passive.dissipated;
    applied_[index] = effort_at(coordinate, index);
    const double weight = effort_weight();
    residual[k] -= weight * (applied_[index] + passive.effort);
    if (carrier_of_[index] >= 0) add_constant_friction(static_cast<int>(index), change[k], residual[k]);
    const double slope = weight * passive.slope;
    if (!with_tangent || slope == 0) continue;
    if (coordinate.is_angle) {  // the increment varies as S^{-1} spin
      const Vector3 rotation = change.tail<3>();
      tangent.row(k).tail<3>() -= slope * cayley::inverse_tangent(rotation).row(k - (count - 3));
    } else {
      tangent(k, k) -= slope;
    }
  }
}

void StepSystem::slide_maps(int j, const Vector6& g, SlideMaps& maps, bool with_tangent) const {
  const SlideTravel travel = slide_travel(j);
  if (!static_ && scheme_.is_incremental())
    slide_incremental_maps(travel, g, maps, with_tangent);
  else
    slide_variational_maps(travel.line, end_, travel.to, g, maps, with_tangent);
}

void StepSystem::fold_slide(int j, bool with_tangent) {
  const Vector6 g = rows_.node(model_.joints[j].slave);
  slide_maps(j, g, slide_maps_, with_tangent);
  add_normal_friction(j, g, slide_maps_, with_tangent);
  rows_.fold(j, slide_maps_);
  if (with_tangent) backend_->fold(j, slide_maps_);
  add_joint_efforts(j, with_tangent);
}

void StepSystem::joint_maps(int j, const Vector6& g, FoldMaps& maps, bool with_tangent) const {
  const NodePose world;
  const JointMap& joint = model_.joints[j];
  const NodePose& end = joint.master < 0 ? world : end_[joint.master];
  if (!static_ && scheme_.is_incremental())
    incremental_maps(joint, joint.master < 0 ? world : begin_[joint.master], end, state_->released[j], released_[j], g,
                     maps, with_tangent, scheme_.arm_weight());
  else
    variational_maps(joint, end, released_[j], g, maps);
}

void StepSystem::fold_joints(bool with_tangent) {
  FoldMaps scratch;
  std::fill(capacities_.begin(), capacities_.end(), 0.0);
  for (int j = static_cast<int>(model_.joints.size()) - 1; j >= 0; --j) {
    const JointMap& joint = model_.joints[j];
    if (joint.kind == JointMapKind::Slide) {
      fold_slide(j, with_tangent);
      continue;
    }
    const Vector6 g = rows_.node(joint.slave);
    FoldMaps& maps = with_tangent ? backend_->fold_maps(j) : scratch;
    joint_maps(j, g, maps, with_tangent);
    add_normal_friction(j, g, maps, with_tangent);
    rows_.fold(j, maps);
    if (with_tangent) backend_->fold(j);
    add_joint_efforts(j, with_tangent);
  }
  for (std::size_t i = 0; i < mimic_maps_.size(); ++i) mimic_maps_[i] = mimic_map(dof_.mimics[i].coordinate);
  rows_.fold_mimics(mimic_maps_);
  if (with_tangent) backend_->fold_mimics(mimic_maps_);
}

MimicMap StepSystem::mimic_map(int coordinate) const {
  const Coordinate& following = model_.coordinates[coordinate];
  const int joint = model_.coordinates[following.mimicked].joint;
  const double from = state_->released[joint].displacement[0], to = released_[joint].displacement[0];
  const MimicLaw& law = following.mimic;
  const double right = law.derivative(to);
  if (static_ || !scheme_.is_incremental()) return {right, right, law.second_derivative(to)};
  return {law.secant(from, to), right, law.secant_derivative(from, to)};
}

void StepSystem::initialise(State& state) {
  reference_.initialise(state);
  if (conserving_beams_.has_memory()) initialise_strain_memory(state);
  if (scheme_.hht == HhtForm::None) return;
  state.forces.assign(state.nodes.size(), Vector6::Zero());
  begin_static(state, 1);
  compute_begin_points();
  evaluate(false);
  state.forces = end_forces_;
  initialise_momentum_rates(state);
  points_valid_ = false;
}

bool StepSystem::evaluate(bool with_tangent) {
  if (is_off_line_) return false;
  rows_.set_zero();
  if (with_tangent) backend_->set_zero();
  dissipated_ = 0;
  if (with_tangent && !static_ && scheme_.stress != StressRule::Conjugate)
    for (std::size_t i = 0; i < increments_.size(); ++i) inverse_tangents_[i] = cayley::inverse_tangent(increments_[i]);
  if (scheme_.hht != HhtForm::None) std::fill(end_forces_.begin(), end_forces_.end(), Vector6::Zero());
  if (is_interpolated()) interpolate_configuration();
  reference_.set_trial(is_interpolated() ? interpolated_ : end_);
  if (static_ || scheme_.stress == StressRule::EndPoint)
    add_endpoint_forces(with_tangent);
  else if (scheme_.stress != StressRule::Conjugate)
    add_momentum_beams(with_tangent);
  else {
    Balance balance{rows_, with_tangent ? backend_.get() : nullptr};
    conserving_beams_.add(motion(), balance, end_strain_memory_);
    dissipated_ += balance.dissipated;
  }
  add_nodal_forces(with_tangent);
  if (is_interpolated()) add_interpolated_forces(with_tangent);
  if (!static_) add_nodal_inertia(with_tangent);
  if (!static_ && scheme_.stress == StressRule::EndPoint) {
    if (scheme_.hht == HhtForm::Kinematics) reference_.set_trial(end_);
    add_newmark_inertia(with_tangent);
  }
  if (is_interpolated()) shift_reactions();
  add_closures(with_tangent);
  fold_joints(with_tangent);
  hold_friction();
  rows_.gather(residual_);
  if (with_tangent) {
    backend_->finish();
    hold_friction_tangent();
  }
  return residual_.allFinite();
}

}  // namespace flexarm
