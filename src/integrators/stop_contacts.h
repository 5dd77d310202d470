#pragma once
/// Limits Newton updates at joint stops, and finds hits on stops in a solved step.

#include <vector>

#include "integrators/step_configuration.h"
#include "integrators/step_events.h"

namespace flexarm {

/// The force of a stop grows without bound towards a maximal penetration, which no update may pass. So an update of a
/// coordinate is shortened if its own stop, or that of a coordinate that follows it, would pass this limit.
class StopContacts {
 public:
  explicit StopContacts(StepConfiguration& configuration);

  void before_update();
  void after_update();
  /// Whether the step is so long that the restitution of a hit would be lost. With a refinement above 1: whether it
  /// would be lost in a step that is longer by this factor.
  bool hits_too_fast(double refinement);
  /// Notes when coordinates touch their stops, and when stops begin or cease to push.
  void note_events(FirstEvent& first);
  /// Whether the step is long for a hit that is going on or may begin. Does not depend on the trial end.
  bool may_hit();

 private:
  struct Stopped {
    std::size_t index;                  // of the coordinate
    const Coordinate* leader;           // the coordinate that this one follows, or itself
    double position, leading_position;  // before the update
  };
  const Coordinate& coordinate(const Stopped& stopped) const;
  double position(const Coordinate& coordinate) const;
  double begin_position(const Stopped& stopped) const;
  double begin_rate(const Stopped& stopped) const;
  void note_leaving(const Stopped& stopped, bool is_above, FirstEvent& first) const;

  StepConfiguration& configuration_;
  std::vector<Stopped> stopped_;
};

}  // namespace flexarm
