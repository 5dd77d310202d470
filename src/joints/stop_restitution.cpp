#include "joints/stop_restitution.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace flexarm {
namespace {

/// An oscillator with the circular frequency 1: penetration x, its rate v, and the damping ratio.
struct Oscillator {
  double x, v, ratio;

  double force() const { return x + 2 * ratio * v; }
  /// Returns the oscillator after a step h of the classical Runge-Kutta method.
  Oscillator after(double h) const {
    const auto rate = [&](double x_, double v_) { return std::array{v_, -x_ - 2 * ratio * v_}; };
    const auto k1 = rate(x, v), k2 = rate(x + h / 2 * k1[0], v + h / 2 * k1[1]);
    const auto k3 = rate(x + h / 2 * k2[0], v + h / 2 * k2[1]), k4 = rate(x + h * k3[0], v + h * k3[1]);
    return {x + h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0]), v + h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1]),
            ratio};
  }
};

/// Returns the speed at the end of the contact, which is where its force vanishes, since a stop never pulls.
double speed_at_release(Oscillator contact) {
  double step = 0.01;
  while (step > 1e-12) {
    const Oscillator next = contact.after(step);
    if (next.force() > 0)
      contact = next;
    else
      step /= 2;
  }
  return -contact.v;
}

double restitution_of(double ratio) {
  return speed_at_release(Oscillator{0, 1, ratio}.after(1e-6));
}

}  // namespace

double stop_damping_ratio(double restitution) {
  assert(restitution >= 0 && restitution <= 1);
  restitution = std::max(restitution, kLeastRestitution);
  double low = 0, high = 10;  // bisection: the restitution decreases with the ratio
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (restitution_of(middle) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace flexarm
