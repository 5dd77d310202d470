#pragma once
/// Wrenches that services apply for a limited time, and pulls (springs that drag a link).

#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

/// Gives the simulation the wrenches of each step. All times are simulated times that resets do not set back [s].
class WrenchSchedule {
 public:
  explicit WrenchSchedule(Simulation& simulation) : simulation_(simulation) {}

  /// Adds a wrench. It acts in steps whose middle lies between `begin` and `end`.
  /// @throws std::invalid_argument as Simulation::apply_wrenches().
  void add(const AppliedWrench& wrench, double begin, double end);
  /// Replaces all pulls, from the next step on.
  /// @throws std::invalid_argument as Simulation::apply_wrenches(); nothing has changed then.
  void set_pulls(const std::vector<AppliedWrench>& pulls);
  /// To be called before each step, which begins at `time`.
  void update(double time);
  /// Removes all wrenches on links with this index or a higher one, and all pulls.
  void clear_from(std::size_t link);
  /// Removes all wrenches and pulls, including those that have not begun yet.
  void clear();

 private:
  struct Entry {
    AppliedWrench wrench;
    double begin, end;
    bool acts;
  };

  void apply();

  Simulation& simulation_;
  std::vector<Entry> entries_;
  std::vector<AppliedWrench> pulls_;
  std::vector<AppliedWrench> acting_;  ///< scratch memory, large enough for all entries and pulls
};

}  // namespace flexarm::node
