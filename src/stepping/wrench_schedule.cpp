#include "wrench_schedule.h"

#include <algorithm>
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

void WrenchSchedule::clear_from(std::size_t link) {
  const auto went = [link](const Entry& entry) { return entry.wrench.link >= link; };
  entries_.erase(std::remove_if(entries_.begin(), entries_.end(), went), entries_.end());
  pulls_.clear();
  apply();
}

void WrenchSchedule::clear() {
  entries_.clear();
  pulls_.clear();
  apply();
}

void WrenchSchedule::apply() {
  acting_.assign(pulls_.begin(), pulls_.end());
  for (const Entry& entry : entries_)
    if (entry.acts) acting_.push_back(entry.wrench);
  simulation_.apply_wrenches(acting_);
}

}  // namespace flexarm::node
