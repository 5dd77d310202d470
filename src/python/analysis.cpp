#include <pybind11/stl.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "simulation/equilibrium_text.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

using Complex = std::complex<double>;

py::object value_of(const Mode& mode) {
  py::array_t<Complex> nodes({mode.node_motion.size(), std::size_t{6}});
  Complex* place = nodes.mutable_data();
  for (const ComplexVector6& motion : mode.node_motion) place = std::copy_n(motion.data(), motion.size(), place);
  py::array_t<Complex> joints(static_cast<py::ssize_t>(mode.coordinate_motion.size()));
  std::copy(mode.coordinate_motion.begin(), mode.coordinate_motion.end(), joints.mutable_data());
  return make("flexarm.values", "Mode", mode.frequency, mode.rate, mode.damping_ratio(), nodes, joints);
}

std::vector<py::object> natural_modes(GuardedSimulation& guarded, int count) {
  const std::vector<Mode> modes =
      guarded.work([&](const Simulation& simulation) { return simulation.natural_modes(count); });
  std::vector<py::object> values;
  for (const Mode& mode : modes) values.push_back(value_of(mode));
  return values;
}

void solve_static(GuardedSimulation& guarded, int load_steps, bool stable) {
  const Equilibrium wanted = stable ? Equilibrium::Stable : Equilibrium::UnderTheLoads;
  const StaticResult result =
      guarded.work([&](Simulation& simulation) { return simulation.solve_static(load_steps, wanted); });
  if (!result.converged) {
    const std::string lack =
        guarded.work([&](const Simulation& simulation) { return lack_of_equilibrium(simulation, result); });
    raise_step_error(guarded.use(), lack, result.reason);
  }
  const char* consequence =
      stable ? "falls from it; this is the equilibrium in which it comes to rest (for the unstable one: stable=False)"
             : "would fall from it";
  const std::vector<std::string> doubts = guarded.work(
      [&](const Simulation& simulation) { return doubts_about_equilibrium(simulation, result, consequence); });
  for (const std::string& doubt : doubts) warn(doubt);
}

}  // namespace

void bind_analysis(SimulationClass& type) {
  type.def("solve_static", &solve_static,
           R"(Goes to the equilibrium under gravity and the loads at t = 0, at rest there.

load_steps: number of steps in which loads and gravity grow from zero; prescribed motions are held at their values for
  t = 0.
stable: if that equilibrium is not stable, goes to a stable one that the mechanism reaches from it, with a SceneWarning.

Raises StepError, and keeps the state, if no equilibrium is found.)",
           py::arg("load_steps") = kLoadSteps, py::arg("stable") = true)
      .def("natural_modes", &natural_modes, R"(Modes about the present configuration, without its velocities.

A list of Mode: growing ones first, then by the magnitude of their eigenvalues.
Raises ValueError if `count` < 1, RuntimeError if the eigenvalue problem cannot be solved.)",
           py::arg("count"));
}

}  // namespace flexarm::python
