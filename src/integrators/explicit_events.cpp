#include "integrators/explicit_events.h"

#include <limits>

namespace flexarm {

ExplicitEvents::ExplicitEvents(const Model& model, std::size_t kinks)
    : model_(model), kinks_(kinks), contacts_(model.coordinates.size()) {
  for (std::size_t i = 0; i < model.coordinates.size(); ++i) {
    if (!model.coordinates[i].limit || is_held(model, model.coordinates[i])) continue;
    for (const bool is_above : {false, true}) sides_.push_back({i, is_above});
  }
}

bool ExplicitEvents::set(Side& side, Stage stage) {
  const bool changes = side.stage != stage;
  side.stage = stage;
  contacts_[side.coordinate][side.is_above] = !stage                   ? StopContact::ByDepth
                                              : stage == StopStage::In ? StopContact::On
                                                                       : StopContact::Off;
  return changes;
}

double ExplicitEvents::guard(const Side& side, const StopReach& at) {
  const bool has_left = side.stage == StopStage::Released && side.now.depth < 0;
  return has_left ? at.depth : stop_guard(*side.stage, at);
}

void ExplicitEvents::begin_kinks(const std::vector<double>& margins) {
  for (std::size_t i = 0; i < kinks_.size(); ++i) {
    const double sign = margins[i] > 0 ? 1 : margins[i] < 0 ? -1 : 0;
    kinks_[i] = {sign, margins[i], margins[i]};
  }
}

double ExplicitEvents::guard(std::size_t event) const {
  if (event < sides_.size()) return guard(sides_[event], sides_[event].now);
  const Kink& kink = kinks_[event - sides_.size()];
  return kink.sign * kink.now;
}

double ExplicitEvents::low_guard(std::size_t event) const {
  if (event < sides_.size()) return guard(sides_[event], sides_[event].low);
  const Kink& kink = kinks_[event - sides_.size()];
  return kink.sign * kink.low;
}

std::optional<std::size_t> ExplicitEvents::first() const {
  std::optional<std::size_t> first;
  double earliest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < sides_.size() + kinks_.size(); ++i) {
    const bool is_stop = i < sides_.size();
    if (is_stop && !sides_[i].stage) continue;
    if (is_stop && sides_[i].stage == StopStage::Out && sides_[i].now.push <= 0) continue;
    const double before = low_guard(i), after = guard(i);
    if (!(after < 0)) continue;
    const double fraction = before / (before - after);
    if (fraction < earliest) first = i, earliest = fraction;
  }
  return first;
}

void ExplicitEvents::keep_low() {
  for (Side& side : sides_) side.low = side.now;
  for (Kink& kink : kinks_) kink.low = kink.now;
}

void ExplicitEvents::turn(std::size_t event) {
  if (event >= sides_.size()) {
    kinks_[event - sides_.size()].sign = 0;
    return;
  }
  Side& side = sides_[event];
  if (side.stage == StopStage::In)
    set(side, StopStage::Released);
  else
    set(side, side.stage == StopStage::Released && side.now.depth < 0 ? StopStage::Out : StopStage::In);
}

void ExplicitEvents::let_go() {
  for (Side& side : sides_) set(side, {});
  for (Kink& kink : kinks_) kink.sign = 0;
}

}  // namespace flexarm
