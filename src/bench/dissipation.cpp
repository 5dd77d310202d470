#include "bench/dissipation.h"

#include "bench/scenes.h"
#include "simulation/inside.h"

namespace flexarm::bench {
namespace {

constexpr double kStep = 0.01;         // s
constexpr double kNoiseFloor = 1e-26;  // of the energy, relative to its initial value; round-off of 1 m is 4e-30

/// Least-squares slope of y over 0, 1, 2, ...
double slope(const std::vector<double>& y) {
  const double n = static_cast<double>(y.size()), middle = 0.5 * (n - 1);
  double numerator = 0, denominator = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    numerator += (static_cast<double>(i) - middle) * y[i];
    denominator += (static_cast<double>(i) - middle) * (static_cast<double>(i) - middle);
  }
  return denominator > 0 ? numerator / denominator : 0;
}

/// Energies, divided by half the stiffness [m^2], after each step of a motion that starts with the displacement u [m]
/// and the velocity omega v [m/s].
Measured<std::vector<double>> energies_of_decay(const Variant& variant, double omega, double u, double v, int steps) {
  Simulation bar = simulation(axial_oscillator(omega), variant, kStep);
  const int tip = std::get<BeamGroup<2>>(model_of(bar).beams).elements.front().nodes[1];
  State state = state_of(bar);
  state.nodes[tip].position.x() += u;
  state.nodes[tip].velocity.x() = omega * v;
  state.nodes[tip].acceleration.x() = -omega * omega * u;
  for (StrainMemory& memory : state.strain_memory)
    memory.rate[0] = omega * v;  // axial strain rate; the bar is 1 m long
  restore(bar, state);
  Measured<std::vector<double>> out;
  out.failure = run(bar, steps, [&](const StepResult&) {
    const NodeState& node = state_of(bar).nodes[tip];
    const double displacement = node.position.x() - 1, velocity = node.velocity.x() / omega;
    out.value.push_back(displacement * displacement + velocity * velocity);
  });
  return out;
}

}  // namespace

double DissipationPoint::loss_per_period() const {
  constexpr double kTurn = 6.283185307179586;
  return 1 - std::pow(spectral_radius, 2 * kTurn / frequency);
}

Measured<DissipationPoint> dissipation(const Variant& variant, double frequency, bool quick) {
  const double omega = frequency / kStep, amplitude = 0.05;
  const int steps = quick ? 40 : 400;
  const auto pushed = energies_of_decay(variant, omega, 0, amplitude, steps),
             pulled = energies_of_decay(variant, omega, amplitude, 0, steps);
  for (const auto* motion : {&pushed, &pulled})
    if (motion->failure) return {motion->failure, {frequency, 0}};
  // The sum of two motions, since the energy of a single one may pass through zero.
  std::vector<double> logarithms;
  for (int n = 0; n < steps; ++n) {
    const double energy = pushed.value[n] + pulled.value[n];
    if (energy < kNoiseFloor * amplitude * amplitude) break;
    logarithms.push_back(std::log(energy));
  }
  // The first quarter contains parts that decay faster than the slowest root.
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
