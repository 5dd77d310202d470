#pragma once
/// Wrenches that services apply, each for its time, and what pulls.

#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

/// Hands the simulation the wrenches of each step. Times are simulated ones that no reset sets back [s].
class WrenchSchedule {
 public:
  explicit WrenchSchedule(Simulation& simulation) : simulation_(simulation) {}

  /// It acts in the steps whose middle is from `begin` to `end`.
  /// @throws std::invalid_argument as Simulation::apply_wrenches().
  void add(const AppliedWrench& wrench, double begin, double end);
  /// These act from the next step on, in place of the pulls of before.
  /// @throws std::invalid_argument as Simulation::apply_wrenches(); all is as before then.
  void set_pulls(const std::vector<AppliedWrench>& pulls);
  /// Before each step, from `time` on.
  void update(double time);
  /// Takes those away that act on links from this one on, and pulls.
  void clear_from(std::size_t link);
  /// Takes all away, those that are yet to come, too.
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
  std::vector<AppliedWrench> acting_;  ///< scratch with room for all entries and pulls
};

}  // namespace flexarm::node
