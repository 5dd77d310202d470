#pragma once
/// The parts of the extension module flexarm._flexarm, each in a file of its own.

#include <memory>

#include <pybind11/pybind11.h>

#include "python/guarded_simulation.h"
#include "python/older_pybind11.h"

namespace flexarm::python {

using SimulationClass = pybind11::class_<GuardedSimulation, std::shared_ptr<GuardedSimulation>>;

void bind_scene(pybind11::module_& module);
void bind_step_result(pybind11::module_& module);
void bind_state(pybind11::module_& module, SimulationClass& simulation);
void bind_looks(SimulationClass& simulation);
void bind_frames(pybind11::module_& module, SimulationClass& simulation);
void bind_commands(SimulationClass& simulation);
void bind_payloads(SimulationClass& simulation);
void bind_recordings(pybind11::module_& module);
void bind_runs(SimulationClass& simulation);
void bind_batch(pybind11::module_& module);
void bind_analysis(SimulationClass& simulation);
void bind_linear_models(pybind11::module_& module, SimulationClass& simulation);
void bind_sensitivities(pybind11::module_& module, SimulationClass& simulation);
void bind_accurate_run(SimulationClass& simulation);
void bind_tuning(pybind11::module_& module);

}  // namespace flexarm::python
