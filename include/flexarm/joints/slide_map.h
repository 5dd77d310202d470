#pragma once
/// Kinematics of a section that slides along a flexible line, and the maps that fold the residual of what it carries.
///
/// The sliding section is a massless node, the slave of all nodes of the line; a joint of any kind may sit on it. Both
/// maps are exact across the borders of elements, of which a step may cross any number. (joints.md 4)

#include <vector>

#include "flexarm/joints/slide_section.h"
#include "flexarm/model/joint.h"

namespace flexarm {

/// As FoldMaps, over the nodes of the active elements: released row = released_left . g, rows of master j = left[j]^T
/// g, slave columns = released_right dX + right[j] {dr_j, spin_j}; and what varies in the rows at constant g.
struct SlideMaps {
  explicit SlideMaps(std::size_t most_nodes = 0);

  int first = 0, count = 0;  ///< active nodes of the line
  Vector6 released_left, released_right;
  std::vector<Matrix6> left, right;  ///< per active node
  double released_released = 0;
  std::vector<Vector6> released_master, master_released;  ///< per active node, the former as columns
  std::vector<Matrix6> master_master;                     ///< [i * count + j]
};

/// Pose of the section at arc length X; `nodes`: of the model.
NodePose slide_pose(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length);

/// Maps N_delta at a configuration: rows {I^j f, I^j m} and r'.f + k.m (8.23, with the curvature term k that the thesis
/// omits, joints.md 4.2).
void slide_variational_maps(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length,
                            const Vector6& g, SlideMaps& maps, bool with_tangent = true);

/// Maps of the increments over a step, SM-EM (joints.md 4.5): the section's {Delta r, tangent-scaled rotation} is
/// exactly what the maps make of those of the nodes and of Delta X, so that the contact does no work; momenta are
/// exact.
/// `arm_weight` of the end of the step in moment arms: 1/2, or 0 for M2 (whose contact is SM2-NT of joints.md 4.4, here
/// for transitions, too).
void slide_incremental_maps(const SlideLine& line, const std::vector<NodePose>& begin, const std::vector<NodePose>& end,
                            double arc_length_begin, double arc_length_end, const Vector6& g, SlideMaps& maps,
                            bool with_tangent = true, double arm_weight = 0.5);

}  // namespace flexarm
