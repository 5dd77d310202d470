#pragma once
/// Finds force elements, such as contacts, that are too far from acting to be evaluated in the present step.

#include <vector>

#include "model/force_element.h"

namespace flexarm {

/// An element counts as far if the nodes have moved, since its last evaluation, by less than its distance from acting.
class FarElements {
 public:
  FarElements(std::size_t elements, std::size_t nodes) : rooms_(elements) { last_.reserve(nodes); }

  /// Starts a step. Poses may have been changed by others since the last step.
  void begin(const ForceStart& start);
  /// Sets the motion from the beginning of the step to its trial end.
  void end(const std::vector<NodePose>& begin, const std::vector<NodePose>& end) { in_step_ = travel(begin, end); }
  /// Sets how far nodes may move, from the beginning of this step, before the element can act.
  void set_room(std::size_t element, const ForceRoom& room) { rooms_[element] = {room, travelled_}; }
  /// Whether the element cannot act in this step, unless nodes move at more than twice their initial speeds.
  bool is_far(std::size_t element) const { return has_room(element, ahead_); }
  /// Whether the element has certainly not come into contact at the trial end.
  bool stays_far(std::size_t element) const { return has_room(element, in_step_); }

 private:
  /// Sums, over steps, of the largest displacement and the largest rotation of a node [m, rad].
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
  std::vector<NodePose> last_;  // poses at the beginning of the last step
  Travel travelled_, ahead_, in_step_;
};

}  // namespace flexarm
