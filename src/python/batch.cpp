#include "flexarm/simulation/batch.h"

#include <atomic>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/effort_rows.h"
#include "python/errors.h"
#include "python/recorder.h"
#include "python/signal_clock.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

using Pointer = std::shared_ptr<GuardedSimulation>;

/// Simulations of Python that are stepped together.
class GuardedBatch {
 public:
  GuardedBatch(std::vector<Pointer> simulations, std::optional<int> threads)
      : simulations_(std::move(simulations)), batch_(simulations_of(simulations_), threads_of(threads)) {
    failures_.resize(size());
    const std::vector<std::string>& names = batch_[0].coordinate_names();
    for (std::size_t i = 1; i < size(); ++i)
      if (batch_[i].coordinate_names() != names)
        throw std::invalid_argument(
            fmt::format("simulations: expected the same joints in all, but not in number {}", i));
  }

  std::size_t size() const { return simulations_.size(); }
  int threads() const { return batch_.threads(); }
  const std::vector<Pointer>& simulations() const { return simulations_; }
  const std::vector<std::optional<std::string>>& failures() const { return failures_; }

  py::object run(long steps, const std::optional<Array>& efforts, const std::optional<std::vector<Key>>& joints,
                 const std::optional<Patterns>& record, long every, const std::optional<std::vector<bool>>& which,
                 bool raise_failures);
  py::array_t<double> row(const Patterns& record);

 private:
  static int threads_of(std::optional<int> threads) {
    if (threads && *threads < 1)
      throw std::invalid_argument(fmt::format("threads: expected a number >= 1, got {}", *threads));
    return threads.value_or(0);
  }
  static std::vector<std::shared_ptr<Simulation>> simulations_of(const std::vector<Pointer>& guarded) {
    std::vector<std::shared_ptr<Simulation>> simulations;
    for (const Pointer& each : guarded) {
      if (!each) throw std::invalid_argument("simulations: expected a list of Simulation, got None in it");
      simulations.emplace_back(each, &each->use());  // it keeps the guarded one alive
    }
    return simulations;
  }
  /// The columns of each simulation, with the same names.
  std::vector<ResultColumns*> columns_of_all(const Patterns& record);

  std::vector<Pointer> simulations_;
  Batch batch_;
  std::vector<std::optional<std::string>> failures_;  // of the last run
};

std::vector<ResultColumns*> GuardedBatch::columns_of_all(const Patterns& record) {
  std::vector<ResultColumns*> out;
  for (const Pointer& each : simulations_) out.push_back(&each->columns(record));
  const std::vector<ResultColumn>& first = out[0]->columns();
  for (std::size_t i = 1; i < size(); ++i) {
    const std::vector<ResultColumn>& own = out[i]->columns();
    if (!std::equal(own.begin(), own.end(), first.begin(), first.end(),
                    [](const ResultColumn& a, const ResultColumn& b) { return a.name == b.name; }))
      throw std::invalid_argument(
          fmt::format("record: expected the same columns in all simulations, but not in number {}", i));
  }
  return out;
}

py::object GuardedBatch::run(long steps, const std::optional<Array>& efforts,
                             const std::optional<std::vector<Key>>& joints, const std::optional<Patterns>& record,
                             long every, const std::optional<std::vector<bool>>& which, bool raise_failures) {
  require_run(steps, every);
  if (which && which->size() != size())
    throw std::invalid_argument(fmt::format("which: expected {} truth values, got {}", size(), which->size()));
  const EffortRows commands(batch_[0], efforts, joints, steps, size());
  const std::vector<ResultColumns*> columns = record ? columns_of_all(*record) : std::vector<ResultColumns*>(size());
  const auto width = static_cast<py::ssize_t>(record ? columns[0]->columns().size() : 0), rows = steps / every;
  py::array_t<double> results({static_cast<py::ssize_t>(size()), rows, width});
  double* const numbers = results.mutable_data();
  std::fill_n(numbers, results.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<StepResult> last(size());
  for (StepResult& result : last) result.converged = true;
  SignalClock signals;
  std::atomic<bool> is_interrupted{false};
  const std::thread::id caller = std::this_thread::get_id();
  GuardedSimulation::work_on_all(simulations_, [&] {
    batch_.for_each([&](std::size_t i) {
      if (which && !(*which)[i]) return;
      Recorder recorder(columns[i], numbers + static_cast<py::ssize_t>(i) * rows * width, every);
      for (long n = 0; n < steps && last[i].converged && !is_interrupted; ++n) {
        if (std::this_thread::get_id() == caller && signals.is_interrupted()) is_interrupted = true;
        commands.command(batch_[i], n, i);
        last[i] = batch_[i].step();
        recorder.note(batch_[i], last[i]);
      }
    });
  });
  if (PyErr_Occurred()) throw py::error_already_set();
  const py::object recorded = record ? py::object(results) : py::none();
  std::optional<std::size_t> failed;
  for (std::size_t i = size(); i-- > 0;) {
    failures_[i].reset();
    if (last[i].converged) continue;
    failures_[i] = batch_[i].explain(last[i]);
    failed = i;
  }
  if (failed && raise_failures)
    raise_step_error(batch_[*failed], fmt::format("simulation {}: {}", *failed, *failures_[*failed]),
                     last[*failed].reason, recorded);
  return recorded;
}

py::array_t<double> GuardedBatch::row(const Patterns& record) {
  const std::vector<ResultColumns*> columns = columns_of_all(record);
  const std::size_t width = columns[0]->columns().size();
  py::array_t<double> results({size(), width});
  double* const numbers = results.mutable_data();
  GuardedSimulation::work_on_all(simulations_, [&] {
    batch_.for_each([&](std::size_t i) {
      const std::vector<double>& row = columns[i]->row(batch_[i], {});
      std::copy(row.begin(), row.end(), numbers + i * width);
    });
  });
  return results;
}

constexpr const char* kBatchText = R"(Simulations that are stepped together by several threads.

    Batch(simulations, threads=None)

simulations: a list of Simulation, each once, with the same joints; starts, parameters and commands may differ. They are
  not copied: batch[i] is the simulation itself. [copy.copy(arm) for _ in range(1000)] makes a thousand of one.
threads: that work at the same time; None: one per processor.

Each simulation has the same bits as if it were stepped alone.)";

}  // namespace

void bind_batch(py::module_& module) {
  py::class_<GuardedBatch> batch(module, "Batch", kBatchText);
  batch.attr("__module__") = "flexarm";
  batch
      .def(py::init<std::vector<Pointer>, std::optional<int>>(), py::arg("simulations"),
           py::arg("threads") = py::none())
      .def("__len__", &GuardedBatch::size)
      .def("__getitem__",
           [](const GuardedBatch& b, py::ssize_t i) {
             const auto size = static_cast<py::ssize_t>(b.size());
             if (i < -size || i >= size)
               throw py::index_error(fmt::format("expected an index below {}, got {}", size, i));
             return b.simulations()[static_cast<std::size_t>(i < 0 ? i + size : i)];
           })
      .def_property_readonly("threads", &GuardedBatch::threads, "number of threads that work at the same time")
      .def_property_readonly("failures", &GuardedBatch::failures,
                             "per simulation: why its last step failed in the last run(), or None if it did not")
      .def("run", &GuardedBatch::run,
           R"(Advances all by a number of steps; other Python threads can run at the same time.

steps: number of steps.
efforts: commanded before each step, shape (simulations, steps, joints), (simulations, joints): the same in all steps, or
  (joints,): the same for all simulations as well [N m or N]. A C-contiguous array of float64 is not copied.
joints, record, every: as of Simulation.run().
which: truth values, shape (simulations,): those that are stepped; None: all.
raise_failures: whether a failure raises StepError, after all others have ended. Otherwise see `failures`.

Returns an array of the shape (simulations, steps // every, columns), or None if nothing is recorded. Rows that a
simulation has not reached are NaN.)",
           py::arg("steps"), py::arg("efforts") = py::none(), py::arg("joints") = py::none(),
           py::arg("record") = py::none(), py::arg("every") = 1, py::arg("which") = py::none(),
           py::arg("raise_failures") = true)
      .def("row", &GuardedBatch::row,
           "Present values of the columns of all simulations, shape (simulations, columns), as Simulation.row() has "
           "them.",
           py::arg("record") = Patterns());
}

}  // namespace flexarm::python
