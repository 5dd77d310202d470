#include <cmath>
#include <utility>

#include <pybind11/stl.h>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "pictures/page.h"
#include "pictures/recorded_rows.h"
#include "pictures/recording.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/signal_clock.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

/// A run as a page contains it: JSON, and bytes.
using Encoded = std::pair<std::string, py::bytes>;

Encoded encoded(const pictures::EncodedRun& run) {
  return {run.picture, py::bytes(run.motion)};
}

/// A recording, and the simulation that it follows.
class SimulationRecording {
 public:
  SimulationRecording(std::shared_ptr<GuardedSimulation> simulation, const std::string& title, double rate)
      : simulation_(std::move(simulation)),
        recording_(simulation_->use(),
                   {title.empty() ? simulation_->use().scene().name : title, positive(rate, "rate")}) {}

  void keep() { recording_.keep(simulation_->use(), {}); }

  void run(double until) {
    if (!std::isfinite(until)) throw std::invalid_argument(fmt::format("until: expected a finite time, got {}", until));
    const StepResult last = simulation_->work([&](Simulation& simulation) {
      SignalClock signals;
      return recording_.run(simulation, until, [&](const Simulation&) { return !signals.is_interrupted(); });
    });
    if (PyErr_Occurred()) throw py::error_already_set();
    if (last.converged) return;
    const Simulation& simulation = simulation_->use();
    raise_step_error(simulation, simulation.explain(last), last.reason, py::none());
  }

  std::size_t size() const { return recording_.size(); }
  Encoded encode() const { return encoded(recording_.encode()); }

 private:
  static double positive(double value, const char* name) {
    if (std::isfinite(value) && value > 0) return value;
    throw std::invalid_argument(fmt::format("{}: expected a number > 0, got {}", name, value));
  }

  std::shared_ptr<GuardedSimulation> simulation_;
  pictures::Recording recording_;
};

Encoded encode_rows(GuardedSimulation& guarded, const std::vector<std::pair<std::string, std::string>>& columns,
                    const Array& rows, const std::string& title, double rate, const std::vector<std::string>& notes) {
  if (rows.ndim() != 2 || rows.shape(1) != static_cast<py::ssize_t>(columns.size()))
    throw std::invalid_argument(
        fmt::format("rows: expected the shape (rows, {}), got {}", columns.size(), shape_text(rows)));
  pictures::ResultRows out{{}, {}, notes};
  for (const auto& [name, unit] : columns) out.columns.push_back({name, unit});
  out.values.assign(rows.data(), rows.data() + rows.size());
  return encoded(pictures::record_rows(guarded.use(), out, {title, rate}));
}

std::string page(const std::vector<Encoded>& runs, std::optional<double> at) {
  if (at && !std::isfinite(*at)) throw std::invalid_argument(fmt::format("at: expected a finite time, got {}", *at));
  std::vector<pictures::EncodedRun> out;
  for (const auto& [picture, motion] : runs) out.push_back({picture, motion, {}});
  return pictures::page_of(out, at);
}

}  // namespace

void bind_recordings(py::module_& module) {
  py::class_<SimulationRecording> type(module, "Recording", R"(What a page shows of a simulation's run.

    Recording(simulation, title="", rate=60.0)

simulation: followed from its present state on, where it was made or changed.
title: of the page; by default the scene's name.
rate: instants per second of simulated time that run() keeps, at most [1/s].)");
  type.attr("__module__") = "flexarm";
  type.def(py::init<std::shared_ptr<GuardedSimulation>, const std::string&, double>(), py::arg("simulation"),
           py::arg("title") = "", py::arg("rate") = 60.0)
      .def("keep", &SimulationRecording::keep, "Keeps the present state of the simulation as an instant.")
      .def("run", &SimulationRecording::run, py::arg("until"),
           R"(Steps the simulation until a time [s], and keeps instants; other threads can run at the same time.

Raises StepError if a step fails; the instants until then are kept.)")
      .def("__len__", &SimulationRecording::size, "The number of instants.")
      .def("_encode", &SimulationRecording::encode);
  module.def("_encode_rows", &encode_rows, py::arg("simulation"), py::arg("columns"), py::arg("rows"), py::arg("title"),
             py::arg("rate"), py::arg("notes"));
  module.def("_page", &page, py::arg("runs"), py::arg("at") = py::none());
}

}  // namespace flexarm::python
