#include "integrators/step_prestrains.h"

#include <algorithm>

namespace flexarm {

StepPrestrains::StepPrestrains(const StepConfiguration& configuration)
    : configuration_(configuration),
      of_step_(configuration.model().prestrains.size() + 1, Vector6::Zero()),
      mean_(of_step_),
      change_(of_step_),
      surplus_(of_step_) {
  const Scheme& scheme = configuration.scheme();
  if (scheme.hht == HhtForm::Kinematics && !scheme.is_static) reach_ = 1 + scheme.alpha;
}

bool StepPrestrains::begin(double factor) {
  const Scheme& scheme = configuration_.scheme();
  const Model& model = configuration_.model();
  const double time = configuration_.state().time, step = configuration_.step();
  bool are_others = false;
  do_work_ = false;
  for (std::size_t i = 1; i < of_step_.size(); ++i) {
    const auto at = [&](double t) -> Vector6 { return prestrain_at(model, static_cast<int>(i) - 1, t); };
    const Vector6 before = of_step_[i];
    if (scheme.is_static) {
      of_step_[i] = factor * at(0);
    } else {
      const Vector6 begin = at(time), end = at(time + step);
      change_[i] = end - begin;
      mean_[i] = 0.5 * (begin + end);
      const Vector6 over_step = mean_prestrain(model, static_cast<int>(i) - 1, time, time + step);
      // Forces that are those at instants make up for jumps within the step as StepHistories has it.
      const double earlier = time + (reach_ - 1) * step, share = reach_ == 1 ? 0.5 : scheme.gamma;
      const Vector6 point = reach_ == 1 ? end : at(time + reach_ * step);
      const Vector6 last = reach_ == 1 ? begin : at(time >= 0 ? std::max(earlier, 0.0) : earlier);
      surplus_[i] = over_step - (scheme.is_incremental() ? mean_[i] : Vector6((1 - share) * last + share * point));
      of_step_[i] = scheme.is_incremental() ? over_step : Vector6(point + surplus_[i]);
    }
    do_work_ = do_work_ || change_[i] != Vector6::Zero() || surplus_[i] != Vector6::Zero();
    are_others = are_others || of_step_[i] != before;
  }
  return are_others;
}

}  // namespace flexarm
