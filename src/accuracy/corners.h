#pragma once
/// Finds the steps in which the equations of motion change. (docs/notes/accuracy.md 6)

#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Looks at a simulation's state after each step, and decides whether forces may have jumped within the step, or begun
/// to change in another way. That happens at stops, where bodies touch, in dry friction, play and limits of motors,
/// when a slider leaves its line, and in functions of time that jump. Allocates nothing after its construction.
class Corners {
 public:
  explicit Corners(const Simulation& simulation);

  /// Whether there may be any corners at all.
  bool may_come() const { return may_come_; }
  /// Call it after the simulation's state was changed from outside.
  void begin(const Simulation& simulation);
  /// Call it after each step. Returns whether there was a corner within the step.
  bool passed(const Simulation& simulation);

 private:
  void look(const Simulation& simulation);
  bool jumped(const Simulation& simulation) const;

  bool may_come_ = false;
  std::vector<int> marks_, last_marks_;  // for each place of a corner, on which side of it the simulation is
  std::vector<double> ways_;             // positions of coordinates and rotors after the last step [rad or m]
  double time_ = 0;                      // of the last step's end [s]
};

}  // namespace flexarm
