#include "python/saved_state.h"

#include <stdexcept>

#include <pybind11/stl.h>

#include "flexarm/simulation/checkpoint.h"
#include "python/bindings.h"
#include "python/path_argument.h"

namespace py = pybind11;

namespace flexarm::python {

std::string SavedState::text() const {
  if (!origin_) return text_;
  if (family_ != origin_->family())
    throw std::runtime_error("links were added or removed after this state was saved: it can no longer be restored");
  Simulation copy = origin_->use().copy();
  copy.restore(snapshot_);
  return checkpoint_text(copy);
}

void SavedState::give_to(GuardedSimulation& simulation) const {
  // Two simulations made from the same Scene cannot exchange snapshots, but they can exchange checkpoints.
  if (origin_ && family_ == simulation.family()) {
    simulation.use().restore(snapshot_);
    return;
  }
  try {
    read_checkpoint_text(simulation.use(), text(), "state");
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(error.what());
  }
}

namespace {

using Pointer = std::shared_ptr<GuardedSimulation>;

Pointer copy_of(GuardedSimulation& simulation) {
  return simulation.copy();
}

}  // namespace

void bind_state(py::module_& module, SimulationClass& type) {
  py::class_<SavedState> state(module, "State",
                               R"(Everything in a simulation that changes over time, including commands; immutable.

Simulation.snapshot() makes it, Simulation.restore() returns to it. It can be pickled. bytes(state) has the contents of
a file of write_checkpoint(), and State(bytes) makes a state from them. To restore a state in another process, make a
simulation of the same scene there.)");
  state.attr("__module__") = "flexarm";
  state.def(py::init([](const py::bytes& text) { return SavedState(std::string(text)); }), py::arg("checkpoint"))
      .def("__bytes__", [](const SavedState& s) { return py::bytes(s.text()); })
      .def("__copy__", [](const SavedState& s) { return s; })
      .def(
          "__deepcopy__", [](const SavedState& s, const py::dict&) { return s; }, py::arg("memo"))
      .def(py::pickle([](const SavedState& s) { return py::bytes(s.text()); },
                      [](const py::bytes& text) { return SavedState(std::string(text)); }));

  type.def(
          "snapshot", [](const Pointer& s) { return SavedState(s); }, "The present state, as a State.")
      .def(
          "restore", [](GuardedSimulation& s, const SavedState& saved) { saved.give_to(s); },
          R"(Returns to a State, including its commands.

Raises ValueError, and changes nothing, if the scene, scheme or step differs. The motion continues as the original one:
with the same bits if reuse_factorisation=False, otherwise with differences far below Newton's tolerance.)",
          py::arg("state"))
      .def(
          "reset", [](GuardedSimulation& s) { s.use().reset(); },
          "Returns to the scene's initial state, without commands.")
      .def("__copy__", &copy_of, "A copy with the same scene and settings, in the same state.")
      .def(
          "__deepcopy__", [](GuardedSimulation& s, const py::dict&) { return copy_of(s); }, py::arg("memo"))
      .def(
          "take_over",
          [](GuardedSimulation& s, GuardedSimulation& other) {
            const Simulation& from = other.use();
            s.use().take_over(from);
          },
          R"(Continues from the state of another simulation.

The scenes may differ in integrator, gravity and gains of servos. Positions and velocities of joints and links are kept.
Raises ValueError if it is not the same mechanism.)",
          py::arg("other"))
      .def(
          "write_checkpoint",
          [](GuardedSimulation& s, const PathArgument& path) { write_checkpoint(s.use(), path.text); },
          "Writes its state to a file; RuntimeError if it cannot be written.", py::arg("path"))
      .def(
          "read_checkpoint",
          [](GuardedSimulation& s, const PathArgument& path) { read_checkpoint(s.use(), path.text); },
          R"(Takes the state that write_checkpoint() or `flexarm simulate --checkpoint` has written.

Raises RuntimeError naming the file and what is wrong with it; nothing has changed then.)",
          py::arg("path"));
}

}  // namespace flexarm::python
