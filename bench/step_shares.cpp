// What a step spends its time on: how often Newton's method needs each part, times what that part takes by itself.
//
// Counters: percent of the step's time, "rest%" being what the parts leave; iterations and factorisations per step;
// "new/kept": an iteration with new factors over one with kept ones.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

#include "bench/scenes.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#include "integrators/step_system.h"

namespace flexarm {
namespace {

constexpr int kStepsBefore = 20, kTries = 200;

/// The shortest of many tries of `work`, each after `prepare` [s].
template <class Prepare, class Work>
double seconds_of(const Prepare& prepare, const Work& work) {
  using Clock = std::chrono::steady_clock;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kTries; ++k) {
    prepare();
    const Clock::time_point begin = Clock::now();
    work();
    least = std::min(least, std::chrono::duration<double>(Clock::now() - begin).count());
  }
  return least;
}

/// The parts of a step that begins in the simulation's state [s].
struct Parts {
  double begin, residual, tangent, factorise, solve, update, accept;

  explicit Parts(const Simulation& simulation) {
    const double step = simulation.step_size();
    StepSystem system(simulation.model(), make_scheme(simulation.scene().integrator));
    TangentBackend& backend = system.tangent();
    const auto nothing = [] {};

    State state = simulation.state();
    const auto started = [&] {
      state = simulation.state();
      system.begin(state, step, StepSystem::Guess::Extrapolated);
    };
    begin = seconds_of([&] { state = simulation.state(); },
                       [&] { system.begin(state, step, StepSystem::Guess::Extrapolated); });
    residual = seconds_of(nothing, [&] { system.evaluate(false); });
    tangent = seconds_of(nothing, [&] { system.evaluate(true); });
    factorise = seconds_of([&] { system.evaluate(true); }, [&] { benchmark::DoNotOptimize(backend.factorise()); });
    Eigen::VectorXd increment;
    solve =
        seconds_of([&] { increment = system.residual(); }, [&] { benchmark::DoNotOptimize(backend.solve(increment)); });
    increment.setZero();
    update = seconds_of(nothing, [&] {
      benchmark::DoNotOptimize(system.largest_rotation(increment));
      benchmark::DoNotOptimize(system.scaled_norm(increment));
      system.update(increment);
    });
    accept = seconds_of([&] { started(), system.evaluate(false); }, [&] { system.accept(state); });
  }
};

void share(benchmark::State& state, const scene::SceneDescription& scene, std::optional<double> step = {}) {
  SimulationOptions options;
  options.step = step;
  Simulation simulation(scene, options);
  for (int n = 0; n < kStepsBefore; ++n)
    if (!simulation.step().converged) return state.SkipWithError("the simulation failed");
  const Parts parts(simulation);
  double iterations = 0, factorisations = 0, whole = 0;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    const StepResult result = simulation.step();
    whole += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!result.converged) return state.SkipWithError(to_string(result.reason));
    iterations += result.iterations;
    factorisations += result.factorisations;
  }
  const double steps = static_cast<double>(state.iterations());
  iterations /= steps, factorisations /= steps, whole /= steps;
  double rest = 100;
  const auto count = [&](const char* name, double times, double seconds) {
    const double percent = 100 * times * seconds / whole;
    state.counters[name] = percent;
    rest -= percent;
  };
  count("begin%", 1, parts.begin);
  count("residual%", iterations - factorisations + 1, parts.residual);  // and the one at the solution
  count("tangent%", factorisations, parts.tangent);
  count("factorise%", factorisations, parts.factorise);
  count("solve%", iterations, parts.solve);
  count("update%", iterations, parts.update);
  count("accept%", 1, parts.accept);
  state.counters["rest%"] = rest;
  state.counters["iterations"] = iterations;
  state.counters["factorisations"] = factorisations;
  const double both = parts.solve + parts.update;
  state.counters["new/kept"] = (parts.tangent + parts.factorise + both) / (parts.residual + both);
}

void right_angle_cantilever(benchmark::State& state) {
  share(state, bench::right_angle_cantilever(static_cast<int>(state.range(0)), static_cast<int>(state.range(1))), 0.05);
}
BENCHMARK(right_angle_cantilever)
    ->Name("step_shares/right_angle_cantilever")
    ->ArgNames({"elements", "order"})
    ->ArgsProduct({{8, 32}, {1, 2}})
    ->Unit(benchmark::kMicrosecond);

void scene_file(benchmark::State& state, const char* path) {
  const scene::ReadResult read = scene::read_scene_file(path);
  if (!read.scene) return state.SkipWithError("the scene cannot be read");
  share(state, *read.scene);
}
BENCHMARK_CAPTURE(scene_file, demo_arm, FLEXARM_SOURCE_DIR "/config/demo_arm.urdf")
    ->Name("step_shares/demo_arm")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(scene_file, sliding_arm, FLEXARM_SOURCE_DIR "/config/examples/sliding_arm.urdf")
    ->Name("step_shares/sliding_arm")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace flexarm
