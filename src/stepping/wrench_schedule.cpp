#include "wrench_schedule.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

namespace flexarm::node {

void WrenchSchedule::add(const AppliedWrench& wrench, double begin, double end) {
  // Checks the wrench now; otherwise an error would appear only when it begins to act.
  simulation_.apply_wrenches({wrench});
  entries_.push_back({wrench, begin, end, false});
  acting_.reserve(pulls_.size() + entries_.size());
  apply();
}

void WrenchSchedule::set_pulls(const std::vector<AppliedWrench>& pulls) {
  simulation_.apply_wrenches(pulls);
  pulls_ = pulls;
  acting_.reserve(pulls_.size() + entries_.size());
  apply();
}

void WrenchSchedule::update(double time) {
  const double middle = time + simulation_.step_size() / 2;
  const auto is_over = [&](const Entry& entry) { return entry.end <= middle; };
  const auto over = std::remove_if(entries_.begin(), entries_.end(), is_over);
  bool changed = over != entries_.end();
  entries_.erase(over, entries_.end());
  for (Entry& entry : entries_) {
    const bool acts = entry.begin <= middle;
    changed |= std::exchange(entry.acts, acts) != acts;
  }
  if (changed) apply();
}

void WrenchSchedule::renumber(const Renumbering& places) {
  for (Entry& entry : std::exchange(entries_, {})) {
    const std::optional<std::size_t> link = places.links[entry.wrench.link];
    if (!link) continue;
    entry.wrench.link = *link;
    if (accepts(entry.wrench)) entries_.push_back(entry);
  }
  pulls_.clear();
  apply();
}

void WrenchSchedule::clear() {
  entries_.clear();
  pulls_.clear();
  apply();
}

bool WrenchSchedule::accepts(const AppliedWrench& wrench) {
  try {
    simulation_.apply_wrenches({wrench});
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

void WrenchSchedule::apply() {
  acting_.assign(pulls_.begin(), pulls_.end());
  for (const Entry& entry : entries_)
    if (entry.acts) acting_.push_back(entry.wrench);
  simulation_.apply_wrenches(acting_);
}

}  // namespace flexarm::node
