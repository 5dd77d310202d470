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
    throw std::runtime_error("links have come or gone since this state was: it can be restored no more");
  Simulation copy = origin_->use().copy();
  copy.restore(snapshot_);
  return checkpoint_text(copy);
}

void SavedState::give_to(GuardedSimulation& simulation) const {
  // Simulations made of the same Scene twice share no snapshots, but their checkpoints fit.
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
  py::class_<SavedState> state(module, "State", R"(All of a simulation that time changes, commands included: a value.

Simulation.snapshot() makes it, Simulation.restore() goes back to it. It can be pickled, and bytes(state) are what
write_checkpoint() writes; State(bytes) makes one of them. To restore one in another process, make a simulation of the
same scene there.)");
  state.attr("__module__") = "flexarm";
  state.def(py::init([](const py::bytes& text) { return SavedState(std::string(text)); }), py::arg("checkpoint"))
      .def("__bytes__", [](const SavedState& s) { return py::bytes(s.text()); })
      .def("__copy__", [](const SavedState& s) { return s; })
      .def(
          "__deepcopy__", [](const SavedState& s, const py::dict&) { return s; }, py::arg("memo"))
      .def(py::pickle([](const SavedState& s) { return py::bytes(s.text()); },
                      [](const py::bytes& text) { return SavedState(std::string(text)); }));

  type.def(
          "snapshot", [](const Pointer& s) { return SavedState(s); }, "What it is like now, as a State.")
      .def(
          "restore", [](GuardedSimulation& s, const SavedState& saved) { saved.give_to(s); },
          R"(Goes back to a State, commands included.

Raises ValueError if it is another scene's, scheme's or step's; nothing has changed then. Bit for bit the motion goes on
as it did with reuse_factorisation=False, else to far below Newton's tolerance.)",
          py::arg("state"))
      .def(
          "reset", [](GuardedSimulation& s) { s.use().reset(); },
          "Goes back to the scene's initial state; commands are forgotten.")
      .def("__copy__", &copy_of, "Another one of the same scene and settings, in the same state.")
      .def(
          "__deepcopy__", [](GuardedSimulation& s, const py::dict&) { return copy_of(s); }, py::arg("memo"))
      .def(
          "take_over",
          [](GuardedSimulation& s, GuardedSimulation& other) {
            const Simulation& from = other.use();
            s.use().take_over(from);
          },
          R"(Goes on from where another one is, of the same scene but for its integrator, gravity and gains of servos.

Joints and links stand and move as they did. Raises ValueError if it is not the same mechanism.)",
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
