#include "solver/reduced_residual.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace flexarm {

ReducedResidual::ReducedResidual(const Model& model, const DegreesOfFreedom& dof)
    : model_(model), dof_(dof), values_(dof.scalar_count, 0.0) {}

void ReducedResidual::set_zero() {
  std::fill(values_.begin(), values_.end(), 0.0);
}

void ReducedResidual::add_closure(int closure, int index, double multiplier, const ClosureMaps& maps) {
  assert(index >= 0 && index < dof_.size[dof_.variable_of_closure(closure)]);
  const LoopClosure& loop = model_.closures[closure];
  at(dof_.variable_of_closure(closure))[index] += maps.value;
  node(loop.child) += multiplier * maps.left.child;
  if (loop.parent >= 0) node(loop.parent) += multiplier * maps.left.parent;
}

void ReducedResidual::fold(int j, const FoldMaps& maps) {
  assert(maps.left.cols() == released_count(model_.joints[j].kind));
  const JointMap& joint = model_.joints[j];
  const Vector6 g = node(joint.slave);
  const int count = released_count(joint.kind);
  double* released = at(dof_.variable_of_joint(j));
  for (int k = 0; k < count; ++k) released[k] += maps.left.col(k).dot(g);
  if (joint.master < 0) return;
  Eigen::Map<Vector6> master = node(joint.master);
  master += g;
  master.tail<3>() += maps.lever_left.cross(g.head<3>());
}

void ReducedResidual::fold(int j, const SlideMaps& maps) {
  const JointMap& joint = model_.joints[j];
  const SlideLine& line = model_.slide_lines[joint.line];
  assert(maps.first >= 0 && static_cast<std::size_t>(maps.first + maps.count) <= line.nodes.size());
  const Vector6 g = node(joint.slave);
  at(dof_.variable_of_joint(j))[0] += maps.released_left.dot(g);
  for (int k = 0; k < maps.count; ++k) node(line.nodes[maps.first + k]) += maps.left[k].transpose() * g;
}

void ReducedResidual::fold_mimics(std::vector<MimicMap>& maps) {
  assert(maps.size() == dof_.mimics.size());
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const double row = *at(dof_.mimics[i].slave_variable);
    *at(dof_.mimics[i].master_variable) += maps[i].left * row;
    maps[i].geometric = maps[i].left_derivative * row;
  }
}

void ReducedResidual::gather(Eigen::VectorXd& residual) const {
  assert(residual.size() == dof_.unknowns);
  for (const auto& [scalar, equation, count] : dof_.runs)
    std::copy_n(values_.data() + scalar, count, residual.data() + equation);
}

}  // namespace flexarm
