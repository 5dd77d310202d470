#pragma once
/// Steps in which the equations of motion change. (docs/notes/accuracy.md 6)

#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Tells by a simulation's state after each step whether forces may have jumped, or begun to change otherwise, within
/// it: at stops, dry friction, play and motors' limits, where something leaves its line, and in functions of time that
/// jump. Allocates nothing after its construction.
class Corners {
 public:
  explicit Corners(const Simulation& simulation);

  /// There may be any at all.
  bool may_come() const { return may_come_; }
  /// The simulation has been put elsewhere.
  void begin(const Simulation& simulation);
  /// After a step: whether there was one within it.
  bool passed(const Simulation& simulation);

 private:
  void look(const Simulation& simulation);
  bool jumped(const Simulation& simulation) const;

  bool may_come_ = false;
  std::vector<int> marks_, last_marks_;  // of each place in turn, on which side it is
  std::vector<double> ways_;             // coordinates and rotors after the last step [rad or m]
  double time_ = 0;                      // of the last step's end [s]
};

}  // namespace flexarm
