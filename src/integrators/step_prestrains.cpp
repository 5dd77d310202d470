#include "integrators/step_prestrains.h"

#include <algorithm>

#include "math/step_end.h"

namespace flexarm {

StepPrestrains::StepPrestrains(const StepConfiguration& configuration)
    : configuration_(configuration),
      of_step_(configuration.model().prestrains.size() + 1, Vector6::Zero()),
      mean_(of_step_),
      change_(of_step_),
      surplus_(of_step_),
      made_up_(of_step_),
      last_made_up_(of_step_) {
  const Scheme& scheme = configuration.scheme();
  if (scheme.hht == HhtForm::Kinematics && !scheme.is_static) reach_ = 1 + scheme.alpha;
}

bool StepPrestrains::begin(double factor) {
  const Scheme& scheme = configuration_.scheme();
  const Model& model = configuration_.model();
  const double time = configuration_.state().time, step = configuration_.step(), end_time = configuration_.end_time();
  const bool is_endpoint = !scheme.is_static && !scheme.is_incremental();
  bool are_others = false;
  do_work_ = false;
  if (is_endpoint && of_step_.size() > 1) find_last_made_up();
  for (std::size_t i = 1; i < of_step_.size(); ++i) {
    const auto at = [&](double t) -> Vector6 { return prestrain_at(model, static_cast<int>(i) - 1, t); };
    const Vector6 before = of_step_[i];
    if (scheme.is_static) {
      of_step_[i] = factor * at(0);
    } else {
      const Vector6 begin = at(time), end = at(end_time);
      change_[i] = end - begin;
      mean_[i] = 0.5 * (begin + end);
      if (is_endpoint) {
        made_up_[i] = made_up(i, time, step);
        of_step_[i] = (reach_ == 1 ? end : at(time + reach_ * step)) + made_up_[i];
        surplus_[i] = scheme.gamma * made_up_[i] + (1 - scheme.gamma) * last_made_up_[i];
      } else {
        of_step_[i] = mean_prestrain(model, static_cast<int>(i) - 1, time, end_time);
        surplus_[i] = of_step_[i] - mean_[i];
      }
    }
    do_work_ = do_work_ || change_[i] != Vector6::Zero() || surplus_[i] != Vector6::Zero();
    are_others = are_others || of_step_[i] != before;
  }
  made_up_end_ = end_time;
  made_up_step_ = step;
  return are_others;
}

Vector6 StepPrestrains::made_up(std::size_t i, double begin, double step) const {
  const Model& model = configuration_.model();
  const int index = static_cast<int>(i) - 1;
  const double end = step_end(begin, step);
  const Vector6 mean = mean_prestrain(model, index, begin, end);
  if (reach_ == 1) return mean - 0.5 * (prestrain_at(model, index, begin) + prestrain_at(model, index, end));
  // The instants at which the last step and this one evaluate forces. There are no forces before the start.
  const double earlier = begin - (1 - reach_) * step, gamma = configuration_.scheme().gamma;
  return mean - (1 - gamma) * prestrain_at(model, index, begin >= 0 ? std::max(earlier, 0.0) : earlier) -
         gamma * prestrain_at(model, index, begin + reach_ * step);
}

void StepPrestrains::find_last_made_up() {
  const State& state = configuration_.state();
  const IncrementHistory& history = state.history;
  const double step = history.count > 0 ? history.steps[0] : 0;
  if (state.time == last_end_ && step == last_step_) return;  // the same step is tried again
  const bool has_gone_on = state.time == made_up_end_ && step == made_up_step_;
  last_end_ = state.time;
  last_step_ = step;
  if (has_gone_on) return last_made_up_.swap(made_up_);
  for (std::size_t i = 1; i < last_made_up_.size(); ++i)
    last_made_up_[i] = step == 0 ? Vector6(Vector6::Zero()) : made_up(i, state.time - step, step);
}

}  // namespace flexarm
