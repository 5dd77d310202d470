#pragma once
/// Measures computing time per step.

#include <algorithm>
#include <array>
#include <vector>

#include "bench/run.h"

namespace flexarm::bench {

/// Number of runs, of which the median counts.
constexpr int kCostRuns = 3;

struct Cost {
  double seconds = 0;     ///< processor time per step, median of the runs
  double iterations = 0;  ///< of Newton's method per step
};

/// One run of swinging_arm (24 elements, about 300 unknowns) with steps of 2 ms.
Measured<Cost> cost_of_run(const Variant& variant, bool quick);

/// Runs all variants in turns, so that changes of the machine's speed affect all. Calls progress() after each run.
template <class Progress>
std::vector<Measured<Cost>> costs(const std::vector<Variant>& variants, bool quick, const Progress& progress) {
  std::vector<std::array<Measured<Cost>, kCostRuns>> runs(variants.size());
  for (int r = 0; r < kCostRuns; ++r)
    for (std::size_t i = 0; i < variants.size(); ++i) {
      runs[i][r] = cost_of_run(variants[i], quick);
      progress();
    }
  std::vector<Measured<Cost>> medians;
  for (auto& of_variant : runs) {
    std::sort(of_variant.begin(), of_variant.end(),
              [](const auto& a, const auto& b) { return a.value.seconds < b.value.seconds; });
    medians.push_back(of_variant[kCostRuns / 2]);
  }
  return medians;
}

}  // namespace flexarm::bench
