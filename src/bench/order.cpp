#include "bench/order.h"

#include <algorithm>
#include <vector>

#include "bench/scenes.h"

namespace flexarm::bench {
namespace {

using History = std::vector<Vector3>;

constexpr double kCoarsestStep = 0.02;  // s

Measured<History> probe_history(const Variant& variant, int refinement, int samples) {
  Simulation tree = simulation(loaded_tree(), variant, kCoarsestStep / refinement);
  Measured<History> out;
  for (int n = 0; n < samples; ++n) {
    out.failure = run(tree, refinement);
    if (out.failure) return out;
    for (std::size_t i = 0; i < tree.scene().probes.size(); ++i) out.value.push_back(tree.probe(i).pose.position);
  }
  return out;
}

double distance(const History& a, const History& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Largest distance of a probe from its initial position.
double amplitude(const History& history, std::size_t probes) {
  double largest = 0;
  for (std::size_t i = probes; i < history.size(); ++i)
    largest = std::max(largest, (history[i] - history[i % probes]).norm());
  return largest;
}

}  // namespace

Measured<OrderInTime> order_in_time(const Variant& variant, bool quick) {
  const int samples = quick ? 10 : 60;
  std::vector<History> runs;
  for (const int refinement : {1, 2, 4, 8, 16}) {
    Measured<History> history = probe_history(variant, refinement, samples);
    if (history.failure) return {history.failure, {}};
    runs.push_back(std::move(history.value));
  }
  History reference = runs[4];
  const double gain = std::pow(2.0, variant.scheme.order) - 1;
  for (std::size_t i = 0; i < reference.size(); ++i) reference[i] += (runs[4][i] - runs[3][i]) / gain;
  const std::size_t probes = reference.size() / static_cast<std::size_t>(samples);
  const double errors[] = {distance(runs[0], reference), distance(runs[1], reference), distance(runs[2], reference)};
  return {{}, {std::log2(errors[1] / errors[2]), errors[0] / amplitude(reference, probes)}};
}

}  // namespace flexarm::bench
