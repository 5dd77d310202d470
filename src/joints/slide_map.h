#pragma once
/// Kinematics of a section that slides along a flexible line, and the maps that fold its residual into the line's nodes
/// and the arc length.
///
/// The sliding section is a massless node, a slave of the nodes of the line. A joint of any kind may be mounted on it.
/// A step may cross borders of elements. (joints.md 4)

#include <vector>

#include "joints/slide_section.h"
#include "model/joint.h"

namespace flexarm {

/// The maps that fold a slider, like FoldMaps for other joints. The masters j are the nodes of the elements that take
/// part in the step (active nodes). Released row = released_left . g, rows of master j = left[j]^T g, slave columns =
/// released_right dX + right[j] {dr_j, spin_j}. Further members are the derivatives of the rows at constant g.
struct SlideMaps {
  explicit SlideMaps(std::size_t most_nodes = 0);

  int first = 0, count = 0;  ///< active nodes of the line
  Vector6 released_left, released_right;
  std::vector<Matrix6> left, right;  ///< per active node
  double released_released = 0;
  std::vector<Vector6> released_master, master_released;  ///< per active node; `released_master` as columns
  /// [i * count + j]: derivative of the moment of master i with respect to master j. The force of a master depends only
  /// on the arc length.
  std::vector<Eigen::Matrix<double, 3, 6>> moment_master;
};

/// Returns the largest number of nodes on which the sections of a step depend, over all lines. SlideMaps of this size
/// serve for any slider.
std::size_t most_active_nodes(const std::vector<SlideLine>& lines);

/// The travel of a slider over a step. Refers to the poses of all nodes of the model.
struct SlideTravel {
  const SlideLine& line;
  const std::vector<NodePose>&begin, &end;
  double from, to;  ///< arc lengths at the beginning and the end [m]
  SlideAlgorithm algorithm = {};
  /// Weight of the end of the step in the arms with which the scheme measures angular momentum: 1/2, or 0 for M2.
  double arm_weight = 0.5;
  /// slide_place() at both ends of the step, if the caller has them; null: they are computed when needed.
  const slide::Place *begin_place = nullptr, *end_place = nullptr;

  SlideStep step() const { return line.piece_at(from) == line.piece_at(to) ? algorithm.within : algorithm.across; }
};

/// Returns piece, weights and frame of the section at arc length X [m]. `nodes`: poses of the model's nodes.
slide::Place slide_place(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length);

/// Returns the pose of the section at arc length X [m]. `nodes`: poses of the model's nodes.
NodePose slide_pose(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length);

/// Returns the pose of the slave at the end of a step. This is the pose of the section, unless the contact holds in the
/// middle of the step. Then the position is 2 I^j r_{j,1/2} - `begin_position`, which is off the line (joints.md 4.4).
NodePose slide_pose(const SlideTravel& travel, const Vector3& begin_position);

/// Computes the variational maps N_delta at a configuration: rows {I^j f, I^j m} and r'.f + k.m (8.23, with the
/// curvature term k that the thesis omits, joints.md 4.2).
void slide_variational_maps(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length,
                            const Vector6& g, SlideMaps& maps, bool with_tangent = true);

/// Computes the incremental maps over a step (joints.md 4.4, 4.5). All forms are based on one identity: for any c, with
/// the weights I^j_c = (1-c) I^j_n + c I^j_{n+1},
///   Delta r_s = I^j_c Delta r_j + Delta X D^j (c r_{j,n} + (1-c) r_{j,n+1}),   D^j = Delta I^j / Delta X.
/// SM1-NT has c = 1/2, SM1-T c = 1, SM2-NT c = 0. SM-EM has c = arm_weight, and adds moments for the error of the
/// forces' arms, so that its momenta are exact, too. The rotation is split in the same way in all forms, and exactly.
/// Without `with_tangent` only the left maps are set.
void slide_incremental_maps(const SlideTravel& travel, const Vector6& g, SlideMaps& maps, bool with_tangent = true);

}  // namespace flexarm
