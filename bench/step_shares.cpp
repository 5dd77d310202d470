// What a step spends its time on: the loop of Stepper, with a clock between its parts. Counters are percent.
#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <optional>

#include "bench/scenes.h"
#include "flexarm/integrators/factor_reuse.h"
#include "flexarm/integrators/step_system.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#include "flexarm/solver/linear_solver.h"

namespace flexarm {
namespace {

enum Part { kBegin, kResidual, kTangent, kFactorise, kSolve, kUpdate, kAccept, kParts };
constexpr const char* kNames[] = {"begin%", "residual%", "tangent%", "factorise%", "solve%", "update%", "accept%"};

/// Times what happens between its calls.
class Clock {
 public:
  using Time = std::chrono::steady_clock;

  void restart() { last_ = Time::now(); }
  void charge(Part part) {
    const Time::time_point now = Time::now();
    seconds_[part] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  double seconds(Part part) const { return seconds_[part]; }

 private:
  Time::time_point last_;
  std::array<double, kParts> seconds_{};
};

class TimedStepper {
 public:
  explicit TimedStepper(const Simulation& simulation)
      : state_(simulation.state()),
        step_(simulation.step_size()),
        tolerance_(simulation.scene().integrator.tolerance),
        system_(simulation.model(), make_scheme(simulation.scene().integrator),
                StepSystem::tangent_for(simulation.model())),
        update_(system_.assembler().unknowns()),
        reuse_(system_.tree() ? FactorReuse::kTree : FactorReuse::kMatrix) {
    const SparseAssembler& matrix = system_.assembler();
    if (!system_.tree()) solver_.emplace(matrix.unknowns(), matrix.column_starts(), matrix.row_indices());
  }

  /// One step by Newton's method with kept factors, as Stepper tries first; false if that does not converge.
  bool advance() {
    clock_.restart();
    system_.begin(state_, step_, StepSystem::Guess::Extrapolated);
    clock_.charge(kBegin);
    bool factorise = reuse_.begin(has_factors_);
    double last = 0;
    for (int iteration = 0; iteration < 20; ++iteration) {
      if (!system_.evaluate(factorise)) return false;
      clock_.charge(factorise ? kTangent : kResidual);
      if (factorise && !factorise_tangent()) return false;
      has_factors_ = true;
      clock_.charge(kFactorise);
      update_ = -system_.residual();
      if (!(system_.tree() ? system_.tree()->solve(update_) : solver_->solve(update_))) return false;
      clock_.charge(kSolve);
      const double norm = system_.scaled_norm(update_), rate = iteration > 0 ? norm / last : 1.0;
      const bool squares = factorise;
      last = norm;
      factorise = reuse_.renew(iteration, !squares, iteration > 0, rate);
      system_.update(update_);
      clock_.charge(kUpdate);
      ++iterations_;
      if (norm * (squares ? rate * rate : rate) > std::max(tolerance_ * tolerance_, 1e-15)) continue;
      if (!system_.evaluate(false)) return false;
      clock_.charge(kResidual);
      system_.accept(state_);
      clock_.charge(kAccept);
      return true;
    }
    return false;
  }

  const Clock& clock() const { return clock_; }
  long iterations() const { return iterations_; }

 private:
  bool factorise_tangent() {
    if (system_.tree()) return system_.tree()->factorise();
    return solver_->factorise(system_.assembler().values(), system_.assembler().pattern());
  }

  State state_;
  double step_, tolerance_;
  StepSystem system_;
  std::optional<LinearSolver> solver_;  // where the model is no tree
  Eigen::VectorXd update_;
  FactorReuse reuse_;
  bool has_factors_ = false;
  Clock clock_;
  long iterations_ = 0;
};

void share(benchmark::State& state, const scene::SceneDescription& scene, double step) {
  SimulationOptions options;
  options.step = step;
  Simulation simulation(scene, options);
  for (int n = 0; n < 20; ++n)
    if (!simulation.step().converged) return state.SkipWithError("the simulation failed");
  TimedStepper stepper(simulation);
  for (auto _ : state)
    if (!stepper.advance()) return state.SkipWithError("Newton's method with kept factors did not converge");
  double whole = 0;
  for (int part = 0; part < kParts; ++part) whole += stepper.clock().seconds(static_cast<Part>(part));
  for (int part = 0; part < kParts; ++part)
    state.counters[kNames[part]] = 100 * stepper.clock().seconds(static_cast<Part>(part)) / whole;
  state.counters["newton"] = static_cast<double>(stepper.iterations()) / static_cast<double>(state.iterations());
}

void right_angle_cantilever(benchmark::State& state) {
  share(state, bench::right_angle_cantilever(static_cast<int>(state.range(0)), static_cast<int>(state.range(1))), 0.05);
}
BENCHMARK(right_angle_cantilever)
    ->Name("step_shares/right_angle_cantilever")
    ->ArgNames({"elements", "order"})
    ->ArgsProduct({{8, 32}, {1, 2}})
    ->Unit(benchmark::kMicrosecond);

void swinging_arm(benchmark::State& state) {
  share(state, bench::swinging_arm(), 2e-3);
}
BENCHMARK(swinging_arm)->Name("step_shares/swinging_arm")->Unit(benchmark::kMicrosecond);

void demo_arm(benchmark::State& state) {
  const scene::ReadResult read = scene::read_scene_file(FLEXARM_SOURCE_DIR "/config/demo_arm.urdf");
  if (!read.scene) return state.SkipWithError("config/demo_arm.urdf cannot be read");
  share(state, *read.scene, read.scene->integrator.step);
}
BENCHMARK(demo_arm)->Name("step_shares/demo_arm")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace flexarm
