#include "integrators/step_prestrains.h"

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
      surplus_[i] = Vector6::Zero();
      if (scheme.is_incremental()) {
        of_step_[i] = mean_prestrain(model, static_cast<int>(i) - 1, time, time + step);
        surplus_[i] = of_step_[i] - mean_[i];
      } else {
        of_step_[i] = reach_ == 1 ? end : at(time + reach_ * step);
      }
    }
    do_work_ = do_work_ || change_[i] != Vector6::Zero() || surplus_[i] != Vector6::Zero();
    are_others = are_others || of_step_[i] != before;
  }
  return are_others;
}

}  // namespace flexarm
