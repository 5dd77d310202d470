#include "integrators/stop_contacts.h"

#include <algorithm>

namespace flexarm {

StopContacts::StopContacts(StepConfiguration& configuration) : configuration_(configuration) {
  const std::vector<Coordinate>& coordinates = configuration.model().coordinates;
  for (std::size_t index = 0; index < coordinates.size(); ++index) {
    const Coordinate& coordinate = coordinates[index];
    if (!coordinate.limit) continue;
    const Coordinate& leader = coordinate.mimicked >= 0 ? coordinates[coordinate.mimicked] : coordinate;
    stopped_.push_back({index, &leader, 0, 0});
  }
}

const Coordinate& StopContacts::coordinate(const Stopped& stopped) const {
  return configuration_.model().coordinates[stopped.index];
}

/// Computes the positions of mimic coordinates, which are not up to date before StepConfiguration::set_slaves().
double StopContacts::position(const Coordinate& coordinate) const {
  if (coordinate.mimicked >= 0)
    return coordinate.mimic.value(position(configuration_.model().coordinates[coordinate.mimicked]));
  return configuration_.released()[coordinate.joint].displacement[coordinate.component];
}

double StopContacts::begin_position(const Stopped& stopped) const {
  const Coordinate& limited = coordinate(stopped);
  return position(limited) - configuration_.increment_of(limited);
}

/// Requires StepConfiguration::find_begin_rates().
double StopContacts::begin_rate(const Stopped& stopped) const {
  const Coordinate& limited = coordinate(stopped);
  return configuration_.begin_rates(limited.joint)[limited.component];
}

void StopContacts::before_update() {
  for (Stopped& stopped : stopped_) {
    stopped.position = position(coordinate(stopped));
    stopped.leading_position = position(*stopped.leader);
  }
}

void StopContacts::after_update() {
  for (const Stopped& stopped : stopped_) {
    const Coordinate& limited = coordinate(stopped);
    const double part = admissible_part(*limited.limit, stopped.position, position(limited));
    if (part == 1) continue;
    double& leading = configuration_.released(stopped.leader->joint).displacement[stopped.leader->component];
    leading = stopped.leading_position + part * (leading - stopped.leading_position);
  }
}

bool StopContacts::hits_too_fast(double refinement) {
  for (const Stopped& stopped : stopped_) {
    const Coordinate& limited = coordinate(stopped);
    const double increment = configuration_.increment_of(limited);
    const CoordinateStep change = configuration_.coordinate_step(stopped.index, increment);
    if (!is_coarse(*limited.limit, change, refinement)) continue;
    configuration_.find_begin_rates();
    if (swings(*limited.limit, change, begin_rate(stopped), refinement)) return true;
  }
  return false;
}

void StopContacts::note_events(FirstEvent& first) {
  if (!stopped_.empty()) configuration_.find_begin_rates();
  for (const Stopped& stopped : stopped_) {
    const LimitStop& limit = *coordinate(stopped).limit;
    const double begin = begin_position(stopped), end = position(coordinate(stopped));
    const double start = configuration_.step() * begin_rate(stopped);
    if (begin >= limit.lower) first.note(crossing(begin, end, limit.lower, start));
    if (begin <= limit.upper) first.note(crossing(-begin, -end, -limit.upper, -start));
    if (begin < limit.lower || begin > limit.upper) note_leaving(stopped, begin > limit.upper, first);
  }
}

void StopContacts::note_leaving(const Stopped& stopped, bool is_above, FirstEvent& first) const {
  const Coordinate& limited = coordinate(stopped);
  const auto push = [&](double position, double rate) {
    return stop_reach(*limited.limit, is_above, position, rate).push;
  };
  const double before = push(begin_position(stopped), begin_rate(stopped));
  const double after = push(position(limited), configuration_.end_rate(limited));
  first.note_kink(crossing(before, after, 0, after - before));
}

bool StopContacts::may_hit() {
  configuration_.find_begin_rates();
  return std::any_of(stopped_.begin(), stopped_.end(), [&](const Stopped& stopped) {
    const CoordinateStep change = configuration_.coordinate_step(stopped.index, 0);
    return is_long_for_a_hit(*coordinate(stopped).limit, change, begin_rate(stopped));
  });
}

}  // namespace flexarm
