#include "timed_commands.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm::node {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

TimedCommands::TimedCommands(const Simulation& simulation, CommandedQuantity quantity, double timeout)
    : simulation_(simulation),
      quantity_(std::move(quantity)),
      timeout_(timeout),
      expiry_(simulation.coordinate_names().size(), kNever),
      next_expiry_(kNever) {
  commanded_.reserve(expiry_.size());
}

std::string TimedCommands::command(const std::vector<std::string>& names, const std::vector<double>& values,
                                   double duration) {
  const std::string fault = find_fault(names, values, duration);
  if (!fault.empty()) return fault;
  const double lifetime = duration > 0 ? duration : timeout_ > 0 ? timeout_ : kNever;
  for (std::size_t i = 0; i < commanded_.size(); ++i) {
    quantity_.apply(commanded_[i], values[i]);
    expiry_[commanded_[i]] = quantity_.expires(commanded_[i]) ? time_ + lifetime : kNever;
  }
  next_expiry_ = *std::min_element(expiry_.begin(), expiry_.end());
  return {};
}

void TimedCommands::expire(double time) {
  time_ = time;
  if (time_ < next_expiry_) return;
  for (std::size_t coordinate = 0; coordinate < expiry_.size(); ++coordinate) {
    if (time_ < expiry_[coordinate]) continue;
    quantity_.apply(coordinate, 0);
    expiry_[coordinate] = kNever;
  }
  next_expiry_ = *std::min_element(expiry_.begin(), expiry_.end());
}

void TimedCommands::forget() {
  std::fill(expiry_.begin(), expiry_.end(), kNever);
  next_expiry_ = kNever;
}

void TimedCommands::forget(std::size_t coordinate) {
  expiry_[coordinate] = kNever;
  next_expiry_ = *std::min_element(expiry_.begin(), expiry_.end());
}

std::string TimedCommands::find_fault(const std::vector<std::string>& names, const std::vector<double>& values,
                                      double duration) {
  if (names.empty()) return "it names no joint";
  if (names.size() != values.size()) {
    return "it has " + std::to_string(names.size()) + " names, but " + std::to_string(values.size()) + " " +
           quantity_.name + "s";
  }
  if (duration < 0) return "its duration is negative";
  commanded_.clear();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<std::size_t> coordinate = simulation_.find_coordinate(names[i]);
    if (!coordinate) return "there is no joint coordinate '" + names[i] + "'";
    if (!std::isfinite(values[i])) return "the " + quantity_.name + " of '" + names[i] + "' is not finite";
    const std::string fault = quantity_.find_fault(*coordinate);
    if (!fault.empty()) return fault;
    if (std::find(commanded_.begin(), commanded_.end(), *coordinate) != commanded_.end()) {
      return "'" + names[i] + "' is named twice";
    }
    commanded_.push_back(*coordinate);
  }
  return {};
}

}  // namespace flexarm::node
