#include "pacer.h"

#include <algorithm>
#include <cmath>

namespace flexarm::node {

Pacer::Pacer(double step, double real_time_factor, double max_catch_up) {
  set_pace(step, real_time_factor, max_catch_up);
}

void Pacer::set_pace(double step, double real_time_factor, double max_catch_up) {
  step_ = step;
  real_time_factor_ = real_time_factor;
  // At least two steps: a backlog of nearly one step, plus one more tick, must not count as an overrun.
  max_backlog_ = std::max(real_time_factor * max_catch_up, 2 * step);
}

void Pacer::elapse(double wall_time) {
  backlog_ += real_time_factor_ * wall_time;
  if (backlog_ <= max_backlog_) return;
  const double dropped_steps = std::ceil((backlog_ - max_backlog_) / step_);
  backlog_ -= dropped_steps * step_;
  overruns_ += static_cast<std::uint64_t>(dropped_steps);
}

void Pacer::step_done() {
  if (!as_fast_as_possible()) backlog_ -= step_;
}

}  // namespace flexarm::node
