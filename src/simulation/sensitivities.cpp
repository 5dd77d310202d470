#include "flexarm/simulation/sensitivities.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "analysis/mechanism_states.h"
#include "flexarm/model/model_error.h"
#include "flexarm/scene/scene_description.h"
#include "math/so3.h"
#include "model/state_numbers.h"
#include "simulation/inside.h"
#include "simulation/linear_names.h"
#include "simulation/linear_ports.h"
#include "simulation/sensitivity_directions.h"

namespace flexarm {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Whether the simulation is at its start. Commands do not count.
bool is_at_start(const Simulation& simulation) {
  State own = state_of(simulation), start = initial_state_of(simulation);
  if (own.steps != 0 || own.history.count != 0) return false;
  for (State* state : {&own, &start}) {
    state->wrenches.clear();
    state->commands.clear();
    for (ActuatorState& actuator : state->actuators) static_cast<ServoCommand&>(actuator.servo) = {};
  }
  std::vector<double> numbers;
  for_each_number(start, [&](const char*, double number) { numbers.push_back(number); });
  std::size_t i = 0;
  bool is_same = true;
  for_each_number(own, [&](const char*, double number) {
    is_same = is_same && i < numbers.size() && (number == numbers[i] || std::isnan(number));
    ++i;
  });
  return is_same && i == numbers.size();
}

}  // namespace

class Sensitivities::Implementation {
 public:
  Implementation(Simulation& own, SensitivityRequest wanted)
      : simulation(own), request(std::move(wanted)), steps(model_of(own), scheme_of(own)) {
    if (!is_at_start(own))
      throw std::invalid_argument("derivatives need the whole run: the simulation has moved; call reset() first");
    if (scheme_of(own).tableau)
      throw std::invalid_argument(fmt::format(
          "derivatives follow the equations of implicit steps; '{}' is an explicit scheme", scheme_of(own).name));
    for (const std::string& name : request.parameters) {
      parameters.push_back(std::make_unique<ParameterDirection>(simulation, request, name));
      names.push_back(name);
      steps.directions().push_back(parameters.back()->start(steps));
    }
    if (request.initial_state) {
      look = std::make_unique<Simulation>(own.copy());
      for (Direction& direction : initial_state_directions(own, steps, names))
        steps.directions().push_back(std::move(direction));
    }
    take_samples(true);
  }

  StepResult step() {
    if (simulation.time() != time || state_of(simulation).steps != count)
      throw std::logic_error("the simulation was moved by other means since the last step of its sensitivities");
    const std::vector<int> lines = state_of(simulation).left_lines;
    const std::vector<HalvedElement> halved = state_of(simulation).halved;
    accompany(simulation, &steps);
    StepResult result = simulation.step();
    const State& state = state_of(simulation);
    if (state.left_lines != lines)
      steps.lose(fmt::format("a slider has left its line before t = {:.9g} s", simulation.time()));
    else if (state.halved != halved)
      steps.lose(fmt::format("elements were halved or joined before t = {:.9g} s", simulation.time()));
    else
      accompany(simulation, nullptr);
    if (!result.converged || result.is_dissipated)
      steps.lose(fmt::format("the step to t = {:.9g} s {}", time + simulation.step_size(),
                             result.converged ? "was done by another scheme" : "has failed"));
    time = simulation.time();
    count = state.steps;
    if (!steps.lost().empty()) return result;
    steps.settle(state);
    take_samples(false);
    for (std::size_t i = 0; i < parameters.size() && !steps.is_in_hit(); ++i)
      parameters[i]->come_closer(steps, steps.directions()[i], state);
    return result;
  }

  /// The simulation with the neighbour's model, in which its states are shown.
  Simulation& look_at(std::size_t direction, std::size_t neighbour) const {
    return direction < parameters.size() ? parameters[direction]->look(neighbour) : *look;
  }

  /// Lets neighbours take samples after the same steps as the run, and with the same step numbers, which determine the
  /// samples' errors.
  void take_samples(bool all) {
    if (simulation.scene().sensors.empty()) return;
    const State& state = state_of(simulation);
    const auto is_new = [&](const SensorSample& sample) { return sample.time == state.time; };
    if (!all && std::none_of(state.samples.begin(), state.samples.end(), is_new)) return;
    for (std::size_t k = 0; k < steps.directions().size(); ++k) {
      std::vector<Neighbour>& neighbours = steps.directions()[k].neighbours;
      for (std::size_t i = 0; i < neighbours.size(); ++i) {
        neighbours[i].state.steps = state.steps;
        neighbours[i].state.time = state.time;
        flexarm::take_samples(neighbours[i].state, look_at(k, i), all);
      }
    }
  }

  /// The difference quotient in each direction. `observe` returns a neighbour's value minus the run's.
  template <class Observe>
  MatrixXd derivative(Eigen::Index size, const Observe& observe) const {
    const Eigen::Index count = static_cast<Eigen::Index>(steps.directions().size());
    if (!steps.lost().empty()) return MatrixXd::Constant(size, count, std::numeric_limits<double>::quiet_NaN());
    MatrixXd out = MatrixXd::Zero(size, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Direction& direction = steps.directions()[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < direction.neighbours.size(); ++i) {
        Simulation& neighbour = look_at(static_cast<std::size_t>(k), i);
        show(direction.neighbours[i].state, neighbour);
        out.col(k) += direction.neighbours[i].weight / direction.difference * observe(neighbour);
      }
    }
    return out;
  }

  Simulation& simulation;
  SensitivityRequest request;
  NeighbourSteps steps;
  std::vector<std::unique_ptr<ParameterDirection>> parameters;
  std::unique_ptr<Simulation> look;  // shows states of neighbours that have the run's own model
  std::vector<std::string> names;
  double time = simulation.time();
  long count = 0;  // number of steps done
};

Sensitivities::Sensitivities(Simulation& simulation, const SensitivityRequest& request)
    : implementation_(std::make_unique<Implementation>(simulation, request)) {}
Sensitivities::~Sensitivities() = default;
Sensitivities::Sensitivities(Sensitivities&&) noexcept = default;
Sensitivities& Sensitivities::operator=(Sensitivities&&) noexcept = default;

StepResult Sensitivities::step() {
  return implementation_->step();
}
const std::vector<std::string>& Sensitivities::directions() const {
  return implementation_->names;
}
const std::string& Sensitivities::lost() const {
  return implementation_->steps.lost();
}

const std::vector<RunEvent>& Sensitivities::events() const {
  return implementation_->steps.events();
}

MatrixXd Sensitivities::of(const std::function<VectorXd(const Simulation&)>& observable) const {
  const VectorXd own = observable(implementation_->simulation);
  return implementation_->derivative(own.size(), [&](const Simulation& neighbour) -> VectorXd {
    const VectorXd there = observable(neighbour);
    if (there.size() != own.size())
      throw std::invalid_argument(
          fmt::format("observable: expected {} numbers of every simulation, got {}", own.size(), there.size()));
    return there - own;
  });
}

MatrixXd Sensitivities::positions() const {
  return of([](const Simulation& simulation) {
    VectorXd values(static_cast<Eigen::Index>(simulation.coordinate_names().size()));
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = simulation.position(static_cast<std::size_t>(i));
    return values;
  });
}

MatrixXd Sensitivities::velocities() const {
  return of([](const Simulation& simulation) {
    VectorXd values(static_cast<Eigen::Index>(simulation.coordinate_names().size()));
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = simulation.velocity(static_cast<std::size_t>(i));
    return values;
  });
}

MatrixXd Sensitivities::probe(std::size_t index) const {
  const Quaternion start = implementation_->simulation.probe_pose(index).orientation;
  return of([&](const Simulation& simulation) {
    const ProbeState probe = simulation.probe(index);
    const Quaternion turned = probe.pose.orientation * start.conjugate();
    VectorXd values(12);
    values << probe.pose.position, so3::log(so3::nearer_of_two(turned, Quaternion(Quaternion::Identity()))),
        probe.velocity, probe.angular_velocity;
    return values;
  });
}

MatrixXd Sensitivities::outputs(const std::vector<std::string>& names) const {
  const Simulation& own = implementation_->simulation;
  const std::vector<LinearPort> ports = output_ports(own, names);
  return of([&](const Simulation& simulation) { return port_values(simulation, own, ports); });
}

std::vector<std::string> Sensitivities::output_names(const std::vector<std::string>& names) const {
  std::vector<std::string> all;
  for (const LinearPort& port : output_ports(implementation_->simulation, names)) all.push_back(port.name);
  return all;
}

MatrixXd Sensitivities::states() const {
  const Simulation& own = implementation_->simulation;
  const MechanismStates states(model_of(own), motion_of(own));
  return implementation_->derivative(
      states.size(), [&](const Simulation& neighbour) { return states.deviation(motion_of(neighbour)); });
}

std::vector<std::string> Sensitivities::state_names() const {
  const Simulation& own = implementation_->simulation;
  const MechanismStates states(model_of(own), motion_of(own));
  std::vector<std::string> names =
      coordinate_names(model_of(own), states.degrees_of_freedom(), states.scalars(), states.rotors());
  const std::size_t count = names.size();
  for (std::size_t i = 0; i < count; ++i) names.push_back("d/dt " + names[i]);
  return names;
}

}  // namespace flexarm
