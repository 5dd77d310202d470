#include <stdexcept>

#include <pybind11/stl.h>

#include <fmt/format.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/effort_rows.h"
#include "python/errors.h"
#include "python/recorder.h"
#include "python/signal_clock.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

/// Without forcecast, so that an array of another type is refused: results would go into a copy.
using Results = py::array_t<double, py::array::c_style>;

StepResult step(GuardedSimulation& guarded) {
  const StepResult result = guarded.work([](Simulation& simulation) { return simulation.step(); });
  const Simulation& simulation = guarded.use();
  if (!result.converged) raise_step_error(simulation, simulation.explain(result), result.reason);
  return result;
}

Results room_for(const std::optional<Results>& out, py::ssize_t rows, const ResultColumns& columns) {
  const auto width = static_cast<py::ssize_t>(columns.columns().size());
  if (!out) return Results(std::vector<py::ssize_t>{rows, width});
  if (out->ndim() != 2 || out->shape(0) != rows || out->shape(1) != width || !out->writeable())
    throw std::invalid_argument(fmt::format("out: expected a writeable array of the shape ({}, {}), got {}{}", rows,
                                            width, shape_text(*out), out->writeable() ? "" : ", not writeable"));
  return *out;
}

py::object run(GuardedSimulation& guarded, long steps, const std::optional<Array>& efforts,
               const std::optional<std::vector<Key>>& joints, const std::optional<Patterns>& record, long every,
               const std::optional<Results>& out) {
  require_run(steps, every);
  if (out && !record) throw std::invalid_argument("out: expected only with 'record', which names its columns");
  const EffortRows commands(guarded.use(), efforts, joints, steps);
  ResultColumns* const columns = record ? &guarded.columns(*record) : nullptr;
  Results results = columns ? room_for(out, steps / every, *columns) : Results(std::vector<py::ssize_t>{0, 0});
  Recorder recorder(columns, results.mutable_data(), every);
  const StepResult last = guarded.work([&](Simulation& simulation) {
    StepResult result;
    result.converged = true;
    SignalClock signals;
    for (long n = 0; n < steps && result.converged && !signals.is_interrupted(); ++n) {
      commands.command(simulation, n);
      result = simulation.step();
      recorder.note(simulation, result);
    }
    return result;
  });
  if (PyErr_Occurred()) throw py::error_already_set();
  const py::object recorded = columns ? py::object(results) : py::none();
  if (last.converged) return recorded;
  const py::object whole = columns ? py::object(results[py::slice(0, recorder.rows(), 1)]) : py::none();
  raise_step_error(guarded.use(), guarded.use().explain(last), last.reason, whole);
}

std::vector<std::pair<std::string, std::string>> columns(GuardedSimulation& guarded, const Patterns& patterns) {
  std::vector<std::pair<std::string, std::string>> columns;
  for (const ResultColumn& column : guarded.columns(patterns).columns()) columns.emplace_back(column.name, column.unit);
  return columns;
}

py::array_t<double> row(GuardedSimulation& guarded, const Patterns& patterns) {
  const std::vector<double>& row = guarded.columns(patterns).row(guarded.use(), {});
  return numbers(row.size(), [&](std::size_t i) { return row[i]; });
}

}  // namespace

void bind_runs(SimulationClass& type) {
  type.def("step", &step, R"(Advances by one step, in smaller sub-steps if Newton's method does not converge.

Returns a StepResult. Raises StepError if it fails, with the state after the last good sub-step.)")
      .def("run", &run, R"(Advances by a number of steps; other threads can run at the same time.

steps: number of steps.
efforts: commanded before each step, shape (steps, joints), or (joints,): the same for all [N m or N]. A C-contiguous
  array of float64 is not copied. The last efforts stay commanded after the run.
joints: names or indices for the columns of `efforts`; None: all of effort_joints.
record: patterns of the columns to be recorded, as for `flexarm simulate --columns` (["joint/elbow/[pv]*", "energy/total"]);
  the time is always the first column, the others are in the order of the patterns. []: all. None: nothing is recorded.
every: number of steps between recorded rows.
out: array for the results, instead of a new one: C-contiguous, of float64.

Returns an array of the shape (steps // every, columns), see columns(); None if nothing is recorded. Raises StepError if
a step fails, with the rows until then; ValueError, before the first step, if an effort is not finite or a shape is
wrong.)",
           py::arg("steps"), py::arg("efforts") = py::none(), py::arg("joints") = py::none(),
           py::arg("record") = py::none(), py::arg("every") = 1, py::arg("out").noconvert() = py::none())
      .def("columns", &columns,
           R"(Names and units of the columns that match one of the patterns; without patterns, of all columns.

record: patterns as in a shell, ["energy/total", "probe/hand/[xyz]"]. Returns a list of pairs.
Raises ValueError if a pattern matches no column. docs/results.md lists all columns.)",
           py::arg("record") = Patterns())
      .def("row", &row,
           "Present values of the columns, shape (columns,), as run() records them; counts of the solver are zero.",
           py::arg("record") = Patterns());
}

}  // namespace flexarm::python
