#pragma once
/// Draws the paths of the probes.

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <deque>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::messages {

/// Lines behind the probes of a scene, which fade out with time.
class Trails {
 public:
  /// @param duration  length of a trail in simulated time [s]
  Trails(const Simulation& simulation, double duration) : simulation_(simulation), duration_(duration) {}

  /// Notes the places of the probes, if time has changed. If time has gone back, trails start empty.
  void update();
  void forget() { instants_.clear(); }
  /// One line for each probe. @param width  [m]
  void add_to(const std_msgs::Header& header, double width, visualization_msgs::MarkerArray& message) const;

 private:
  struct Instant {
    double time = 0;              ///< [s]
    std::vector<Vector3> places;  ///< of all probes, in the world [m]
  };

  const Simulation& simulation_;
  double duration_;
  std::deque<Instant> instants_;
};

}  // namespace flexarm::messages
