#include "simulation/sensitivity_directions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/mechanism_states.h"
#include "flexarm/model/model_error.h"
#include "flexarm/scene/scene_description.h"
#include "model/state_numbers.h"
#include "simulation/inside.h"
#include "simulation/linear_names.h"

namespace flexarm {
namespace {

/// Largest difference of a parameter, relative to its value. Within it, the result of a single step is a smooth
/// function of the parameter.
constexpr double kLargestDifference = 3e-4;
/// Neighbours whose distance exceeds the best one by this factor are placed closer, which requires new models.
constexpr double kTooFar = 3;
/// Relative difference for derivatives at the start, with the formula of fourth order. It is larger, since initial
/// accelerations are differences over 1e-2 of a step, with more round-off.
constexpr double kStartDifference = 1e-2;
const std::vector<std::pair<double, double>> kFourthOrder = {{1, 2. / 3}, {-1, -2. / 3}, {2, -1. / 12}, {-2, 1. / 12}};
const std::vector<std::pair<double, double>> kCentral = {{1, 0.5}, {-1, -0.5}}, kAbove = {{1, 2}, {2, -0.5}},
                                             kBelow = {{-1, -2}, {-2, 0.5}};

bool is_the_same(const IntegratorDescription& a, const IntegratorDescription& b) {
  return a.step == b.step && a.beta == b.beta && a.gamma == b.gamma && a.alpha == b.alpha &&
         a.rho_infinity == b.rho_infinity;
}

/// All numbers of a state for comparisons, with 0 in the place of NaN.
std::vector<double> numbers_of(const State& state) {
  std::vector<double> numbers;
  for_each_number(state, [&](const char*, double number) { numbers.push_back(std::isnan(number) ? 0 : number); });
  return numbers;
}

/// Whether two simulations have the same unknowns, so that factors of one can solve for the other.
bool is_alike(const Simulation& a, const Simulation& b) {
  const Model &model = model_of(a), &other = model_of(b);
  if (model.nodes.size() != other.nodes.size() || a.coordinate_names() != b.coordinate_names()) return false;
  const DegreesOfFreedom dof(model), other_dof(other);
  return dof.equation == other_dof.equation && model.node_parents == other.node_parents &&
         model.histories.size() == other.histories.size() &&
         numbers_of(initial_state_of(a)).size() == numbers_of(initial_state_of(b)).size();
}

}  // namespace

/// A simulation with another value of the parameter, or why there is none.
struct ParameterDirection::Attempt {
  std::optional<Simulation> simulation;
  std::string fault;
};

ParameterDirection::ParameterDirection(const Simulation& simulation, const SensitivityRequest& request,
                                       const std::string& name)
    : simulation_(simulation), request_(request), name_(name) {
  const auto& parameters = simulation.scene().parameters;
  const auto known = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const scene::ParameterDescription& own) { return own.name == name; });
  if (known == parameters.end()) {
    std::vector<std::string> names;
    names.reserve(parameters.size());
    for (const scene::ParameterDescription& own : parameters) names.push_back(own.name);
    throw std::invalid_argument(
        names.empty() ? fmt::format("unknown parameter '{}': the scene has no <parameter>", name)
                      : fmt::format("unknown parameter '{}': expected one of {}", name, fmt::join(names, ", ")));
  }
  if (!request.read) throw std::invalid_argument("parameters need a scene that can be read again");
  value_ = known->value;
  if (value_ != 0) scale_ = std::abs(value_);
  if (const scene::ReadResult again = request_.read(name_, value_); again.scene) integrator_ = again.scene->integrator;
  if (numbers_of(initial_state_of(built(value_))) != numbers_of(initial_state_of(simulation)))
    throw std::invalid_argument("the scene that was read again differs from that of the simulation");
  choose_side();
}

ParameterDirection::Attempt ParameterDirection::attempt(double value) const {
  try {
    scene::ReadResult result = request_.read(name_, value);
    if (!result.scene) return {std::nullopt, scene::to_text(result.diagnostics)};
    const IntegratorDescription& own = first_integrator_of(simulation_);
    IntegratorDescription& integrator = result.scene->integrator;
    if (!is_the_same(integrator, integrator_)) return {std::nullopt, "it changes the <integrator>"};
    integrator.scheme = own.scheme;
    integrator.step = own.step;
    integrator.on_failure = own.on_failure;
    integrator.tolerance = own.tolerance;
    Attempt out{Simulation(std::move(*result.scene)), ""};
    if (!is_alike(simulation_, *out.simulation))
      return {std::nullopt, "it changes the numbers of nodes, joints or unknowns"};
    return out;
  } catch (const ModelError& error) {
    return {std::nullopt, error.what()};
  }
}

Simulation ParameterDirection::built(double value) const {
  Attempt made = attempt(value);
  if (made.simulation) return std::move(*made.simulation);
  while (!made.fault.empty() && made.fault.back() == '\n') made.fault.pop_back();
  throw std::invalid_argument(fmt::format(
      "the run cannot be differentiated with respect to parameter '{}': with {:.17g} instead of {:.17g}: {}", name_,
      value, value_, made.fault));
}

/// Chooses central differences, or one-sided ones at an end of the parameter's range.
void ParameterDirection::choose_side() {
  const double way = kLargestDifference * scale_;
  const bool above = attempt(value_ + way).simulation.has_value();
  if (attempt(value_ - way).simulation.has_value())
    rule_ = above ? kCentral : kBelow;
  else if (above)
    rule_ = kAbove;
  else
    built(value_ + way);  // throws, and says why not
}

void ParameterDirection::set_neighbours(Direction& direction) {
  looks_.clear();
  direction.neighbours.clear();
  for (const auto& [offset, weight] : rule_) {
    Simulation& look = looks_.emplace_back(built(value_ + offset * direction.difference));
    const Scheme scheme = scheme_of(look);
    direction.neighbours.push_back(
        {offset, weight, std::make_unique<StepSystem>(model_of(look), scheme), initial_state_of(look)});
  }
}

std::vector<double> ParameterDirection::derivative_at_start(NeighbourSteps& steps) const {
  Direction direction;
  direction.difference = rule_ == kCentral ? kStartDifference * scale_ : kLargestDifference * scale_;
  const auto add = [&](const std::vector<std::pair<double, double>>& rule) {
    for (const auto& [offset, weight] : rule)
      direction.neighbours.push_back(
          {offset, weight, nullptr, initial_state_of(built(value_ + offset * direction.difference))});
  };
  const double reach = 2 * direction.difference;
  const bool has_room = rule_ == kCentral && attempt(value_ + reach).simulation && attempt(value_ - reach).simulation;
  if (rule_ == kCentral && !has_room) direction.difference = kLargestDifference * scale_;
  add(has_room ? kFourthOrder : rule_);
  steps.measure(direction, state_of(simulation_));
  return direction.derivative;
}

Direction ParameterDirection::start(NeighbourSteps& steps) {
  Direction direction;
  direction.difference = kLargestDifference * scale_;
  set_neighbours(direction);
  direction.derivative = derivative_at_start(steps);
  const State& state = state_of(simulation_);
  steps.place(direction, state);
  come_closer(steps, direction, state);
  return direction;
}

void ParameterDirection::come_closer(NeighbourSteps& steps, Direction& direction, const State& state) {
  const double way = steps.distance(direction, state, simulation_.step_size());
  if (way <= kTooFar * NeighbourSteps::kDistance) return;
  steps.measure(direction, state);
  direction.difference *= NeighbourSteps::kDistance / way;
  set_neighbours(direction);
  steps.place(direction, state);
}

std::vector<Direction> initial_state_directions(const Simulation& simulation, NeighbourSteps& steps,
                                                std::vector<std::string>& names) {
  const State& state = state_of(simulation);
  const MechanismStates states(model_of(simulation), motion_of(simulation));
  const std::vector<std::string> positions =
      coordinate_names(model_of(simulation), states.degrees_of_freedom(), states.scalars(), states.rotors());
  const int count = static_cast<int>(positions.size());
  std::vector<Direction> directions;
  for (int k = 0; k < 2 * count; ++k) {
    const auto name = positions.begin() + k % count;
    names.push_back(k < count ? *name : "d/dt " + *name);
    Direction direction;
    direction.has_free_difference = true;
    // Rates may differ by more, since a large rate does not strain beams.
    direction.difference = k < count ? kLargestDifference : kStartDifference;
    for (const auto& [offset, weight] : kFourthOrder) {
      const MechanismMotion motion = states.moved(k, offset * direction.difference);
      direction.neighbours.push_back({offset, weight, nullptr, start_at(simulation, motion)});
    }
    steps.measure(direction, state);
    direction.neighbours.erase(direction.neighbours.begin() + 2, direction.neighbours.end());
    for (std::size_t i = 0; i < kCentral.size(); ++i)
      std::tie(direction.neighbours[i].offset, direction.neighbours[i].weight) = kCentral[i];
    steps.place(direction, state);
    directions.push_back(std::move(direction));
  }
  return directions;
}

}  // namespace flexarm
