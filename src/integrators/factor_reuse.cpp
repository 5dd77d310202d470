#include "integrators/factor_reuse.h"

#include <algorithm>
#include <cmath>

namespace flexarm {
namespace {

// Measured over 26 pairs of scenes and schemes (docs/notes/newton.md 5): half or twice of each of these constants
// changes the cost by less than 0.5 % in the mean.

/// Weight of the last solve in the mean cost of its plan.
constexpr double kWeight = 0.125;
/// Trials may add 1/64 to the cost of the cheapest plan. So after a trial that cost (1 + x) times as much as this plan,
/// there is no trial for 64 x solves.
constexpr double kSolvesPerLoss = 64;
/// Smallest number of solves between trials. A cheap trial tells little that is new.
constexpr double kShortestPause = 16;

}  // namespace

FactorReuse::FactorReuse(double cost) : cost_of_factors_(cost) {
  // An unknown plan is assumed to cost as much as full Newton with four iterations. So it is tried only if all known
  // plans cost more.
  for (Plan& plan : plans_) plan.cost = 4 * cost;
}

bool FactorReuse::begin(bool hold) {
  int plan = cheapest();
  if (plans_[plan].is_known && ++since_trial_ > pause_) {
    since_trial_ = 0;
    tries_more_ = !tries_more_;
    plan += plan == 0 || (tries_more_ && plan < kFull) ? 1 : -1;
    tried_ = plan;
  }
  planned_ = hold ? plan : std::max(plan, 1);
  plans_[planned_].is_open = true;
  return planned_ > 0;
}

bool FactorReuse::renew(int next, const UpdateOutlook& update) const {
  if (next < planned_ || planned_ == kFull) return true;
  const double digits = -std::log10(update.norm);
  double rate = digits;  // digits per iteration with kept factors: at most as many as are correct where they were made
  if (!update.is_by_new) {
    if (update.contraction == 0) return false;
    rate = -std::log10(update.contraction);
  }
  const double right = digits + rate;  // number of correct digits after the update
  const double missing = -std::log10(update.target) - right;
  if (missing <= 0) return false;
  // Farther from the solution, new factors cannot be expected to converge quadratically.
  constexpr double kFewestDigits = 0.5;
  if (rate <= 0 || right < kFewestDigits) return true;
  // New factors double the digits. Kept ones then add as many digits per iteration as were correct where they were
  // made. The estimate includes one more iteration, which shows what the first update with new factors has left.
  const double once = cost_of_factors_ + std::ceil(std::max(missing - right, 0.0) / right);
  const double twice = 2 * cost_of_factors_ + std::ceil(std::max(missing - 3 * right, 0.0) / (2 * right));
  return std::ceil(missing / rate) > 1 + std::min(once, twice);
}

void FactorReuse::end(int iterations, int factorisations, bool converged) {
  const double cost = iterations + (cost_of_factors_ - 1) * factorisations;
  for (Plan& plan : plans_) {
    if (!plan.is_open) continue;
    plan.open_cost += cost;
    if (converged) record(plan);
  }
}

void FactorReuse::record(Plan& plan) {
  const double cost = plan.open_cost;
  const bool is_trial = tried_ >= 0 && &plan == &plans_[tried_];
  if (is_trial) {
    tried_ = -1;
    pause_ = std::max(kSolvesPerLoss * (cost / plans_[cheapest()].cost - 1), kShortestPause);
  }
  // A trial replaces the old mean, since it shows the present cost.
  plan.cost = plan.is_known && !is_trial ? plan.cost + kWeight * (cost - plan.cost) : cost;
  plan.is_known = true;
  plan.open_cost = 0;
  plan.is_open = false;
}

int FactorReuse::cheapest() const {
  int best = 1;
  for (const int k : {2, kFull, 0}) {
    if (plans_[best].is_open || (!plans_[k].is_open && plans_[k].cost < plans_[best].cost)) best = k;
  }
  return best;
}

}  // namespace flexarm
