#pragma once
/// Makes what a live page shows. docs/notes/page.md says what the messages are.

#include <string>
#include <vector>

#include "pictures/recording.h"

namespace flexarm::pictures {

struct LiveMessages {
  std::string picture;  ///< JSON; empty: as before
  std::string instant;  ///< numbers
};

/// Makes the messages for a simulation while it runs.
class LiveStream {
 public:
  /// Makes the picture of the simulation in its present state.
  LiveStream(const Simulation& simulation, const std::string& title);
  LiveStream(const LiveStream&) = delete;  // its parts refer to each other
  LiveStream& operator=(const LiveStream&) = delete;

  /// The message with the picture.
  std::string picture() const;
  /// The messages of the present state. There is another picture if more arrows act than it has places for.
  /// @param simulation  has the scene for which this object was made
  LiveMessages next(const Simulation& simulation);

 private:
  /// Makes places for all arrows. @returns whether there were too few
  bool make_places();

  Picture picture_;
  Instant instant_;
  std::array<std::size_t, kArrowKinds> places_;  ///< for arrows
  std::vector<std::size_t> quaternions_;         ///< within the numbers of an instant
  Arrows arrows_;                                ///< of the present state
  std::vector<double> values_, last_;            ///< of all tracks; the last ones
};

}  // namespace flexarm::pictures
