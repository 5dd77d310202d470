#include "flexarm/accuracy/accurate_run.h"

#include <pybind11/stl.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/signal_clock.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

/// Records a row at the ends of intervals; those of each try take the place of those of the one before.
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

  /// None: nothing is recorded.
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
           R"(Runs to a time, again and again with more steps, until the error is small.

until: the time [s].
accuracy: of the positions of probes (without any, of tips), in (0, 1): the root mean square of their error over time,
  relative to `scale`, is estimated to be at most that. It is the error of time integration; meshes are what they are.
intervals: of equal length, at whose ends points are judged and rows recorded.
record: patterns of columns, as in run().
scale: of errors [m]; None: how far the points move, a millionth of the mechanism's size at least.
frame: the link in whose frame points are judged; '': the world.
most_tries, most_steps: after which it gives up.

Where the scene leaves the scheme to flexarm, tries may be made with another one; the simulation keeps its own. Commands
stay as they are. Returns an AccurateRun, with an array of the shape (intervals + 1, columns), the first row being the
start. Raises AccuracyError if it gives up, StepError if steps fail, ValueError if something is out of range.)",
           py::arg("until"), py::arg("accuracy"), py::arg("intervals") = 100, py::arg("record") = py::none(),
           py::arg("scale") = py::none(), py::arg("frame") = "", py::arg("most_tries") = AccuracyRequest{}.most_tries,
           py::arg("most_steps") = AccuracyRequest{}.most_steps);
}

}  // namespace flexarm::python
