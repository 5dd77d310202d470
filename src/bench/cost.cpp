#include "bench/cost.h"

#include "accuracy/processor_time.h"
#include "bench/scenes.h"

namespace flexarm::bench {

Measured<Cost> cost_of_run(const Variant& variant, bool quick) {
  const int steps = quick ? 5 : 150;
  Simulation arm = simulation(swinging_arm(), variant, 2e-3, 1e-8);
  arm.step();  // the first step allocates memory, and has no last increment to extrapolate
  Cost cost;
  const double begin = processor_seconds();
  const std::optional<Failure> failure =
      run(arm, steps, [&](const StepResult& result) { cost.iterations += result.iterations; });
  cost.seconds = (processor_seconds() - begin) / steps;
  cost.iterations /= steps;
  return {failure, cost};
}

}  // namespace flexarm::bench
