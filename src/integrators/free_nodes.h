#pragma once
/// Moves many nodes at once, four side by side in the lanes of a pack.

#include <array>
#include <vector>

#include "model/degrees_of_freedom.h"
#include "model/joint.h"

namespace flexarm {

/// The nodes that are not slaves of joints. Their poses follow directly from their unknowns {displacement, rotation}.
class FreeNodes {
 public:
  explicit FreeNodes(const DegreesOfFreedom& dof);

  /// Moves `poses` by a Newton update with one entry per unknown: displacements [m] and spins [rad].
  void update(const Eigen::VectorXd& increment, std::vector<NodePose>& poses) const;
  /// Sets `end` to the poses `begin` moved by increments of a step: displacements and tangent-scaled rotations.
  void advance(const std::vector<NodePose>& begin, const Eigen::VectorXd& increment, std::vector<NodePose>& end) const;

 private:
  struct Four {
    int lanes = 0;  // number of lanes in use; unused lanes repeat the last node
    std::array<int, 4> nodes, equations;
  };
  template <class Turn>
  void move(const std::vector<NodePose>& from, const Eigen::VectorXd& increment, const Turn& turn,
            std::vector<NodePose>& to) const;

  std::vector<Four> packs_;
};

/// Sets the tangent-scaled rotations w of all nodes over a step: cay(w) = end begin^-1.
void set_increments(const std::vector<NodePose>& begin, const std::vector<NodePose>& end,
                    std::vector<Vector3>& increments);

}  // namespace flexarm
