#include "accuracy/trial_runs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "accuracy/processor_time.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/run_summary.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"

namespace flexarm {

JudgedTimes judged_times(double until, double step, int most) {
  // Intervals of 1, 2, 5, 10, ... steps, since many numbers of steps divide them.
  double steps = 1;
  for (int i = 0; until > most * steps * step; ++i) steps *= i % 3 == 1 ? 2.5 : 2;
  JudgedTimes times;
  times.interval = steps * step;
  times.intervals = std::max(2, static_cast<int>(std::lround(until / times.interval)));
  return times;
}

TrialRuns::TrialRuns(scene::SceneDescription scene, const JudgedTimes& times, const TrialLimits& limits,
                     std::function<StepCommand(const Simulation&)> commands, std::function<bool()> go_on)
    : scene_(std::move(scene)),
      times_(times),
      limits_(limits),
      commands_(std::move(commands)),
      go_on_(std::move(go_on)) {}

const TrialRun& TrialRuns::run(const RunSettings& settings, double most_seconds) {
  const auto found = known_.find(settings);
  if (found != known_.end()) {
    TrialRun& known = *found->second;
    if (known.is_given_up && most_seconds > known.seconds) known = made(settings, most_seconds);
    return known;
  }
  runs_.push_back(made(settings, most_seconds));
  known_[settings] = &runs_.back();
  return runs_.back();
}

double TrialRuns::time_again(const RunSettings& settings) {
  ++repetitions_;
  return made(settings, std::numeric_limits<double>::infinity()).seconds;
}

void TrialRuns::require_room() const {
  if (go_on_ && !go_on_()) throw SearchEnded("interrupted");
  if (static_cast<int>(runs_.size()) + repetitions_ > limits_.runs)
    throw SearchEnded(fmt::format("ended after {} runs, the limit of the search", limits_.runs));
  if (seconds_ > limits_.seconds)
    throw SearchEnded(fmt::format("ended after {:.3g} s of computing, the limit of the search", limits_.seconds));
}

TrialRun TrialRuns::made(const RunSettings& settings, double most_seconds) {
  require_room();
  TrialRun run;
  run.settings = settings;
  const double begin = processor_seconds();
  const double before = seconds_;
  try {
    Simulation simulation(with_settings(scene_, settings));
    step_through(simulation, run, most_seconds);
  } catch (const ModelError& error) {
    run.failure = error.what();
  }
  seconds_ = before + processor_seconds() - begin;
  return run;
}

void TrialRuns::step_through(Simulation& simulation, TrialRun& run, double most_seconds) {
  const JudgedPoints judged(simulation);
  if (judged_ == 0) judged_ = judged.size();
  if (judged.size() != judged_) {
    run.failure = fmt::format("it is judged by {} points instead of {}", judged.size(), judged_);
    return;
  }
  const StepCommand command = commands_ ? commands_(simulation) : StepCommand();
  run.unknowns = simulation.degrees_of_freedom();
  run.motion = JudgedMotion(judged.size());
  run.mechanism = model_of(simulation).length_scale;
  run.motion.add(judged.positions(simulation));
  const long stride = std::lround(times_.interval / run.settings.step);
  const double all_before = seconds_;
  const bool drifts = scheme_of(simulation).tableau != nullptr;
  RunSummary summary(simulation);
  for (int interval = 0; interval < times_.intervals; ++interval) {
    const double begin = processor_seconds();
    for (long i = 0; i < stride; ++i) {
      if (command) command(simulation);
      const StepResult result = simulation.step();
      ++run.steps;
      run.iterations += result.iterations;
      run.halvings += result.halvings;
      if (result.converged) continue;
      run.failure = simulation.explain(result);
      break;
    }
    run.seconds += processor_seconds() - begin;
    seconds_ = all_before + run.seconds;
    if (!run.failure.empty()) return;
    run.motion.add(judged.positions(simulation));
    if (drifts) {
      summary.look(simulation);
      run.energy_drift = summary.energy_drift();
    }
    if (run.seconds > most_seconds) {
      run.is_given_up = true;
      run.failure =
          fmt::format("given up at t = {:.3g} s, after {:.3g} s of computing", simulation.time(), run.seconds);
      return;
    }
    require_room();
  }
}

MotionDifference difference(const JudgedMotion& motion, const JudgedMotion& reference) {
  const std::size_t points = reference.points.size(), count = points > 0 ? reference.points.front().size() : 0;
  MotionDifference out(3 * count, points);
  const double last = static_cast<double>(count) - 1;
  for (std::size_t p = 0; p < points; ++p)
    for (std::size_t i = 0; i < count; ++i) {
      const double weight = std::sqrt((i == 0 || i + 1 == count ? 0.5 : 1.0) / last);
      out.block<3, 1>(3 * i, p) = weight * (motion.points[p][i] - reference.points[p][i]);
    }
  return out;
}

double size(const MotionDifference& difference) {
  return difference.size() > 0 ? difference.colwise().norm().maxCoeff() : 0;
}

}  // namespace flexarm
