#include <map>
#include <stdexcept>

#include <pybind11/stl.h>

#include <fmt/format.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/effort_rows.h"
#include "python/names.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

ServoMode mode_of(const std::string& name) {
  if (const std::optional<ServoMode> mode = servo_mode_called(name)) return *mode;
  throw std::invalid_argument("mode: expected 'effort', 'velocity' or 'position', got '" + name + "'");
}

Vector3 vector_of(const py::handle& wrench, const char* field) {
  const Array numbers = Array::ensure(wrench.attr(field));
  if (!numbers) throw py::error_already_set();
  if (numbers.ndim() != 1 || numbers.size() != 3)
    throw std::invalid_argument(
        fmt::format("{} of a wrench: expected three numbers, got the shape {}", field, shape_text(numbers)));
  return Vector3(numbers.data());
}

/// Converts a flexarm.Wrench.
AppliedWrench wrench_of(const Simulation& simulation, const py::handle& given) {
  AppliedWrench applied;
  applied.link = link_index(simulation, given.attr("link").cast<Key>());
  applied.at = vector_of(given, "at");
  applied.wrench = {vector_of(given, "force"), vector_of(given, "moment")};
  applied.follows = given.attr("follows").cast<bool>();
  applied.pull = {vector_of(given, "target"), given.attr("stiffness").cast<double>(),
                  given.attr("damping").cast<double>()};
  return applied;
}

void apply_wrenches(GuardedSimulation& guarded, const py::iterable& given) {
  Simulation& simulation = guarded.use();
  std::vector<AppliedWrench> wrenches;
  for (const py::handle& wrench : given) wrenches.push_back(wrench_of(simulation, wrench));
  simulation.apply_wrenches(wrenches);
}

using JointValues = std::map<std::string, double>;

void set_joint_state(GuardedSimulation& guarded, const JointValues& positions, const JointValues& velocities) {
  Simulation& simulation = guarded.use();
  std::map<std::size_t, CoordinateState> states;
  const auto of = [&](const std::string& joint) -> CoordinateState& {
    const std::size_t index = joint_index(simulation, joint);
    states[index].coordinate = index;
    return states[index];
  };
  for (const auto& [joint, position] : positions) of(joint).position = position;
  for (const auto& [joint, velocity] : velocities) of(joint).velocity = velocity;
  std::vector<CoordinateState> list;
  for (const auto& state : states) list.push_back(state.second);
  simulation.set_joint_state(list);
}

/// Makes a method that commands one joint, from the next step on.
template <class... Values>
auto to_joint(void (Simulation::*command)(std::size_t, Values...)) {
  return [command](GuardedSimulation& guarded, const Key& joint, Values... values) {
    Simulation& simulation = guarded.use();
    (simulation.*command)(joint_index(simulation, joint), values...);
  };
}

void bind_efforts(SimulationClass& type) {
  type.def("command_effort", to_joint(&Simulation::command_effort),
           R"(Commands an effort [N m or N] from the next step on, instead of the scene's.

It saturates at the joint's limit. Raises ValueError if it is not finite, or if no effort can be commanded to the
joint (see effort_joints).)",
           py::arg("joint"), py::arg("effort"))
      .def(
          "command_efforts",
          [](GuardedSimulation& guarded, const Array& efforts, const std::optional<std::vector<Key>>& joints) {
            Simulation& simulation = guarded.use();
            EffortRows(simulation, efforts, joints, 1).command(simulation, 0);
          },
          R"(Commands efforts of several joints, shape (joints,) [N m or N]; see command_effort().

joints: names or indices; None: all of effort_joints.)",
          py::arg("efforts"), py::arg("joints") = py::none())
      .def("release_command", to_joint(&Simulation::release_command),
           "Returns to the scene's effort of a joint, zero if it has none.", py::arg("joint"));
}

void bind_servos(SimulationClass& type) {
  type.def("command_set_point", to_joint(&Simulation::command_set_point),
           R"(Gives a joint's servo a set point from the next step on, instead of the scene's.

set_point: effort, velocity or position, depending on the servo's mode [rad, m, rad/s, m/s, N m or N].
rate, acceleration: first and second derivative of a moving set point [per s, per s^2]. All three are values at the end
  of the next step.
Raises ValueError if one is not finite, or the joint has no servo (see servo_joints).)",
           py::arg("joint"), py::arg("set_point"), py::arg("rate") = 0.0, py::arg("acceleration") = 0.0)
      .def(
          "set_point",
          [](GuardedSimulation& guarded, const Key& joint) {
            return guarded.use().set_point(joint_index(guarded.use(), joint));
          },
          "Set point of a joint's servo at the end of the next step, in the unit of its mode.", py::arg("joint"))
      .def("release_set_point", to_joint(&Simulation::release_set_point),
           "Returns to the scene's set point and mode of a joint's servo.", py::arg("joint"))
      .def("switch_servo", to_joint(&Simulation::switch_servo),
           R"(Switches a joint's servo off or on, from the next step on.

While it is off, its motor gives no effort, not even a commanded one. Switched on again, its integral is zero.)",
           py::arg("joint"), py::arg("on"))
      .def(
          "switch_mode",
          [](GuardedSimulation& guarded, const Key& joint, const std::string& mode) {
            Simulation& simulation = guarded.use();
            simulation.switch_mode(joint_index(simulation, joint), mode_of(mode));
          },
          R"(Switches a servo to 'effort', 'velocity' or 'position' from the next step on, without a jump of its effort.

Its set point becomes the present position, velocity or effort; if the new mode has no `ki`, it becomes the set
point that gives the same effort.
Raises ValueError if the scene has no gains of that mode for the servo.)",
          py::arg("joint"), py::arg("mode"))
      .def(
          "servo_mode",
          [](GuardedSimulation& guarded, const Key& joint) {
            return to_string(guarded.use().servo_mode(joint_index(guarded.use(), joint)));
          },
          "What a joint's servo controls: 'effort', 'velocity' or 'position'.", py::arg("joint"));
}

}  // namespace

void bind_commands(SimulationClass& type) {
  bind_efforts(type);
  bind_servos(type);
  type.def("apply_wrenches", &apply_wrenches,
           R"(Applies wrenches from the next step on, which replace all applied before; [] removes them.

wrenches: a list of flexarm.Wrench.
Raises ValueError, and changes nothing, if one is not finite, its link is fixed to the world, or it pulls on a link and
the scheme does not support that.)",
           py::arg("wrenches"))
      .def("set_joint_state", &set_joint_state,
           R"(Sets positions or velocities of joints at once.

The links that they carry move with them, without changing their shape.
positions, velocities: by names of joints [rad or m, rad/s or m/s]; values that are not given stay.
Raises ValueError, and changes nothing, if a number is not finite, a position is beyond its limits, a joint is
prescribed or mimics another, or if a loop would not stay closed.)",
           py::arg("positions") = JointValues(), py::arg("velocities") = JointValues());
}

}  // namespace flexarm::python
