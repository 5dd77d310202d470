// Measures how much time a batch of simulations saves.
#include <chrono>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>

#include "bench/markdown_table.h"
#include "bench/median.h"
#include "bench/speed.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/batch.h"

namespace flexarm::bench {
namespace {

constexpr int kBatchTurns = 5;
constexpr double kBatchStep = 1e-3;    // [s]
constexpr double kStartSpread = 1e-3;  // between the starts of neighbours [rad]

double wall_seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void advance_by(Simulation& simulation, long steps) {
  for (long n = 0; n < steps; ++n)
    if (!simulation.step().converged) throw std::runtime_error("a step of a batch has failed");
}

}  // namespace

std::vector<BatchComparison> compare_batches(const std::string& folder, bool quick) {
  std::vector<BatchComparison> comparisons;
  for (const char* scene :
       {"examples/flexible_two_link_arm.urdf", "speed/control_arm.urdf", "speed/six_joint_arm.urdf"}) {
    const std::size_t arms = quick ? 4 : 100;
    const long steps = quick ? 5 : 200;
    SimulationOptions options;
    options.step = kBatchStep;
    Batch batch(Simulation(scene::read_scene_file(folder + "/" + scene).scene.value(), options), arms);
    for (std::size_t i = 0; i < arms; ++i) batch[i].set_joint_state({{0, kStartSpread * static_cast<double>(i), {}}});
    std::vector<Snapshot> starts;
    for (std::size_t i = 0; i < arms; ++i) starts.push_back(batch[i].snapshot());
    const auto restart = [&] {
      for (std::size_t i = 0; i < arms; ++i) batch[i].restore(starts[i]);
    };
    std::vector<double> alone, together;
    for (int turn = 0; turn < (quick ? 1 : kBatchTurns); ++turn) {
      restart();
      alone.push_back(wall_seconds_of([&] {
        for (std::size_t i = 0; i < arms; ++i) advance_by(batch[i], steps);
      }));
      restart();
      together.push_back(wall_seconds_of([&] { batch.for_each([&](std::size_t i) { advance_by(batch[i], steps); }); }));
    }
    comparisons.push_back({scene, arms, batch.threads(), steps, median(alone), median(together)});
  }
  return comparisons;
}

std::string batch_table(const std::vector<BatchComparison>& comparisons) {
  std::string text = head({"scene", "arms", "threads", "alone, µs per step", "together, µs per step", "ratio"});
  for (const BatchComparison& c : comparisons) {
    const double steps = static_cast<double>(c.steps) * static_cast<double>(c.arms);
    text += row({c.scene, fmt::format("{}", c.arms), fmt::format("{}", c.threads),
                 fmt::format("{:.3g}", 1e6 * c.alone_seconds / steps),
                 fmt::format("{:.3g}", 1e6 * c.together_seconds / steps),
                 fmt::format("{:.2g}", c.together_seconds / c.alone_seconds)});
  }
  return text;
}

}  // namespace flexarm::bench
