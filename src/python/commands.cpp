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

/// Of a flexarm.Wrench.
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

/// A command to one joint, from the next step on.
template <class... Values>
auto to_joint(void (Simulation::*command)(std::size_t, Values...)) {
  return [command](GuardedSimulation& guarded, const Key& joint, Values... values) {
    Simulation& simulation = guarded.use();
    (simulation.*command)(joint_index(simulation, joint), values...);
  };
}

void bind_efforts(SimulationClass& type) {
  type.def("command_effort", to_joint(&Simulation::command_effort),
           R"(Commands an effort [N m or N] from the next step on, in place of the scene's.

It saturates at the joint's limit. Raises ValueError if it is not finite, or the joint takes none (effort_joints).)",
           py::arg("joint"), py::arg("effort"))
      .def(
          "command_efforts",
          [](GuardedSimulation& guarded, const Array& efforts, const std::optional<std::vector<Key>>& joints) {
            Simulation& simulation = guarded.use();
            EffortRows(simulation, efforts, joints, 1).command(simulation, 0);
          },
          R"(Commands efforts of several joints, shape (joints,) [N m or N]; see command_effort().

joints: which ones, by names or indices; None: all of effort_joints.)",
          py::arg("efforts"), py::arg("joints") = py::none())
      .def("release_command", to_joint(&Simulation::release_command),
           "Goes back to the scene's effort of a joint, zero where there is none.", py::arg("joint"));
}

void bind_servos(SimulationClass& type) {
  type.def("command_set_point", to_joint(&Simulation::command_set_point),
           R"(Gives a joint's servo a set point from the next step on, in place of the scene's.

set_point: of what its mode names [rad, m, rad/s, m/s, N m or N].
rate, acceleration: of one that moves, at the end of the next step [over s, over s^2]; `set_point` is as of then, too.
Raises ValueError if one is not finite, or the joint has no servo (servo_joints).)",
           py::arg("joint"), py::arg("set_point"), py::arg("rate") = 0.0, py::arg("acceleration") = 0.0)
      .def(
          "set_point",
          [](GuardedSimulation& guarded, const Key& joint) {
            return guarded.use().set_point(joint_index(guarded.use(), joint));
          },
          "What a joint's servo is asked for at the end of the next step [as its mode says].", py::arg("joint"))
      .def("release_set_point", to_joint(&Simulation::release_set_point),
           "Goes back to the scene's set point and mode of a joint's servo.", py::arg("joint"))
      .def("switch_servo", to_joint(&Simulation::switch_servo),
           R"(Switches a joint's servo off or on, from the next step on.

Off, its motor gives no effort, commanded ones included; on again, it has no memory in its integral.)",
           py::arg("joint"), py::arg("on"))
      .def(
          "switch_mode",
          [](GuardedSimulation& guarded, const Key& joint, const std::string& mode) {
            Simulation& simulation = guarded.use();
            simulation.switch_mode(joint_index(simulation, joint), mode_of(mode));
          },
          R"(Lets a joint's servo control 'effort', 'velocity' or 'position', from the next step on, and its effort goes on.

Its set point is the position, velocity or effort of now; without a `ki` to go on by, the one that gives the same effort.
Raises ValueError if the scene has no gains of that mode for it.)",
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
           R"(Applies wrenches from the next step on, in place of all that were applied before; []: takes these away.

wrenches: of flexarm.Wrench.
Raises ValueError if one is not finite, its link is fixed to the world, or it pulls and the scheme does not let it;
nothing has changed then.)",
           py::arg("wrenches"))
      .def(
          "set_joint_state", &set_joint_state,
          R"(Puts joints elsewhere at once, or gives them other velocities; what hangs on them moves with them as it is.

positions, velocities: by names of joints [rad or m, rad/s or m/s]; what is not given stays.
Raises ValueError if a number is not finite, a position beyond its limits, a joint prescribed or a follower, or if a loop
does not stay closed; nothing has changed then.)",
          py::arg("positions") = JointValues(), py::arg("velocities") = JointValues());
}

}  // namespace flexarm::python
