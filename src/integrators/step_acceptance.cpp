// The end of a step: norms of increments, work of loads, and the new state.
#include <algorithm>
#include <cmath>
#include <limits>

#include "elements/load.h"
#include "elements/nodal_inertia.h"
#include "integrators/step_system.h"
#include "math/cayley.h"

namespace flexarm {
namespace {

/// Calls visit(first equation, scale): scale 1/length for displacements, 1 for rotations, for every unknown scalar.
template <class Visit>
void for_each_unknown(const Model& model, const DegreesOfFreedom& dof, const Visit& visit) {
  for (int i = 0; i < dof.node_count; ++i) {
    const int equation = dof.equation[dof.first[i]];
    for (int k = 0; k < 6 && equation >= 0; ++k) visit(equation + k, k >= 3);
  }
  for (std::size_t index = 0; index < model.coordinates.size(); ++index) {
    const Coordinate& coordinate = model.coordinates[index];
    const int equation = dof.equation[dof.first[dof.variable_of_joint(coordinate.joint)] + coordinate.component];
    if (equation >= 0) visit(equation, coordinate.is_angle || !model.joints[coordinate.joint].rotation.isZero(0));
  }
}

}  // namespace

double StepSystem::scaled_norm(const Eigen::VectorXd& increment) const {
  double norm = 0;
  const auto count = [&](double value) {
    norm = std::max(norm, std::isfinite(value) ? std::abs(value) : std::numeric_limits<double>::infinity());
  };
  for_each_unknown(model_, dof_, [&](int equation, bool is_rotation) {
    count(increment[equation] / (is_rotation ? 1.0 : model_.length_scale));
  });
  if (model_.closures.empty() || static_) return norm;
  // Where motions and loops leave nothing free, the multipliers are all that Newton's method has to find. A force
  // counts as the way by which it moves the mechanism in a step.
  double mass = 0;
  for (const NodalInertia& inertia : model_.inertias) mass += inertia.total_mass;
  if (mass == 0) return norm;
  const double way = step_ * step_ / (mass * model_.length_scale);
  for (std::size_t k = 0; k < model_.closures.size(); ++k) {
    const int first = dof_.first[dof_.variable_of_closure(static_cast<int>(k))];
    const std::vector<ClosureConstraint>& constraints = model_.closures[k].constraints;
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      const double arm = constraints[i].kind == ClosureConstraint::Kind::Gap ? 1.0 : model_.length_scale;
      count(way / arm * increment[dof_.equation[first + i]]);
    }
  }
  return norm;
}

double StepSystem::largest_rotation(const Eigen::VectorXd& increment) const {
  double largest = 0;
  for_each_unknown(model_, dof_, [&](int equation, bool is_rotation) {
    if (is_rotation) largest = std::max(largest, std::abs(increment[equation]));
  });
  return largest;
}

double StepSystem::largest_node_rotation() const {
  double largest = 0;
  for (const Vector3& w : increments_) largest = std::max(largest, w.norm());
  return largest;
}

double StepSystem::work() const {
  double work = 0;
  const bool incremental = scheme_.is_incremental();
  for (const NodalLoad& load : model_.loads) {
    const Matrix3& begin = begin_[load.node].rotation;
    const Matrix3& end = end_[load.node].rotation;
    const double value = history_values_[load.history];
    Vector6 wrench, increment;
    increment << end_[load.node].position - begin_[load.node].position, increments_[load.node];
    if (incremental) {
      wrench = load_action(load, value, begin, end, LoadPoint::Mean).wrench;
    } else {  // trapezoidal rule
      increment.tail<3>() = cayley::to_rotation_vector(increments_[load.node]);
      wrench = 0.5 * (load_action(load, value, begin, end, LoadPoint::End).wrench +
                      load_action(load, begin_history_values_[load.history], end, begin, LoadPoint::End).wrench);
    }
    work += wrench.dot(increment);
  }
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const ReleasedVector change = released_increment(model_.joints[j], state_->released[j], released_[j]);
    for (int k = 0; k < change.size(); ++k) {
      const std::size_t index = model_.first_coordinate[j] + k;
      const double effort = incremental ? applied_[index] : 0.5 * (applied_[index] + state_->efforts[index]);
      work += effort * change[k];
    }
  }
  return work;
}

void StepSystem::accept(State& state) {
  // A prescribed coordinate's row is the effort that drives it.
  for (std::size_t index = 0; index < model_.coordinates.size(); ++index) {
    const Coordinate& coordinate = model_.coordinates[index];
    if (coordinate.motion < 0) continue;
    applied_[index] += rows_.at(dof_.variable_of_joint(coordinate.joint))[coordinate.component] / effort_weight();
    // Over the step; the Newmark family has that at its end, and none at the start of a simulation.
    const bool is_mean = scheme_.is_incremental() || state.history.count == 0;
    state.drives.impulse[index] += step_ * (is_mean ? applied_[index] : 0.5 * (state.efforts[index] + applied_[index]));
  }
  accept_friction(state);
  state.work += work();
  state.dissipated += dissipated_;

  std::vector<double>& made = state.history.push(step_, dof_.unknowns);
  for (int i = 0; i < dof_.node_count; ++i) {
    const int equation = dof_.equation[dof_.first[i]];
    for (int k = 0; k < 3 && equation >= 0; ++k) {
      made[equation + k] = end_[i].position[k] - begin_[i].position[k];
      made[equation + 3 + k] = increments_[i][k];
    }
  }
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const ReleasedVector change = released_increment(model_.joints[j], state.released[j], released_[j]);
    const int first = dof_.first[dof_.variable_of_joint(static_cast<int>(j))];
    for (int k = 0; k < change.size(); ++k)
      if (dof_.equation[first + k] >= 0) made[dof_.equation[first + k]] = change[k];
  }

  choose_order(state.history);
  accept_multipliers(state);

  for (std::size_t i = 0; i < end_.size(); ++i)
    state.nodes[i] =
        advanced(scheme_, {begin_[i], end_[i], state.nodes[i], increments_[i], inverse_tangents_[i], step_, {}});
  std::copy(released_.begin(), released_.end(), state.released.begin());
  std::copy(applied_.begin(), applied_.end(), state.efforts.begin());
  if (!scheme_.nodal_rotary_inertia)
    std::copy(end_mass_points_.begin(), end_mass_points_.end(), state.mass_points.begin());
  if (!scheme_.is_incremental())
    std::copy(end_strain_rates_.begin(), end_strain_rates_.end(), state.strain_rates.begin());
  std::copy(end_strain_memory_.begin(), end_strain_memory_.end(), state.strain_memory.begin());
  reference_.accept(state);
  if (is_interpolated()) {
    std::copy(end_forces_.begin(), end_forces_.end(), state.forces.begin());
    state.reactions = end_reactions_;
    std::copy(end_momentum_rates_.begin(), end_momentum_rates_.end(), state.momentum_rates.begin());
  }
  state.time += step_;
  std::swap(begin_points_, end_points_);
  conserving_beams_.accept();
  std::swap(begin_mass_rotations_, end_mass_rotations_);
  if (scheme_.hht == HhtForm::Kinematics) points_valid_ = false;  // those at hand belong to t_{n+1+alpha}
}

/// The next step is foreseen as this one would have been foreseen best.
void StepSystem::choose_order(IncrementHistory& history) {
  double smallest = std::numeric_limits<double>::infinity();
  for (int order = 0; order <= IncrementHistory::kHighestOrder; ++order) {
    const IncrementHistory::Weights weights = history.weights(order, 1, history.steps[0]);
    if (weights[1] == 0) continue;
    double error = 0;
    for_each_unknown(model_, dof_, [&](int equation, bool is_rotation) {
      double foreseen = 0;
      for (int i = 1; i <= 1 + order; ++i) foreseen += weights[i] * history.increments[i][equation];
      error = std::max(
          error, std::abs(history.increments[0][equation] - foreseen) / (is_rotation ? 1.0 : model_.length_scale));
    });
    if (error < smallest) smallest = error, history.order = order;
  }
}

void StepSystem::accept_static(State& state) {
  for (std::size_t i = 0; i < end_.size(); ++i) {
    state.nodes[i] = NodeState();
    state.nodes[i].position = end_[i].position;
    state.nodes[i].orientation = end_[i].orientation;
  }
  std::copy(released_.begin(), released_.end(), state.released.begin());
  std::copy(applied_.begin(), applied_.end(), state.efforts.begin());
  std::fill(state.mass_points.begin(), state.mass_points.end(), MassPointState());
  std::fill(state.strain_rates.begin(), state.strain_rates.end(), Vector6::Zero());
  std::fill(state.strain_memory.begin(), state.strain_memory.end(), StrainMemory());
  reference_.accept(state);
  state.drives.restart(applied_);
  state.history.clear();
  points_valid_ = false;
}

}  // namespace flexarm
