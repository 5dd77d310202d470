#include "bench/best_fixed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "accuracy/processor_time.h"
#include "accuracy/tuning.h"
#include "flexarm/model/model_error.h"
#include "flexarm/simulation/simulation.h"
#include "simulation/inside.h"

namespace flexarm::bench {
namespace {

constexpr double kTolerances[] = {1e-3, 1e-2, 1e-4, 1e-6};
/// Numbers of steps per interval; they are tried until a run is good enough.
constexpr int kSteps[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512};
/// Limit for a run while no good one is known [s], and then relative to the best one's time.
constexpr double kPatience = 0.4, kMorePatience = 3;
/// Length of the first step of an interval in a shifted run, relative to the others.
constexpr double kShift = 0.37;

/// A simulation with these settings. It is built with the scene's own step, since that fits the samples of servos; what
/// the scheme takes from the step follows the settings.
Simulation made_with(const scene::SceneDescription& scene, RunSettings settings) {
  const double step = std::exchange(settings.step, scene.integrator.step);
  Simulation simulation(with_settings(scene, settings));
  set_step_of_constants(simulation, step);
  return simulation;
}

}  // namespace

FixedRuns::FixedRuns(const scene::SceneDescription& scene, const JudgedTimes& times, Commands commands,
                     JudgedMotion truth, double seconds, std::function<void()> go_on)
    : scene_(scene),
      times_(times),
      commands_(std::move(commands)),
      truth_(std::move(truth)),
      seconds_(seconds),
      go_on_(std::move(go_on)) {}

FixedRuns::Run FixedRuns::made(const RunSettings& settings, double most_seconds) const {
  Run run;
  run.settings = settings;
  run.error = std::numeric_limits<double>::infinity();
  try {
    Simulation simulation = made_with(scene_, settings);
    simulation.set_step_size(settings.step);
    const StepCommand command = commands_ ? commands_(simulation) : StepCommand();
    const JudgedPoints judged(simulation);
    JudgedMotion motion(judged.size());
    motion.add(judged.positions(simulation));
    const long count = std::lround(times_.interval / settings.step);
    const double begin = processor_seconds();
    for (int interval = 0; interval < times_.intervals; ++interval) {
      for (long i = 0; i < count; ++i) {
        if (command) command(simulation);
        const StepResult result = simulation.step();
        run.iterations += result.iterations;
        if (!result.converged) return run;
      }
      motion.add(judged.positions(simulation));
      run.seconds = processor_seconds() - begin;
      run.is_given_up = run.seconds > most_seconds;
      if (run.is_given_up) return run;
    }
    run.error = motion_error(motion, truth_, truth_.largest_displacement());
  } catch (const ModelError&) {
    // The scheme cannot run the scene.
  } catch (const std::invalid_argument&) {
    // The step does not divide the times of samples.
  }
  return run;
}

const FixedRuns::Run& FixedRuns::run(const RunSettings& settings, double most_seconds) {
  auto found = runs_.find(settings);
  // A run that was stopped may reach its end with more time.
  if (found == runs_.end() || (found->second.is_given_up && found->second.seconds < 0.5 * most_seconds)) {
    go_on_();
    found = runs_.insert_or_assign(settings, made(settings, most_seconds)).first;
    seconds_ -= found->second.seconds;
  }
  return found->second;
}

const FixedRuns::Run* FixedRuns::best(double error) {
  const Run* best = nullptr;
  for (const std::string& scheme : schemes_alike(scene_.integrator, false))
    for (const double tolerance : kTolerances) {
      const Run* coarser = nullptr;  // the run before, if it was good
      for (const int steps : kSteps) {
        if (seconds_ < 0) return best;
        RunSettings settings = settings_of(scene_);
        settings.scheme = scheme;
        settings.step = times_.interval / steps;
        settings.tolerance = tolerance;
        const Run& next = run(settings, best ? kMorePatience * best->seconds : kPatience);
        const bool good = next.error <= error;
        const bool is_no_luck = coarser && good;
        if (is_no_luck && (!best || coarser->seconds < best->seconds)) best = coarser;
        if (is_no_luck || next.is_given_up) break;
        coarser = good ? &next : nullptr;
      }
    }
  return best;
}

std::optional<JudgedMotion> shifted_motion(const scene::SceneDescription& scene, const RunSettings& settings,
                                           const JudgedTimes& times, const Commands& commands, double most_seconds) {
  Simulation simulation = made_with(scene, settings);
  const double begin = processor_seconds(), step = settings.step;
  const StepCommand command = commands ? commands(simulation) : StepCommand();
  const JudgedPoints judged(simulation);
  JudgedMotion motion(judged.size());
  motion.add(judged.positions(simulation));
  const long count = std::lround(times.interval / step);
  try {
    for (int interval = 0; interval < times.intervals; ++interval) {
      for (long i = 0; i <= count; ++i) {
        simulation.set_step_size(step * (i == 0 ? kShift : i == count ? 1 - kShift : 1.0));
        if (command) command(simulation);
        if (!simulation.step().converged) return std::nullopt;
      }
      if (processor_seconds() - begin > most_seconds) return std::nullopt;
      motion.add(judged.positions(simulation));
    }
  } catch (const std::invalid_argument&) {  // servos are sampled, which requires equal steps
    return std::nullopt;
  }
  return motion;
}

}  // namespace flexarm::bench
