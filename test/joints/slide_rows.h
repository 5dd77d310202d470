#pragma once
/// A slider's rows (joints.md 4.2 to 4.5) and their derivatives by complex steps: the oracle of SlideMaps.

#include "joints/slide_map.h"

namespace flexarm::test {

/// Rows of the active nodes and the released one, in the order {released, nodes}, and their derivatives with respect to
/// the arc length at the end and {position, spin} of the active nodes, in columns.
struct SlideRows {
  Eigen::VectorXd rows;
  Eigen::MatrixXd derivatives;
};
SlideRows slide_rows(const SlideTravel& travel, const Vector6& g, bool incremental);

}  // namespace flexarm::test
