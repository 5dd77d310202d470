#pragma once
/// Kinematics of a section that slides along a flexible line, and the maps that fold the residual of what it carries.
///
/// The sliding section is a massless node, the slave of all nodes of the line; a joint of any kind may sit on it. Both
/// maps go across the borders of elements, of which a step may cross any number. (joints.md 4)

#include <vector>

#include "joints/slide_section.h"
#include "model/joint.h"

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
  /// Of the moment of master i with respect to master j, [i * count + j]; its force varies with the arc length alone.
  std::vector<Eigen::Matrix<double, 3, 6>> moment_master;
};

/// Most nodes of any of the lines on which the sections of a step depend; for SlideMaps of any slider.
std::size_t most_active_nodes(const std::vector<SlideLine>& lines);

/// What a step makes of a slider; refers to poses of all nodes of the model.
struct SlideTravel {
  const SlideLine& line;
  const std::vector<NodePose>&begin, &end;
  double from, to;  ///< arc lengths at both [m]
  SlideAlgorithm algorithm = {};
  /// Of the end of the step in the moment arms by which angular momentum is measured: 1/2, or 0 for M2.
  double arm_weight = 0.5;
  /// slide_place() of both ends of the step, if the caller has them; null: they are computed.
  const slide::Place *begin_place = nullptr, *end_place = nullptr;

  SlideStep step() const { return line.piece_at(from) == line.piece_at(to) ? algorithm.within : algorithm.across; }
};

/// Piece, weights and frame of the section at arc length X [m]; `nodes`: of the model.
slide::Place slide_place(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length);

/// Pose of the section at arc length X; `nodes`: of the model.
NodePose slide_pose(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length);

/// Pose of the slave at the end of a step: that of the section, but where the contact is in the middle of the step the
/// position is 2 I^j r_{j,1/2} - `begin_position` (joints.md 4.4), off the line.
NodePose slide_pose(const SlideTravel& travel, const Vector3& begin_position);

/// Maps N_delta at a configuration: rows {I^j f, I^j m} and r'.f + k.m (8.23, with the curvature term k that the thesis
/// omits, joints.md 4.2).
void slide_variational_maps(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length,
                            const Vector6& g, SlideMaps& maps, bool with_tangent = true);

/// Maps of the increments over a step (joints.md 4.4, 4.5). All forms rest on one identity: for any c, with the weights
/// I^j_c = (1-c) I^j_n + c I^j_{n+1},
///   Delta r_s = I^j_c Delta r_j + Delta X D^j (c r_{j,n} + (1-c) r_{j,n+1}),   D^j = Delta I^j / Delta X.
/// c = 1/2 is SM1-NT, 1 SM1-T, 0 SM2-NT; SM-EM takes c = arm_weight and moves what the forces' arm then lacks into the
/// moments, so that its momenta are exact, too. Rotations are split alike, and exactly, in all of them.
/// Without `with_tangent` only the left maps are set.
void slide_incremental_maps(const SlideTravel& travel, const Vector6& g, SlideMaps& maps, bool with_tangent = true);

}  // namespace flexarm
