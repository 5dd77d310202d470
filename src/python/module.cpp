/// The extension module flexarm._flexarm: the façade for Python (docs/python.md).

#include "python/bindings.h"

namespace py = pybind11;

namespace {

constexpr const char* kSimulationText = R"(A scene in motion.

    Simulation(scene, scheme=None, step=None, tolerance=None, reuse_factorisation=True, on_failure=None,
               recovery_wall_time=0)

SI units and radians throughout; world axes unless another frame is named; arrays are of float64, and copies. Joints
are coordinates: a joint with several of them has one name for each ("wrist/rx"). A joint, link or sensor is given by
its name or by its index in the list of names. copy.copy() makes another simulation in the same state.

One thread at a time may use a simulation; while it steps, other threads run, with simulations of their own.)";

}  // namespace

PYBIND11_MODULE(_flexarm, module) {
  using namespace flexarm::python;
  module.doc() = "Simulations of flexible manipulators, compiled; used by the package flexarm.";
  module.attr("__version__") = FLEXARM_VERSION;
  bind_scene(module);
  bind_step_result(module);
  SimulationClass simulation(module, "Simulation", kSimulationText);
  simulation.attr("__module__") = "flexarm";
  bind_state(module, simulation);
  bind_looks(simulation);
  bind_frames(module, simulation);
  bind_commands(simulation);
  bind_payloads(simulation);
  bind_runs(simulation);
  bind_batch(module);
  bind_analysis(simulation);
  bind_linear_models(module, simulation);
  bind_sensitivities(module, simulation);
  bind_accurate_run(simulation);
  bind_tuning(module);
  bind_recordings(module);
}
