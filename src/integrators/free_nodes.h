#pragma once
/// Motion of many nodes at once, four side by side.

#include <array>
#include <vector>

#include "model/degrees_of_freedom.h"
#include "model/joint.h"

namespace flexarm {

/// The nodes that are no joint's slave: their poses follow from the unknowns alone, {displacement, rotation} of each.
class FreeNodes {
 public:
  explicit FreeNodes(const DegreesOfFreedom& dof);

  /// Moves poses by a Newton update, one entry per unknown: displacements [m] and spins [rad].
  void update(const Eigen::VectorXd& increment, std::vector<NodePose>& poses) const;
  /// `end`: poses at the beginning, moved by increments of a step: displacements and tangent-scaled rotations.
  void advance(const std::vector<NodePose>& begin, const Eigen::VectorXd& increment, std::vector<NodePose>& end) const;

 private:
  struct Four {
    int lanes = 0;  // in use; what fills the others is the last node in use
    std::array<int, 4> nodes, equations;
  };
  template <class Turn>
  void move(const std::vector<NodePose>& from, const Eigen::VectorXd& increment, const Turn& turn,
            std::vector<NodePose>& to) const;

  std::vector<Four> packs_;
};

/// Tangent-scaled rotations of all nodes over a step, cay(w) = end begin^-1.
void set_increments(const std::vector<NodePose>& begin, const std::vector<NodePose>& end,
                    std::vector<Vector3>& increments);

}  // namespace flexarm
