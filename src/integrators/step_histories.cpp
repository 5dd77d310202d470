#include "integrators/step_histories.h"

#include <cassert>

namespace flexarm {
namespace {

/// The times of a step at which the scheme needs forces.
struct Instants {
  // Ends of the step; then the times at which forces are evaluated in the last step and in this one.
  double begin, end, earlier, point;
  double share;  // weight of `point` in the mean of these two forces that stands for the step's mean
};

/// Instants for efforts. In the Newmark family, the rows of coordinates are balances at the end of a step.
Instants ends_of(const StepConfiguration& configuration) {
  const double begin = configuration.state().time, end = configuration.end_time();
  return {begin, end, begin, end, 0.5};
}
/// Instants for loads.
Instants instants_of(const StepConfiguration& configuration) {
  const Scheme& scheme = configuration.scheme();
  Instants out = ends_of(configuration);
  if (scheme.hht != HhtForm::Kinematics) return out;
  const double back = scheme.alpha * configuration.step();
  // There are no forces before the start; the first accelerations belong to the start itself.
  out.earlier = out.begin >= 0 ? std::max(out.begin + back, 0.0) : out.begin + back;
  out.point = out.end + back;
  out.share = scheme.gamma;
  return out;
}

template <class Value, class Mean>
StepForce force_over(const Scheme& scheme, const Instants& at, const Value& value, const Mean& mean) {
  StepForce out;
  if (scheme.is_static) {
    out.acting = out.mean = out.at_end = value(0.0);
    return out;
  }
  out.mean = mean(at.begin, at.end);
  if (scheme.is_incremental()) {
    out.acting = out.at_end = out.mean;
    return out;
  }
  out = StepForce::at_points(out.mean, value(at.earlier), value(at.point), at.share);
  if (at.point != at.end) out.at_end = value(at.end);
  return out;
}

}  // namespace

StepHistories::StepHistories(const Model& model)
    : loads_(model.histories.size()), servos_(loads_), efforts_(model.coordinates.size()) {
  std::vector<bool> varies(loads_.size()), loads(loads_.size()), servos(loads_.size());
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    const std::optional<double> constant = model.histories[i].constant();
    varies[i] = !constant;
    if (constant) loads_[i] = servos_[i] = {*constant, *constant, *constant};
  }
  for (const NodalLoad& load : model.loads) loads[load.history] = true;
  for (const Actuator& actuator : model.actuators) {
    if (!actuator.servo) continue;
    for (const int history : {actuator.servo->set_point, actuator.servo->feedforward})
      if (history >= 0) servos[history] = true;
  }
  for (std::size_t i = 0; i < varies.size(); ++i) {
    if (varies[i] && loads[i]) load_histories_.push_back(static_cast<int>(i));
    if (varies[i] && servos[i]) servo_histories_.push_back(static_cast<int>(i));
  }
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    const Coordinate& coordinate = model.coordinates[i];
    if (coordinate.effort < 0) continue;
    const double value = varies[coordinate.effort] ? 0 : loads_[coordinate.effort].mean;
    efforts_[i].acting = efforts_[i].mean = efforts_[i].at_end = applied_effort(coordinate, value, 0);
    if (varies[coordinate.effort]) moved_.push_back(static_cast<int>(i));
  }
}

void StepHistories::begin(const StepConfiguration& configuration) {
  const Scheme& scheme = configuration.scheme();
  const Model& model = configuration.model();
  const Instants at = instants_of(configuration), ends = ends_of(configuration);
  const auto force = [&](const TimeFunction& f, const Instants& instants) {
    return force_over(scheme, instants, f, [&](double begin, double end) { return f.mean(begin, end); });
  };
  for (const int i : load_histories_) loads_[i] = force(model.histories[i], at);
  for (const int i : servo_histories_) servos_[i] = force(model.histories[i], ends);
  for (const int i : moved_) {
    const TimeFunction& f = model.histories[model.coordinates[i].effort];
    const double limit = model.coordinates[i].effort_limit;
    efforts_[i] = limit <= 0 ? force(f, ends)
                             : force_over(
                                   scheme, ends, [&](double t) { return std::clamp(f(t), -limit, limit); },
                                   [&](double begin, double end) { return f.mean_within(limit, begin, end); });
  }
}

StepForce StepHistories::effort(const Model& model, std::size_t coordinate, double commanded) const {
  assert(coordinate < efforts_.size());
  StepForce out = efforts_[coordinate];
  if (!std::isnan(commanded))
    out.acting = out.mean = out.at_end = applied_effort(model.coordinates[coordinate], commanded, 0);
  out.acting *= factor, out.mean *= factor, out.at_end *= factor;
  return out;
}

}  // namespace flexarm
