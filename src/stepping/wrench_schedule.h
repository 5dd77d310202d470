#pragma once
/// Wrenches that services apply for a limited time, and pulls (springs that drag a link).

#include <vector>

#include "flexarm/simulation/simulation.h"
#include "renumbering.h"

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
  /// To be called when links of the simulation have come or gone. All pulls end, and so do wrenches on links that are
  /// gone or are now fixed to the world.
  void renumber(const Renumbering& places);
  /// Removes all wrenches and pulls, including those that have not begun yet.
  void clear();

 private:
  struct Entry {
    AppliedWrench wrench;
    double begin, end;
    bool acts;
  };

  /// Whether the simulation can apply it. Afterwards apply() must be called.
  bool accepts(const AppliedWrench& wrench);
  void apply();

  Simulation& simulation_;
  std::vector<Entry> entries_;
  std::vector<AppliedWrench> pulls_;
  std::vector<AppliedWrench> acting_;  ///< scratch memory, large enough for all entries and pulls
};

}  // namespace flexarm::node
