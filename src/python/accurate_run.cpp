#include "flexarm/accuracy/accurate_run.h"

#include <pybind11/stl.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/signal_clock.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

/// Records a row at the end of each interval. The rows of a new try replace those of the last one.
class IntervalRecorder : public RunWatcher {
 public:
  explicit IntervalRecorder(ResultColumns* columns) : columns_(columns) {}

  void begin(const Simulation&, long, double) override {
    numbers_.clear();
    counts_ = {};
  }
  bool after_step(const Simulation&, const StepResult& result) override {
    counts_.add(result);
    return !signals_.is_interrupted();
  }
  void after_interval(const Simulation& simulation, double) override {
    if (!columns_) return;
    const std::vector<double>& row = columns_->row(simulation, counts_);
    numbers_.insert(numbers_.end(), row.begin(), row.end());
    counts_ = {};
  }

  /// The rows, or None if nothing is recorded.
  py::object rows() const {
    if (!columns_) return py::none();
    const std::size_t width = columns_->columns().size();
    return python::rows(numbers_.size() / width, width,
                        [&](std::size_t i, double* place) { std::copy_n(numbers_.data() + i * width, width, place); });
  }

 private:
  ResultColumns* columns_;
  std::vector<double> numbers_;
  StepCounts counts_;
  SignalClock signals_;
};

py::object run_accurately(GuardedSimulation& guarded, double until, double accuracy, int intervals,
                          const std::optional<std::vector<std::string>>& record, std::optional<double> scale,
                          const std::string& frame, int most_tries, double most_steps) {
  const AccuracyRequest request{accuracy, until, intervals, scale, frame, most_tries, most_steps};
  guarded.use();
  IntervalRecorder recorder(record ? &guarded.columns(*record) : nullptr);
  const AccurateRun run =
      guarded.work([&](Simulation& simulation) { return run_to_accuracy(simulation, request, recorder); });
  if (PyErr_Occurred()) throw py::error_already_set();
  const Simulation& simulation = guarded.use();
  if (run.end == AccurateRun::End::Failed)
    raise_step_error(simulation, simulation.explain(run.last), run.last.reason, recorder.rows());
  if (run.end != AccurateRun::End::Met)
    raise(make("flexarm.errors", "AccuracyError", shortcoming(run, accuracy), run.estimate(), recorder.rows()));
  return make("flexarm.values", "AccurateRun", run.estimate(), run.scale, run.scheme(), run.tries.size(), run.steps,
              run.steps_per_interval, run.interval, recorder.rows());
}

}  // namespace

void bind_accurate_run(SimulationClass& type) {
  type.def("run_to_accuracy", &run_accurately,
           R"(Runs to a time, repeatedly and with more steps each time, until the estimated error is small enough.

until: the simulated time at the end, as `time` counts it: not the length of the run [s].
accuracy: largest estimated error of the positions of probes (of tips if there are no probes), in (0, 1): root mean
  square over time, relative to `scale`. It is the error of time integration, without that of the meshes.
intervals: number of equal intervals; errors are measured and rows recorded at their ends.
record: patterns of columns, as in run().
scale: length to which errors are relative [m]; None: the largest displacement of the points, or the mechanism's size
  if they move by less than a millionth of it.
frame: the link in whose frame errors are measured; '': the world.
most_tries, most_steps: limits after which it gives up.

If the scene does not choose a scheme, tries may use another one; the simulation keeps its own. Commands stay as they
are. Returns an AccurateRun, with an array of the shape (intervals + 1, columns), the first row being the start. Raises
AccuracyError if it gives up, StepError if steps fail, ValueError if something is out of range.)",
           py::arg("until"), py::arg("accuracy"), py::arg("intervals") = 100, py::arg("record") = py::none(),
           py::arg("scale") = py::none(), py::arg("frame") = "", py::arg("most_tries") = AccuracyRequest{}.most_tries,
           py::arg("most_steps") = AccuracyRequest{}.most_steps);
}

}  // namespace flexarm::python
