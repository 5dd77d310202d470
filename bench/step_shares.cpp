// Measures the time of a step phase by phase, as the step reports it.
//
// Counters: the percentage of each phase ("rest%" is step control); iterations and factorisations per step; "new/kept":
// the time of an iteration with new factors relative to an iteration with kept factors.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>
#include <optional>
#include <utility>

#include "bench/scenes.h"
#include "building/model_builder.h"
#include "flexarm/scene/urdf_reader.h"
#include "integrators/stepper.h"
#include "schemes/scheme.h"
#include "simulation/observables.h"

namespace flexarm {
namespace {

constexpr int kStepsBefore = 20;

/// Measures the time of each phase and counts its calls.
class PhaseTimes : public StepObserver {
 public:
  void enter(StepPhase phase) override {
    const Clock::time_point now = Clock::now();
    if (running_) seconds_[index(current_)] += std::chrono::duration<double>(now - since_).count();
    ++counts_[index(phase)];
    current_ = phase;
    since_ = now;
    running_ = true;
  }
  /// Ends a step: the time until the next step does not count.
  void pause() {
    enter(StepPhase::Control);
    running_ = false;
  }
  double seconds(StepPhase phase) const { return seconds_[index(phase)]; }
  double mean(StepPhase phase) const { return seconds(phase) / std::max(counts_[index(phase)], 1L); }
  double whole() const { return std::accumulate(seconds_.begin(), seconds_.end(), 0.0); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kPhases = static_cast<std::size_t>(StepPhase::Control) + 1;
  static std::size_t index(StepPhase phase) { return static_cast<std::size_t>(phase); }

  std::array<double, kPhases> seconds_{};
  std::array<long, kPhases> counts_{};
  StepPhase current_ = StepPhase::Control;
  Clock::time_point since_;
  bool running_ = false;
};

void share(benchmark::State& state, const scene::SceneDescription& scene, std::optional<double> step = {}) {
  const Model model = build_model(scene);
  StepSettings settings;
  settings.step = step.value_or(scene.integrator.step);
  settings.tolerance = scene.integrator.tolerance;
  Stepper stepper(model, make_scheme(scene.integrator), settings);
  State moving = initial_state(model);
  stepper.initialise(moving);
  for (int n = 0; n < kStepsBefore; ++n)
    if (!stepper.advance(moving).converged) return state.SkipWithError("the simulation failed");
  PhaseTimes times;
  stepper.observe(&times);
  double iterations = 0, factorisations = 0;
  for (auto _ : state) {
    const StepResult result = stepper.advance(moving);
    times.pause();
    if (!result.converged) return state.SkipWithError(to_string(result.reason));
    iterations += result.iterations;
    factorisations += result.factorisations;
  }
  const double steps = static_cast<double>(state.iterations());
  const std::pair<const char*, StepPhase> names[] = {
      {"begin%", StepPhase::Begin},         {"residual%", StepPhase::Residual}, {"tangent%", StepPhase::Tangent},
      {"factorise%", StepPhase::Factorise}, {"solve%", StepPhase::Solve},       {"update%", StepPhase::Update},
      {"accept%", StepPhase::Accept},       {"rest%", StepPhase::Control}};
  for (const auto& [name, phase] : names) state.counters[name] = 100 * times.seconds(phase) / times.whole();
  state.counters["iterations"] = iterations / steps;
  state.counters["factorisations"] = factorisations / steps;
  const auto iteration = [&](StepPhase evaluation, StepPhase solution) {
    return times.mean(evaluation) + times.mean(solution) + times.mean(StepPhase::Update);
  };
  state.counters["new/kept"] =
      iteration(StepPhase::Tangent, StepPhase::Factorise) / iteration(StepPhase::Residual, StepPhase::Solve);
}

void step_shares_right_angle_cantilever(benchmark::State& state) {
  share(state, bench::right_angle_cantilever(static_cast<int>(state.range(0)), static_cast<int>(state.range(1))), 0.05);
}
BENCHMARK(step_shares_right_angle_cantilever)
    ->ArgNames({"elements", "order"})
    ->Args({8, 1})
    ->Args({8, 2})
    ->Args({32, 1})
    ->Args({32, 2})
    ->Unit(benchmark::kMicrosecond);

void step_shares(benchmark::State& state, const char* path) {
  const scene::ReadResult read = scene::read_scene_file(path);
  if (!read.scene) return state.SkipWithError("the scene cannot be read");
  share(state, *read.scene);
}
BENCHMARK_CAPTURE(step_shares, demo_arm, FLEXARM_SOURCE_DIR "/config/demo_arm.urdf")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step_shares, sliding_arm, FLEXARM_SOURCE_DIR "/config/examples/sliding_arm.urdf")
    ->Unit(benchmark::kMicrosecond);

enum class Kept { Free, Driven, Held, Fixed };

/// A swinging rigid arm of six joints. Its last two joints are free, or prescribed at zero by a function of time, or
/// prescribed by a constant, or fixed.
void still_wrist(benchmark::State& state, Kept kept) {
  scene::ReadResult read = scene::read_scene_file(FLEXARM_SOURCE_DIR "/config/speed/six_joint_arm.urdf");
  if (!read.scene) return state.SkipWithError("the scene cannot be read");
  scene::SceneDescription& scene = *read.scene;
  if (kept != Kept::Free) scene.initial_joints.resize(4);
  for (const int joint : {4, 5}) {
    const std::string& name = scene.joints[joint].name;
    if (kept == Kept::Fixed) scene.joints[joint].kind = scene::JointKind::Fixed;
    if (kept == Kept::Held) scene.motions.push_back({name, TimeFunction(0), {}});
    if (kept == Kept::Driven) scene.motions.push_back({name, TimeFunction::parse("0:0"), {}});
  }
  share(state, scene);
}
BENCHMARK_CAPTURE(still_wrist, free, Kept::Free)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(still_wrist, driven, Kept::Driven)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(still_wrist, held, Kept::Held)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(still_wrist, fixed, Kept::Fixed)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace flexarm
