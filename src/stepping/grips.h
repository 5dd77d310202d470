#pragma once
/// Joints that grip: their servos go to a position with a limited effort.

#include <cstddef>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

/// Gives set points to servos of mode position. One whose effort is limited is asked for no more than its gain kp makes
/// that effort of: where the joint is held up, the servo gives just the limit. What kd adds is against the motion.
class Grips {
 public:
  /// Of what joints are to do from the next step on. @param max_effort  [N m or N]; 0: what the servo gives
  void close(std::size_t joint, double position, double max_effort);
  /// Leaves a joint to others.
  void release(std::size_t joint);
  void release_all() { grips_.clear(); }
  /// Leaves joints from this one on.
  void release_from(std::size_t joint);
  bool holds(std::size_t joint) const;
  /// The set points of the next step.
  void command(Simulation& simulation);

  /// Why the effort of the coordinate's servo cannot be limited, or nothing.
  static std::string refusal_of_limit(const Simulation& simulation, std::size_t joint);

 private:
  struct Grip {
    std::size_t joint;
    double position, max_effort;
  };
  std::vector<Grip> grips_;
};

}  // namespace flexarm::node
