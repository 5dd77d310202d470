#include "integrators/failure_place.h"

#include <algorithm>
#include <cmath>

#include "elements/element_configuration.h"
#include "integrators/dead_point.h"
#include "math/pi.h"
#include "model/place.h"

namespace flexarm {
namespace {

using Quantity = StepResult::Failure::Quantity;
using Reason = StepResult::Reason;

/// Local rotation vectors reach their limit at a full turn from the reference node (LocalRotations). If a failed step
/// starts with an element so close to this limit, the limit is the cause [rad].
constexpr double kNearlyATurn = 0.95 * 2 * kPi;

/// The place of a variable of DegreesOfFreedom.
StepResult::Place place_of_variable(const StepSystem& system, int variable) {
  const Model& model = system.configuration().model();
  const State& state = system.configuration().state();
  const DegreesOfFreedom& dof = system.degrees_of_freedom();
  if (variable < 0) return {};
  if (variable < dof.node_count) return place_of_node(model, state, variable);
  if (variable < dof.node_count + dof.joint_count) return place_of_joint(model, state, variable - dof.node_count);
  return place_of_loop(model, state, variable - dof.node_count - dof.joint_count);
}

// ---------------------------------------------------------------- the most conspicuous quantity

/// Finds the largest unbalanced force or moment. Moments are compared with forces by the mechanism's length scale. NaN
/// counts as the largest value.
void find_largest_residual(const StepSystem& system, StepResult::Failure& failure) {
  const Model& model = system.configuration().model();
  const State& state = system.configuration().state();
  const DegreesOfFreedom& dof = system.degrees_of_freedom();
  double largest = 0;
  const auto is_larger = [&](double amount, bool is_moment) {
    const double force = is_moment ? amount / model.length_scale : amount;
    if (std::isnan(largest) || force <= largest) return false;
    largest = force;
    failure.quantity = is_moment ? Quantity::Moment : Quantity::Force;
    failure.amount = amount;
    return true;
  };
  int node = -1;
  for (int i = 0; i < dof.node_count; ++i)
    for (const bool is_moment : {false, true}) {
      const int row = dof.equation[dof.first[i]];
      if (row >= 0 && is_larger(system.residual().segment<3>(row + (is_moment ? 3 : 0)).norm(), is_moment)) node = i;
    }
  const Coordinate* coordinate = nullptr;
  for (const Coordinate& candidate : model.coordinates) {
    const int row = dof.equation[dof.scalar_of(candidate)];
    if (row >= 0 && is_larger(std::abs(system.residual()[row]), is_rotation(model, candidate))) coordinate = &candidate;
  }
  if (coordinate)
    failure.place = place_of_joint(model, state, coordinate->joint, coordinate->component);
  else if (node >= 0)
    failure.place = place_of_node(model, state, node);
}

void find_largest_rotation(const StepSystem& system, StepResult::Failure& failure) {
  const StepConfiguration& configuration = system.configuration();
  failure.quantity = Quantity::Rotation;
  if (const int aliased = configuration.aliased_coordinate(); aliased >= 0) {
    const Coordinate& coordinate = configuration.model().coordinates[aliased];
    failure.place =
        place_of_joint(configuration.model(), configuration.state(), coordinate.joint, coordinate.component);
    failure.amount = configuration.turn_of(coordinate);
    return;
  }
  const StepConfiguration::LargestIncrement largest = configuration.largest_increment();
  failure.place = place_of_node(configuration.model(), configuration.state(), largest.node);
  failure.amount = 2 * std::atan(0.5 * largest.size);
}

/// Rotation of a node from its element's reference. If the reference lies half-way between two nodes, and the node is
/// one of these: the rotation between the two.
template <int N>
double bending(const LocalRotations<N>& local, int i) {
  const ReferenceNodes reference = LocalRotations<N>::reference;
  const bool is_of_pair = reference.first != reference.second && (i == reference.first || i == reference.second);
  return (is_of_pair ? 2 : 1) * local.rotation_vectors()[i].norm();
}

/// Whether an element is bent up to the limit of its interpolation; if so, sets the place.
bool find_bent_element(const StepSystem& system, StepResult::Failure& failure) {
  if (system.configuration().scheme().interpolation != Interpolation::Local) return false;
  const Model& model = system.configuration().model();
  const State& state = system.configuration().state();
  double largest = kNearlyATurn;
  for_each_group(model.beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group.elements)>::value_type::kNodes;
    for (std::size_t e = 0; e < group.elements.size(); ++e) {
      const ElementConfiguration<N> nodes(group.elements[e], state);
      const LocalRotations<N> local(nodes.orientation);
      for (int i = 0; i < N; ++i) {
        if (!(bending(local, i) > largest)) continue;
        largest = bending(local, i);
        failure.place = place_of_element(model, state, N - 1, static_cast<int>(e), group.elements[e].nodes.front());
        failure.quantity = Quantity::Bending;
        failure.amount = largest;
      }
    }
  });
  return failure.quantity == Quantity::Bending;
}

/// Whether a loop is at a dead point in the configuration at the beginning of the step; if so, sets the place.
bool find_dead_point(const StepSystem& system, StepResult::Failure& failure) {
  const StepConfiguration& configuration = system.configuration();
  const int closure = closure_at_dead_point(configuration.model(), system.degrees_of_freedom(), configuration.state());
  if (closure >= 0) failure.place = place_of_loop(configuration.model(), configuration.state(), closure);
  return closure >= 0;
}

/// Sets the place that belongs to `failure.cause`.
void find_place(const StepSystem& system, StepResult::Failure& failure) {
  const StepConfiguration& configuration = system.configuration();
  switch (failure.cause) {
    case Reason::RotationTooLarge:
      return find_largest_rotation(system, failure);
    case Reason::SingularTangent:
      failure.place = place_of_variable(system, system.tangent().singular_variable());
      return;
    case Reason::OffTheLine:
    case Reason::DrivenOffTheLine:
      failure.place = place_of_joint(configuration.model(), configuration.state(), configuration.off_line_joint());
      return;
    case Reason::OpenLoop:
      failure.place = place_of_loop(configuration.model(), configuration.state(), system.largest_opening().closure);
      return;
    case Reason::NotFinite:
      if (system.not_finite_force() >= 0) {
        failure.place = place_of_force_element(configuration.model(), configuration.state(), system.not_finite_force());
        return;
      }
      return find_largest_residual(system, failure);
    case Reason::NoConvergence:
      return find_largest_residual(system, failure);
    case Reason::None:
    case Reason::BentTooFar:
    case Reason::DeadPoint:
    case Reason::OutOfTime:
    case Reason::HitTooFast:
    case Reason::EventWithin:
    case Reason::NeverRests:
      return;
  }
}

}  // namespace

void locate_failure(const StepSystem& system, StepResult& result) {
  StepResult::Failure& failure = result.failure;
  failure.time = system.configuration().state().time;
  failure.step = system.configuration().step();
  // These checks are slow, but give a more specific reason than a failed iteration.
  if (result.reason != Reason::None && find_bent_element(system, failure))
    result.reason = Reason::BentTooFar;
  else if (result.reason == Reason::NoConvergence && find_dead_point(system, failure))
    result.reason = Reason::DeadPoint;
  failure.cause = result.reason;
  if (!failure.place.is_known()) find_place(system, failure);
}

}  // namespace flexarm
