#pragma once
/// Reference for tests of SlideMaps: a slider's rows (joints.md 4.2 to 4.5) and their derivatives by complex steps.

#include "joints/slide_map.h"

namespace flexarm::test {

/// The released row and the rows of the active nodes, in the order {released, nodes}. Columns of the derivatives: the
/// arc length at the end, and {position, spin} of the active nodes.
struct SlideRows {
  Eigen::VectorXd rows;
  Eigen::MatrixXd derivatives;
};
SlideRows slide_rows(const SlideTravel& travel, const Vector6& g, bool incremental);

}  // namespace flexarm::test
