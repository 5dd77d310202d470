#pragma once
/// Distributes the contact forces of a ball and a tube to the nodes of both, with their tangent. (docs/notes/contact.md
/// 1.3)

#include <algorithm>
#include <array>

#include "contact/line_point.h"
#include "model/force_element.h"

namespace flexarm {

/// A touching pair of a station (ball) and a line (tube) over a step.
struct LineActing {
  struct Node {
    int at = 0;  // index of the node in the ForceAction
    // Weights: of the station; of the line's place in means; of the nearest place at the end.
    double side = 0, line = 0, nearest = 0;
    double slope = 0;  // d(nearest)/d(xi)
    Matrix3 by_spin;   // derivative of its tangent-scaled rotation with respect to its spin
  };
  std::array<Node, 3 * 5> nodes;
  int count = 0;
  int body = -1;                                             // index in `nodes` of a body's node; -1: a beam
  Vector3 arm = Vector3::Zero(), end_arm = Vector3::Zero();  // from the body's node to the station
  double weight = 0.5;                                       // weight of the end of the step in means
  Vector3 middle;                                            // from the line to the station
  Vector3 nearest, tangent;  // at the end: from the nearest place to the station; d(place)/d(xi)
  double rise = 0;           // -d(nearest . tangent)/d(xi); 0: the nearest place does not move
  LineAction local;

  /// Returns the entry of the node with this index in the ForceAction; adds it if it is not there.
  Node& node(int at) {
    for (int i = 0; i < count; ++i)
      if (nodes[i].at == at) return nodes[i];
    nodes[count].at = at;
    return nodes[count++];
  }
  /// The unit normal at the end, from the line to the station.
  Vector3 normal() const { return nearest / std::max(nearest.norm(), 1e-300); }

  /// Adds the wrench of `local`, and its tangent if the action has one.
  void add_to(ForceAction& action) const;
  /// For forces at an instant: adds the normal force, which acts on the line at its nearest place.
  void add_push_to(ForceAction& action) const;

 private:
  void add_tangent_to(ForceAction& action) const;
};

}  // namespace flexarm
