#include "bench/dissipation.h"

#include "bench/scenes.h"

namespace flexarm::bench {
namespace {

constexpr double kStep = 0.01;         // s
constexpr double kNoiseFloor = 1e-18;  // of the energy, relative to its first value

/// Slope of y over 0, 1, 2, ...
double slope(const std::vector<double>& y) {
  const double n = static_cast<double>(y.size()), middle = 0.5 * (n - 1);
  double numerator = 0, denominator = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    numerator += (static_cast<double>(i) - middle) * y[i];
    denominator += (static_cast<double>(i) - middle) * (static_cast<double>(i) - middle);
  }
  return denominator > 0 ? numerator / denominator : 0;
}

}  // namespace

double DissipationPoint::loss_per_period() const {
  constexpr double kTurn = 6.283185307179586;
  return 1 - std::pow(spectral_radius, 2 * kTurn / frequency);
}

Measured<DissipationPoint> dissipation(const Variant& variant, double frequency, bool quick) {
  const double omega = frequency / kStep;
  Variant with_step = variant;
  with_step.integrator.step = kStep;
  Simulation bar = simulation(axial_oscillator(omega), with_step, kStep);
  const auto& element = std::get<BeamGroup<2>>(bar.model().beams).elements.front();
  const int tip = element.nodes[1];
  State state = bar.state();
  const double velocity = 0.05 * omega;
  state.nodes[tip].velocity.x() = velocity;
  for (StrainMemory& memory : state.strain_memory) memory.rate[0] = velocity;  // of the axial strain: 1 m long
  bar.restore(state);
  const auto energy = [&] {
    const NodeState& node = bar.state().nodes[tip];
    const double u = node.position.x() - 1, v = node.velocity.x() / omega;
    return u * u + v * v;
  };
  const double begin = energy();
  std::vector<double> logarithms;
  bool is_above_noise = true;
  const std::optional<Failure> failure = run(bar, quick ? 40 : 400, [&](const StepResult&) {
    is_above_noise = is_above_noise && energy() > kNoiseFloor * begin;
    if (is_above_noise) logarithms.push_back(std::log(energy() / begin));
  });
  if (failure) return {failure, {frequency, 0}};
  // The first quarter holds what dies faster than the slowest root.
  logarithms.erase(logarithms.begin(), logarithms.begin() + static_cast<long>(logarithms.size() / 4));
  return {{}, {frequency, logarithms.size() < 2 ? 0.0 : std::exp(0.5 * slope(logarithms))}};
}

std::vector<double> dissipation_frequencies(bool quick) {
  const double lowest = 0.05, highest = 100;
  const int count = quick ? 3 : 23;
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(lowest * std::pow(highest / lowest, i / (count - 1.0)));
  return out;
}

}  // namespace flexarm::bench
