#include "timed_commands.h"

#include <algorithm>

namespace flexarm::node {

TimedCommands::TimedCommands(Simulation& simulation) : simulation_(simulation) {
  forget();
}

void TimedCommands::give(Commanded quantity, std::size_t coordinate, double value) {
  if (quantity == Commanded::Effort)
    simulation_.command_effort(coordinate, value);
  else
    simulation_.command_set_point(coordinate, value);
}

void TimedCommands::apply(const Command& command) {
  if (command.quantity == Commanded::Nothing) return;
  give(command.quantity, command.coordinate, command.value);
  const double expiry = time_ + command.lifetime;
  expiry_[static_cast<std::size_t>(command.quantity)][command.coordinate] = expiry;
  next_expiry_ = std::min(next_expiry_, expiry);
}

void TimedCommands::expire(double time) {
  time_ = time;
  if (time_ < next_expiry_) return;
  next_expiry_ = Command::kForEver;
  for (const Commanded quantity : {Commanded::Effort, Commanded::SetPoint}) {
    std::vector<double>& expiry = expiry_[static_cast<std::size_t>(quantity)];
    for (std::size_t coordinate = 0; coordinate < expiry.size(); ++coordinate) {
      if (time_ >= expiry[coordinate]) {
        give(quantity, coordinate, 0);
        expiry[coordinate] = Command::kForEver;
      }
      next_expiry_ = std::min(next_expiry_, expiry[coordinate]);
    }
  }
}

void TimedCommands::forget() {
  for (std::vector<double>& expiry : expiry_) expiry.assign(simulation_.coordinate_names().size(), Command::kForEver);
  next_expiry_ = Command::kForEver;
}

void TimedCommands::renumber(const Renumbering& places) {
  const std::array<std::vector<double>, 2> before = expiry_;
  forget();
  for (std::size_t quantity = 0; quantity < before.size(); ++quantity)
    for (std::size_t i = 0; i < before[quantity].size(); ++i) {
      if (!places.coordinates[i]) continue;
      expiry_[quantity][*places.coordinates[i]] = before[quantity][i];
      next_expiry_ = std::min(next_expiry_, before[quantity][i]);
    }
}

void TimedCommands::forget_set_point(std::size_t coordinate) {
  expiry_[static_cast<std::size_t>(Commanded::SetPoint)][coordinate] = Command::kForEver;
}

}  // namespace flexarm::node
