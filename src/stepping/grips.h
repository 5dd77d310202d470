#pragma once
/// Joints that grip: their servos move to a position with a limited effort, as in a gripper action.

#include <cstddef>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "renumbering.h"

namespace flexarm::node {

/// Gives set points to servos in mode position. If the effort is limited, the set point is kept so close to the present
/// position that kp times the difference stays within the limit. A blocked joint then pushes with exactly the limit.
/// The part of kd only resists the motion.
class Grips {
 public:
  /// Lets a joint grip from the next step on. @param max_effort  [N m or N]; 0: not limited
  void close(std::size_t joint, double position, double max_effort);
  /// Stops commanding a joint.
  void release(std::size_t joint);
  void release_all() { grips_.clear(); }
  /// To be called when links have come or gone. Joints that are gone are no longer commanded.
  void renumber(const Renumbering::Places& joints);
  bool holds(std::size_t joint) const;
  /// Gives the set points for the next step.
  void command(Simulation& simulation);

  /// Why the effort of the coordinate's servo cannot be limited, or an empty string.
  static std::string refusal_of_limit(const Simulation& simulation, std::size_t joint);

 private:
  struct Grip {
    std::size_t joint;
    double position, max_effort;
  };
  std::vector<Grip> grips_;
};

}  // namespace flexarm::node
