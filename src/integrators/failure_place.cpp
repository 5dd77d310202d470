#include "integrators/failure_place.h"

#include <algorithm>
#include <cmath>

#include "elements/element_configuration.h"
#include "math/pi.h"

namespace flexarm {
namespace {

using Place = StepResult::Place;
using Quantity = StepResult::Failure::Quantity;
using Reason = StepResult::Reason;

/// Local rotations end at two half turns from the reference node (LocalRotations). A step that starts so near to that,
/// and fails, has failed at it [rad].
constexpr double kNearlyATurn = 0.95 * 2 * kPi;

// ---------------------------------------------------------------- from parts of the model to places

/// The place of an element, by its index in the group of its order.
Place place_of_element(const Model& model, const State& state, int order, int index, int node) {
  Place place;
  place.position = state.nodes[node].position;
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    const std::optional<BeamLink>& beam = model.links[link].beam;
    if (!beam || beam->order != order) continue;
    const auto found = std::find(beam->elements.begin(), beam->elements.end(), index);
    if (found == beam->elements.end()) continue;
    place.link = static_cast<int>(link);
    place.element = static_cast<int>(found - beam->elements.begin());
  }
  return place;
}

/// The first element that has the node, or the rigid link that is fixed to it.
Place place_of_node(const Model& model, const State& state, int node) {
  Place place;
  for_each_group(model.beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group.elements)>::value_type::kNodes;
    for (std::size_t e = 0; e < group.elements.size() && place.link < 0; ++e) {
      const auto& nodes = group.elements[e].nodes;
      if (std::find(nodes.begin(), nodes.end(), node) != nodes.end())
        place = place_of_element(model, state, N - 1, static_cast<int>(e), node);
    }
  });
  if (place.link >= 0) return place;
  place.position = state.nodes[node].position;
  for (std::size_t link = 0; link < model.links.size() && place.link < 0; ++link)
    if (model.links[link].frame.node == node) place.link = static_cast<int>(link);
  return place;
}

/// The coordinate; where the joint has none, what it holds.
Place place_of_joint(const Model& model, const State& state, int joint, int component = 0) {
  Place place = place_of_node(model, state, model.joints[joint].slave);
  for (std::size_t i = 0; i < model.coordinates.size(); ++i)
    if (model.coordinates[i].joint == joint && model.coordinates[i].component == component)
      place.coordinate = static_cast<int>(i);
  return place;
}

Place place_of_loop(const Model& model, const State& state, int loop) {
  Place place;
  place.position = state.nodes[model.closures[loop].child].position;
  place.loop = loop;
  return place;
}

/// Of a variable of DegreesOfFreedom.
Place place_of_variable(const StepSystem& system, int variable) {
  const Model& model = system.configuration().model();
  const State& state = system.configuration().state();
  const DegreesOfFreedom& dof = system.degrees_of_freedom();
  if (variable < 0) return {};
  if (variable < dof.node_count) return place_of_node(model, state, variable);
  if (variable < dof.node_count + dof.joint_count) return place_of_joint(model, state, variable - dof.node_count);
  return place_of_loop(model, state, variable - dof.node_count - dof.joint_count);
}

// ---------------------------------------------------------------- what stands out

/// The largest force or moment that is left; moments count by the mechanism's length. What is not a number is larger
/// than all else.
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
  const std::vector<Vector3>& increments = configuration.increments();
  const auto largest = std::max_element(
      increments.begin(), increments.end(),
      [](const Vector3& one, const Vector3& other) { return one.squaredNorm() < other.squaredNorm(); });
  failure.place =
      place_of_node(configuration.model(), configuration.state(), static_cast<int>(largest - increments.begin()));
  failure.quantity = Quantity::Rotation;
  failure.amount = 2 * std::atan(0.5 * largest->norm());  // they are tangent-scaled
}

/// Rotation of a node from its element's reference; of the two nodes half-way between which that lies, from each other.
template <int N>
double bending(const LocalRotations<N>& local, int i) {
  const ReferenceNodes reference = LocalRotations<N>::reference;
  const bool is_of_pair = reference.first != reference.second && (i == reference.first || i == reference.second);
  return (is_of_pair ? 2 : 1) * local.rotation_vectors()[i].norm();
}

/// True if an element is bent as far as its interpolation goes.
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

}  // namespace

void locate_failure(const StepSystem& system, StepResult& result) {
  const StepConfiguration& configuration = system.configuration();
  StepResult::Failure& failure = result.failure;
  failure.time = configuration.state().time;
  failure.step = configuration.step();
  if (result.reason != Reason::EnergyDefect && find_bent_element(system, failure)) {
    result.reason = Reason::BentTooFar;
    return;
  }
  switch (result.reason) {
    case Reason::RotationTooLarge:
      return find_largest_rotation(system, failure);
    case Reason::SingularTangent:
      failure.place = place_of_variable(system, system.tangent().singular_variable());
      return;
    case Reason::OffTheLine:
      failure.place = place_of_joint(configuration.model(), configuration.state(), configuration.off_line_joint());
      return;
    case Reason::OpenLoop:
      failure.place = place_of_loop(configuration.model(), configuration.state(), system.largest_opening().closure);
      return;
    case Reason::NoConvergence:
    case Reason::NotFinite:
      return find_largest_residual(system, failure);
    case Reason::None:
    case Reason::EnergyDefect:
    case Reason::BentTooFar:
      return;
  }
}

}  // namespace flexarm
