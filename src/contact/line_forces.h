#pragma once
/// Forces of a ball and a tube that touch on the nodes of both, with their tangent. (docs/notes/contact.md 1.3)

#include <algorithm>
#include <array>

#include "contact/line_point.h"
#include "model/force_element.h"

namespace flexarm {

/// A pair that touches, over a step.
struct LineActing {
  struct Node {
    int at = 0;                              // in the action
    double side = 0, line = 0, nearest = 0;  // weights of the station, of the line in means, and where it is nearest
    double slope = 0;                        // of the last, by xi
    Matrix3 by_spin;                         // of its tangent-scaled turn
  };
  std::array<Node, 3 * 5> nodes;
  int count = 0;
  int body = -1;                                             // of these, where the station is a body's
  Vector3 arm = Vector3::Zero(), end_arm = Vector3::Zero();  // of the station from there
  double weight = 0.5;                                       // of the end
  Vector3 middle;                                            // from the line to the station
  Vector3 nearest, tangent;                                  // at the end: from the nearest place, by xi there
  double rise = 0;                                           // of nearest . tangent by -xi; 0: the place stays
  LineAction local;

  /// Of a number in the action.
  Node& node(int at) {
    for (int i = 0; i < count; ++i)
      if (nodes[i].at == at) return nodes[i];
    nodes[count].at = at;
    return nodes[count++];
  }
  /// At the end.
  Vector3 normal() const { return nearest / std::max(nearest.norm(), 1e-300); }

  /// The wrench of `local`, and its tangent where that is asked for.
  void add_to(ForceAction& action) const;
  /// At an instant: the push along the normal, to where the line is nearest.
  void add_push_to(ForceAction& action) const;

 private:
  void add_tangent_to(ForceAction& action) const;
};

}  // namespace flexarm
