#include "solver/tree_blocks.h"

#include <algorithm>
#include <cassert>

namespace flexarm {

TreeBlocks::TreeBlocks(const Model& model, const DegreesOfFreedom& dof)
    : diagonals(36 * dof.size.size()),
      maps(model.joints.size()),
      slide_maps(model.joints.size()),
      mimics(dof.mimics.size()) {
  held.reserve(model.coordinates.size());
  std::size_t blocks = 0;
  for_each_element(model.beams, [&](const auto& element) {
    const std::size_t count = element.nodes.size() * element.nodes.size();
    blocks = std::max(blocks, static_cast<std::size_t>(element.first_block) + count);
  });
  elements.resize(36 * blocks);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    if (model.joints[j].kind == JointMapKind::Slide)
      slide_maps[j] = SlideMaps(model.slide_lines[model.joints[j].line].most_active_nodes());
  for (std::size_t k = 0; k < model.closures.size(); ++k) {
    const int size = 12 + dof.size[dof.variable_of_closure(static_cast<int>(k))];
    closures.push_back(Eigen::MatrixXd::Zero(size, size));
  }
  for (const auto& element : model.force_elements) {
    const ForcePieces& composed = element->pieces();
    const Eigen::Index dense = composed.pairs.empty() ? 6 * element->most_nodes() : 0;
    couplings.push_back(Eigen::MatrixXd::Zero(dense, dense));
    pieces.emplace_back(composed);
  }
}

void hold_row(FoldMaps& maps, double* own, bool has_master, int component, int first,
              const ReleasedVector& coefficients) {
  assert(component >= 0 && component < maps.left.cols() && first >= 0);
  assert(first + coefficients.size() <= maps.left.cols());
  const int size = static_cast<int>(maps.left.cols());
  maps.left.col(component).setZero();
  if (has_master) maps.released_spin.row(component).setZero();
  Eigen::Map<ReleasedSquare>(own, size, size).row(component).setZero();
  maps.released_released.row(component).setZero();
  maps.released_released.row(component).segment(first, coefficients.size()) = coefficients.transpose();
}

}  // namespace flexarm
