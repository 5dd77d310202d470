#include "bench/robustness.h"

#include <algorithm>

#include "bench/scenes.h"

namespace flexarm::bench {

std::vector<HardScene> hard_scenes() {
  const std::vector<double> steps = {0.003, 0.005, 0.007, 0.01, 0.014};
  return {{"whip", stretched_whip("0:0 0.05:1 0.3:1 0.31:0"), 1, steps},
          {"whip pulled again", stretched_whip("0:0 0.05:1 0.3:1 0.31:0 0.5:0 0.6:1"), 1, steps},
          {"damped chain", damped_chain(), 2, steps},
          {"release", sudden_release(), 2, steps}};
}

Robustness robustness(const Variant& variant, const HardScene& hard, bool quick) {
  const auto balance = [](const Energies& e) { return e.total() - e.work + e.dissipated; };
  Robustness out;
  long steps = 0, halved = 0, iterations = 0;
  for (const double step : hard.steps) {
    Simulation scene = simulation(hard.scene, variant, step, 1e-8);
    const double begin = balance(scene.energies());
    const int wanted = quick ? 5 : static_cast<int>(std::lround(hard.until / step));
    double defect = 0, scale = 0;
    const std::optional<Failure> failure = run(scene, wanted, [&](const StepResult& result) {
      ++steps;
      iterations += result.iterations;
      if (result.halvings > 0) ++halved;
      const Energies e = scene.energies();
      defect = std::max(defect, std::abs(balance(e) - begin));
      scale = std::max({scale, e.kinetic, e.strain, std::abs(e.potential), std::abs(e.work)});
    });
    ++out.runs;
    if (!failure) ++out.completed;
    out.time_reached += failure ? failure->time / (wanted * step) : 1;
    if (scale > 0) out.energy_defect = std::max(out.energy_defect, defect / scale);
  }
  out.time_reached /= out.runs;
  if (steps == 0) return out;
  out.halved = static_cast<double>(halved) / static_cast<double>(steps);
  out.iterations = static_cast<double>(iterations) / static_cast<double>(steps);
  return out;
}

}  // namespace flexarm::bench
