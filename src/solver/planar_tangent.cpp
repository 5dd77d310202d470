#include "solver/planar_tangent.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <string>

#include "solver/tree_blocks.h"

namespace flexarm {
namespace {

[[noreturn]] void refuse(const char* what) {
  throw std::logic_error(std::string("elimination in a plane has no place for ") + what);
}

}  // namespace

bool PlanarTangent::suits(const Model& model, const DegreesOfFreedom& dof) {
  if (!model.closures.empty() || !model.force_elements.empty() || !model.slide_lines.empty() || !dof.mimics.empty())
    return false;
  const TreeOrder order(model, dof);
  const std::vector<TreePart>& parts = order.parts();
  return order.is_complete() &&
         std::none_of(parts.begin(), parts.end(), [](const TreePart& part) { return part.has_border; });
}

PlanarTangent::PlanarTangent(const Model& model, const DegreesOfFreedom& dof, const PlaneOfMotion& plane)
    : dof_(dof),
      plane_(plane),
      order_(model, dof),
      fronts_(order_),
      maps_(model.joints.size()),
      nodes_(kPlanarBlock * model.nodes.size()),
      values_(4 * model.nodes.size()),
      scalars_(dof.scalar_count),
      expanded_(dof.scalar_count) {
  std::size_t blocks = 0, squares = 0;
  for (const TreePart& part : order_.parts())
    if (part.joint < 0) blocks = std::max(blocks, part.first_block + part.node_count * part.node_count);
  elements_.resize(kPlanarBlock * blocks);
  for (std::size_t b = 0; b < blocks; ++b) element_blocks_.push_back(&elements_[kPlanarBlock * b]);
  for (const JointMap& joint : model.joints) {
    const int variable = dof.variable_of_joint(static_cast<int>(joints_.size()));
    joints_.emplace_back(joint, variable, dof, plane);
    squares += dof.size[variable] * dof.size[variable];
  }
  coordinates_.resize(squares);
  for (int i = 0; i < dof.node_count; ++i) diagonal_blocks_.push_back(&nodes_[kPlanarBlock * i]);
  squares = 0;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const int size = dof.size[dof.variable_of_joint(static_cast<int>(j))];
    diagonal_blocks_.push_back(coordinates_.data() + squares);
    squares += size * size;
  }
  keeps_elements_apart_ = true;
}

void PlanarTangent::set_zero() {
  std::fill(nodes_.begin(), nodes_.end(), 0.0);
  std::fill(coordinates_.begin(), coordinates_.end(), 0.0);
}

void PlanarTangent::add_to_node(int node, const Matrix6& block) {
  PlanarBlock to(diagonal_blocks_[node]);
  for (int c = 0; c < 3; ++c) to.col(c) += plane_.projected(block * plane_.expanded(Vector3(Vector3::Unit(c))));
}

void PlanarTangent::hold_row(int joint, int component, int first, const ReleasedVector& coefficients) {
  const PlanarJointFront& front = joints_[joint];
  flexarm::hold_row(maps_[joint], diagonal_block(front.variable()), front.has_master(), component, first, coefficients);
}

void PlanarTangent::add_closure(int, int, double, const ClosureMaps&) {
  refuse("loops");
}
void PlanarTangent::couple(int, const int*, int) {
  refuse("couplings");
}

void PlanarTangent::add_coupling(int, const Eigen::Ref<const Eigen::MatrixXd>&) {
  refuse("springs between points");
}
void PlanarTangent::add_coupling(int, const PieceTangent&) {
  refuse("lines over points");
}
SlideMaps& PlanarTangent::slide_maps(int) {
  refuse("sliders");
}
void PlanarTangent::fold_mimics(const std::vector<MimicMap>& maps) {
  if (!maps.empty()) refuse("coordinates that follow others");
}

// ---------------------------------------------------------------- factors

bool PlanarTangent::eliminate(bool with_right_hand_side) {
  const std::vector<TreePart>& parts = order_.parts();
  for (int p = 0; p < static_cast<int>(parts.size()); ++p) {
    const int joint = parts[p].joint;
    const bool done = joint >= 0 ? joints_[joint].eliminate(maps_[joint], diagonal_blocks_.data())
                                 : fronts_.eliminate(p, elements_.data(), nodes_.data(),
                                                     with_right_hand_side ? values_.data() : nullptr);
    if (!done) {
      singular_variable_ = joint >= 0 ? dof_.variable_of_joint(joint) : parts[p].nodes[parts[p].node_count - 1];
      return false;
    }
    if (with_right_hand_side && joint >= 0) forward(p);
  }
  return true;
}

bool PlanarTangent::factorise_and_solve(Eigen::VectorXd& b) {
  set_right_hand_side(b);
  return eliminate(true) && substitute_back(b);
}

// ---------------------------------------------------------------- solution

void PlanarTangent::set_right_hand_side(const Eigen::VectorXd& b) {
  assert(b.size() == dof_.unknowns);
  for (int i = 0; i < dof_.node_count; ++i) {
    const int equation = dof_.equation[dof_.first[i]];
    if (equation >= 0)
      node(i) = plane_.projected(b.segment<6>(equation));
    else
      node(i).setZero();
  }
  for (int scalar = 6 * dof_.node_count; scalar < dof_.scalar_count; ++scalar)
    scalars_[scalar] = dof_.equation[scalar] >= 0 ? b[dof_.equation[scalar]] : 0.0;
}

void PlanarTangent::forward(int p) {
  const int joint = order_.parts()[p].joint;
  joint >= 0 ? joints_[joint].forward(maps_[joint], values_.data(), scalars_.data())
             : fronts_.forward(p, elements_.data(), values_.data());
}

bool PlanarTangent::substitute_back(Eigen::VectorXd& b) {
  const std::vector<TreePart>& parts = order_.parts();
  for (int p = static_cast<int>(parts.size()) - 1; p >= 0; --p) {
    const int joint = parts[p].joint;
    joint >= 0 ? joints_[joint].backward(maps_[joint], values_.data(), scalars_.data())
               : fronts_.backward(p, elements_.data(), values_.data());
  }
  for (int i = 0; i < dof_.node_count; ++i)
    if (const int equation = dof_.equation[dof_.first[i]]; equation >= 0)
      b.segment<6>(equation) = plane_.expanded(node(i));
  for (int scalar = 6 * dof_.node_count; scalar < dof_.scalar_count; ++scalar)
    if (dof_.equation[scalar] >= 0) b[dof_.equation[scalar]] = scalars_[scalar];
  return b.allFinite();
}

bool PlanarTangent::solve(Eigen::VectorXd& b) {
  set_right_hand_side(b);
  for (int p = 0; p < static_cast<int>(order_.parts().size()); ++p) forward(p);
  return substitute_back(b);
}

const double* PlanarTangent::expanded_solution() {
  for (int i = 0; i < dof_.node_count; ++i)
    Eigen::Map<Vector6>(expanded_.data() + 6 * i) = plane_.expanded(Eigen::Map<Vector3>(values_.data() + 4 * i));
  std::copy(scalars_.begin() + 6 * dof_.node_count, scalars_.end(), expanded_.begin() + 6 * dof_.node_count);
  return expanded_.data();
}

}  // namespace flexarm
