#include "accuracy/tuning.h"

#include <stdexcept>

#include <pybind11/stl.h>

#include <fmt/format.h>

#include "python/bindings.h"
#include "python/errors.h"
#include "python/signal_clock.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

TuningGoal goal_of(std::optional<double> accuracy, std::optional<double> real_time, double margin) {
  const auto require = [](bool ok, const char* name, double got) {
    if (!ok) throw std::invalid_argument(fmt::format("{}: expected a number > 0, got {}", name, got));
  };
  if (accuracy.has_value() == real_time.has_value())
    throw std::invalid_argument("tune: expected either an accuracy or real_time");
  require(margin > 0, "margin", margin);
  if (accuracy) require(*accuracy > 0, "accuracy", *accuracy);
  if (real_time) require(*real_time > 0, "real_time", *real_time);
  return {accuracy, real_time ? std::optional<double>(1 / (*real_time * margin)) : std::nullopt};
}

std::string shortcoming(const TuningGoal& goal, const TuningResult& result) {
  const std::string wanted = goal.accuracy
                                 ? fmt::format("an error of {:g}", *goal.accuracy)
                                 : fmt::format("{:g} of the processor's time for a simulated second", *goal.load);
  return fmt::format("{} cannot be met: {}", wanted, result.shortcoming);
}

py::object tune_scene(const std::shared_ptr<ReadScene>& scene, std::optional<double> accuracy,
                      std::optional<double> real_time, double until, double margin, bool any_scheme, double budget,
                      int intervals) {
  const TuningGoal goal = goal_of(accuracy, real_time, margin);
  if (!(until > 0)) throw std::invalid_argument(fmt::format("until: expected a time > 0, got {}", until));
  if (intervals < 1) throw std::invalid_argument(fmt::format("intervals: expected a number >= 1, got {}", intervals));
  TuningFreedom freedom;
  freedom.any_scheme = any_scheme;
  TrialLimits limits;
  limits.seconds = budget;
  const TuningResult result = [&] {
    const py::gil_scoped_release unlocked;
    SignalClock signals;
    const JudgedTimes times = judged_times(until, scene->integrator.step, intervals);
    TrialRuns trials(*scene, times, limits, {}, [&signals] { return !signals.is_interrupted(); });
    return tune(trials, goal, freedom, [](double, const std::string&) {});
  }();
  if (PyErr_Occurred()) throw py::error_already_set();
  if (!result.is_met) raise(make("flexarm.errors", "AccuracyError", shortcoming(goal, result), result.estimate));
  const TunedRun& best = result.runs[*result.best];
  const SceneReader read = [scene, settings = best.settings](const std::string& parameter, double value) {
    scene::ReadResult result = scene->read(parameter, value);
    if (result.scene) result.scene = with_settings(*result.scene, settings);
    return result;
  };
  return make("flexarm.values", "Tuning", std::make_shared<ReadScene>(with_settings(*scene, best.settings), read),
              best.settings.mesh(), best.settings.scheme, best.settings.step, best.settings.tolerance, best.error,
              result.scale, best.seconds / until, result.runs.size());
}

}  // namespace

void bind_tuning(py::module_& module) {
  module.def("tune", &tune_scene, R"(Finds the cheapest meshes, scheme, step and tolerance for an accuracy, or the most
accurate ones for a speed, as `flexarm tune` does.

accuracy: error of the positions of probes (of tips if there are no probes): root mean square over time, relative to
  their largest displacement. Or
real_time: required speed, as a multiple of real time, with the `margin`.
until: end of the motion with which settings are compared [s]: the scene's own, without commands.
any_scheme: also tries schemes that do not conserve what the scene's scheme conserves.
budget: limit of the search's processor time [s].
intervals: largest number of intervals at whose ends points are compared.

Returns a Tuning. Raises AccuracyError if it finds nothing that is good enough.)",
             py::arg("scene"), py::arg("accuracy") = py::none(), py::arg("real_time") = py::none(), py::kw_only(),
             py::arg("until") = 10.0, py::arg("margin") = 1.5, py::arg("any_scheme") = false,
             py::arg("budget") = TrialLimits().seconds, py::arg("intervals") = 150);
}

}  // namespace flexarm::python
