#pragma once
/// Force elements that are too far from acting to be evaluated in every step.

#include <vector>

#include "model/force_element.h"

namespace flexarm {

/// Elements are far by their distance when they were evaluated last, less how far nodes have moved since then.
class FarElements {
 public:
  FarElements(std::size_t elements, std::size_t nodes) : rooms_(elements) { last_.reserve(nodes); }

  /// Of a step that begins so. Poses may have been set since the last one.
  void begin(const ForceStart& start);
  /// What the trial end of the step is from its beginning.
  void end(const std::vector<NodePose>& begin, const std::vector<NodePose>& end) { in_step_ = travel(begin, end); }
  /// From the beginning of the step on.
  void set_room(std::size_t element, const ForceRoom& room) { rooms_[element] = {room, travelled_}; }
  /// It acts on nothing in the step.
  bool is_far(std::size_t element) const { return has_room(element, ahead_); }
  /// Nor has it come to touch in it.
  bool stays_far(std::size_t element) const { return has_room(element, in_step_); }

 private:
  /// Sums of steps' largest ways and turns of all nodes [m, rad].
  struct Travel {
    double way = 0, turn = 0;
  };
  struct Room {
    ForceRoom room;
    Travel since;
  };
  static Travel travel(const std::vector<NodePose>& from, const std::vector<NodePose>& to);
  bool has_room(std::size_t element, const Travel& more) const {
    const auto& [room, since] = rooms_[element];
    return room.by_way * (travelled_.way - since.way + more.way) +
               room.by_turn * (travelled_.turn - since.turn + more.turn) <
           room.size;
  }

  std::vector<Room> rooms_;
  std::vector<NodePose> last_;  // at the beginning of the last step
  Travel travelled_, ahead_, in_step_;
};

}  // namespace flexarm
