#pragma once
/// Contacts with stops between Newton's iterations and after them.

#include <vector>

#include "integrators/step_configuration.h"
#include "integrators/step_events.h"

namespace flexarm {

/// Stops push without bound where they give way no further, which no update may pass: a coordinate whose stop feels it,
/// itself or one that it leads, goes part of the way.
class StopContacts {
 public:
  explicit StopContacts(StepConfiguration& configuration);

  void before_update();
  void after_update();
  /// True where the restitution of a hit would be lost in so long a step; or, with a refinement above 1, in steps that
  /// much longer.
  bool hits_too_fast(double refinement);
  /// Notes when coordinates touch their stops, and when these push no more or begin to.
  void note_events(FirstEvent& first);
  /// True where the step is long for a hit that it is in or may come to, whatever its trial end.
  bool may_hit();

 private:
  struct Stopped {
    std::size_t index;         // of the coordinate
    const Coordinate* leader;  // whose unknown it follows; else itself
    StopPenalty penalty;
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
