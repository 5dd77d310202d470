#include "flexarm/simulation/sensitivities.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <fmt/format.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/effort_rows.h"
#include "python/errors.h"
#include "python/signal_clock.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

using Patterns = std::vector<std::string>;

/// Sensitivities of a simulation that Python code uses.
class GuardedSensitivities {
 public:
  GuardedSensitivities(std::shared_ptr<GuardedSimulation> simulation, const SensitivityRequest& request)
      : simulation_(std::move(simulation)),
        own_(simulation_->work([&](Simulation& own) { return Sensitivities(own, request); })) {}

  GuardedSimulation& simulation() { return *simulation_; }
  std::shared_ptr<GuardedSimulation> pointer() const { return simulation_; }
  /// Calls `work(sensitivities, simulation)` without the GIL, so that other Python threads can run.
  template <class Work>
  auto work(const Work& work) {
    return simulation_->work([&](Simulation& simulation) { return work(own_, simulation); });
  }
  const Sensitivities& look() {
    simulation_->use();
    return own_;
  }

 private:
  std::shared_ptr<GuardedSimulation> simulation_;
  Sensitivities own_;
};

std::unique_ptr<GuardedSensitivities> sensitivities_of(const std::shared_ptr<GuardedSimulation>& simulation,
                                                       const std::vector<std::string>& parameters, bool initial_state) {
  if (simulation->is_edited())
    throw std::invalid_argument("sensitivities are not available after links were added to or removed from the scene");
  try {
    return std::make_unique<GuardedSensitivities>(
        simulation, SensitivityRequest{parameters, simulation->scene()->read, initial_state});
  } catch (const ModelError& error) {
    raise_scene_error(error.what());
  }
}

StepResult step_with_derivatives(GuardedSensitivities& guarded) {
  StepResult result = guarded.work([](Sensitivities& own, Simulation&) { return own.step(); });
  const Simulation& simulation = guarded.simulation().use();
  if (!result.converged) raise_step_error(simulation, simulation.explain(result), result.reason);
  return result;
}

/// The derivatives of a row of results.
Eigen::MatrixXd derivatives(const Sensitivities& own, ResultColumns& columns) {
  return own.of([&](const Simulation& simulation) -> Eigen::VectorXd {
    const std::vector<double>& row = columns.row(simulation, {});
    return Eigen::Map<const Eigen::VectorXd>(row.data(), static_cast<Eigen::Index>(row.size()));
  });
}

py::object run_with_derivatives(GuardedSensitivities& guarded, long steps, const std::optional<Array>& efforts,
                                const std::optional<std::vector<Key>>& joints, const std::optional<Patterns>& record,
                                long every) {
  if (steps < 0) throw std::invalid_argument(fmt::format("steps: expected a number >= 0, got {}", steps));
  if (every < 1) throw std::invalid_argument(fmt::format("every: expected a number >= 1, got {}", every));
  GuardedSimulation& simulation = guarded.simulation();
  const EffortRows commands(simulation.use(), efforts, joints, steps);
  ResultColumns* const columns = record ? &simulation.columns(*record) : nullptr;
  const std::size_t width = columns ? columns->columns().size() : 0;
  const std::size_t directions = guarded.look().directions().size();
  py::array_t<double> results({columns ? static_cast<std::size_t>(steps / every) : 0, width, directions});
  double* place = results.mutable_data();
  const StepResult last = guarded.work([&](Sensitivities& own, Simulation& moving) {
    StepResult result;
    result.converged = true;
    SignalClock signals;
    for (long n = 0; n < steps && result.converged && !signals.is_interrupted(); ++n) {
      commands.command(moving, n);
      result = own.step();
      if (!columns || !result.converged || (n + 1) % every != 0) continue;
      const Eigen::MatrixXd rows = derivatives(own, *columns);
      for (Eigen::Index i = 0; i < rows.rows(); ++i)
        for (Eigen::Index k = 0; k < rows.cols(); ++k) *place++ = rows(i, k);
    }
    return result;
  });
  if (PyErr_Occurred()) throw py::error_already_set();
  if (!last.converged) raise_step_error(simulation.use(), simulation.use().explain(last), last.reason);
  return columns ? py::object(results) : py::none();
}

constexpr const char* kClass =
    R"(Derivatives of a simulation's run; the run itself has the same bits as without them.

Columns of all arrays are the directions: parameters in the given order, then states at the start. They are NaN after
they were lost (`lost` has the reason: a slider left its line, a step failed). At events of stops and dry friction they
include the change of the event's time; `events` lists all of them and says which are doubtful.
docs/notes/sensitivities.md)";

constexpr const char* kMake = R"(Sensitivities of the run that begins now; the simulation must be at its start.

parameters: names of parameters of the scene.
initial_state: also with respect to the states of linear models about the start (LinearModel.states): positions, then
  their rates.

Make the steps with the returned object, whose `simulation` is this one. Raises ValueError if a parameter is unknown, or
changes something without a derivative (numbers of elements, the step), or if the simulation has moved; SceneError if
the scheme does not support sensitivities; RuntimeError for initial states at a dead point.)";

constexpr const char* kRun = R"(Advances by a number of steps; other threads can run at the same time.

steps, efforts, joints: as for Simulation.run().
record: patterns of the columns whose derivatives are recorded (["joint/elbow/[pv]*", "probe/tip/[xyz]"]); []: all.
  None: nothing.
every: number of steps between recorded rows.

Returns an array of the shape (steps // every, columns, directions), in the order of simulation.columns(record), the
time first; per unit of the parameter or the state. None if nothing is recorded. Raises StepError if a step fails.)";

}  // namespace

void bind_sensitivities(py::module_& module, SimulationClass& simulation) {
  py::class_<RunEvent> event(module, "RunEvent", "A stop that is touched or left, dry friction that sticks or slips.");
  event.attr("__module__") = "flexarm";
  event.def_readonly("time", &RunEvent::time, "[s]")
      .def_readonly("joint", &RunEvent::joint, "name of the coordinate")
      .def_readonly("what", &RunEvent::what, "event that happened: 'touches its stop', 'sticks', ...")
      .def_readonly("doubt", &RunEvent::doubt,
                    "reason why derivatives after the event may be wrong; empty if there is none")
      .def("__repr__", [](const RunEvent& own) {
        return fmt::format("<flexarm.RunEvent: t = {:.9g} s, '{}' {}{}>", own.time, own.joint, own.what,
                           own.doubt.empty() ? "" : ", doubtful");
      });
  py::class_<GuardedSensitivities> type(module, "Sensitivities", kClass);
  type.attr("__module__") = "flexarm";
  type.def_property_readonly(
          "simulation", [](const GuardedSensitivities& own) { return own.pointer(); },
          "The simulation whose run is differentiated.")
      .def_property_readonly(
          "directions", [](GuardedSensitivities& own) { return own.look().directions(); }, "Names of the directions.")
      .def_property_readonly(
          "lost", [](GuardedSensitivities& own) { return own.look().lost(); },
          "Reason why derivatives were lost; empty if they were not.")
      .def_property_readonly(
          "events", [](GuardedSensitivities& own) { return own.look().events(); },
          "Events of stops and dry friction in the run so far: a list of RunEvent.")
      .def("step", &step_with_derivatives,
           "Simulation.step() with all derivatives. Returns a StepResult; raises StepError if it fails.")
      .def("run", &run_with_derivatives, kRun, py::arg("steps"), py::arg("efforts") = py::none(),
           py::arg("joints") = py::none(), py::arg("record") = py::none(), py::arg("every") = 1)
      .def(
          "row",
          [](GuardedSensitivities& own, const Patterns& record) {
            ResultColumns& columns = own.simulation().columns(record);
            return derivatives(own.look(), columns);
          },
          R"(Derivatives of the present Simulation.row(record), shape (columns, directions); that of the time is 0.)",
          py::arg("record"))
      .def_property_readonly(
          "positions", [](GuardedSensitivities& own) { return own.look().positions(); },
          "Derivatives of joints' positions, shape (joints, directions) [rad or m per unit].")
      .def_property_readonly(
          "velocities", [](GuardedSensitivities& own) { return own.look().velocities(); },
          "Derivatives of joints' velocities, shape (joints, directions) [rad/s or m/s per unit].")
      .def(
          "probe",
          [](GuardedSensitivities& own, const Key& probe) {
            return own.look().probe(probe_index(own.simulation().use(), probe));
          },
          R"(Derivatives of a probe, shape (12, directions): position, small rotation, velocity, angular velocity.

They are in world axes. probe: name or index.)",
          py::arg("probe"))
      .def(
          "outputs",
          [](GuardedSensitivities& own, const std::vector<std::string>& names) { return own.look().outputs(names); },
          R"(Derivatives of outputs of linear models, shape (outputs, directions).

names: as for linearise(): position: and velocity: of joints and points, acceleration: of points, effort: of driven
joints; none: positions of joints and probes. Raises ValueError if there is no such output.)",
          py::arg("names") = std::vector<std::string>())
      .def_property_readonly(
          "states", [](GuardedSensitivities& own) { return own.look().states(); },
          R"(Derivatives of the states of linear models about the present state, shape (states, directions).

The columns of the initial states are the matrix dx(t)/dx(0).)")
      .def_property_readonly(
          "state_names", [](GuardedSensitivities& own) { return own.look().state_names(); },
          "Names of the rows of `states`.");
  simulation.def("sensitivities", &sensitivities_of, kMake, py::arg("parameters") = std::vector<std::string>(),
                 py::kw_only(), py::arg("initial_state") = false);
}

}  // namespace flexarm::python
