// BorderedElimination: slaves and mimics are folded, rows are held.
#include "solver/bordered_elimination.h"

namespace flexarm {
namespace {

/// Calls visit(node, index) for the nodes into which a joint's slave is folded.
template <class Visit>
void for_each_master(const Model& model, const JointMap& joint, NodeRange window, const Visit& visit) {
  if (joint.kind == JointMapKind::Slide) {
    const std::vector<int>& nodes = model.slide_lines[joint.line].nodes;
    for (int k = window.first; k < window.end; ++k) visit(nodes[k], k - window.first);
  } else if (joint.master >= 0) {
    visit(joint.master, 0);
  }
}

/// Effect of the master's motion on the slave over a rigid lever arm: d{r, spin} = {dr_m + spin_m x lever, spin_m}.
Matrix6 arm_columns(const Vector3& lever) {
  Matrix6 out = Matrix6::Identity();
  out.topRightCorner<3, 3>() << 0, lever.z(), -lever.y(), -lever.z(), 0, lever.x(), lever.y(), -lever.x(), 0;
  return out;
}

}  // namespace

void BorderedElimination::fold_slave(const TreePart& part, Factors& factors) {
  const JointMap& joint = model_.joints[part.joint];
  factors.joint = part.joint;
  set_targets(joint, part.joint, factors);
  set_maps(joint, part.joint, factors);
  const int distance = 4 * lanes_for(factors.target_count);
  front_.fold(6 * joint.slave, 6, memory(factors.left), memory(factors.right), distance,
              scalars_.data() + factors.targets, factors.target_count);
  add_geometric(joint, part.joint);
}

void BorderedElimination::set_targets(const JointMap& joint, int j, Factors& factors) {
  const int variable = dof_.variable_of_joint(j);
  factors.targets = scalars_.size();
  for (int k = 0; k < dof_.size[variable]; ++k)
    if (is_placed_[dof_.first[variable] + k]) scalars_.push_back(dof_.first[variable] + k);
  for_each_master(model_, joint, order_.window(j), [&](int node, int) {
    for (int k = 0; k < 6; ++k) scalars_.push_back(6 * node + k);
  });
  factors.target_count = static_cast<int>(scalars_.size() - factors.targets);
  const int lanes = lanes_for(factors.target_count);
  factors.left = allocate(4 * lanes * 6);
  factors.right = allocate(4 * lanes * 6);
}

void BorderedElimination::set_maps(const JointMap& joint, int j, const Factors& factors) {
  const int variable = dof_.variable_of_joint(j), distance = 4 * lanes_for(factors.target_count);
  double *left = memory(factors.left), *right = memory(factors.right);
  int target = 0;
  const auto set_column = [&](const auto& of_left, const auto& of_right) {
    for (int k = 0; k < 6; ++k) left[distance * k + target] = of_left[k], right[distance * k + target] = of_right[k];
    ++target;
  };
  const auto set_node = [&](const Matrix6& of_left, const Matrix6& of_right) {
    for (int k = 0; k < 6; ++k) set_column(of_left.col(k), of_right.col(k));
  };
  const bool slides = joint.kind == JointMapKind::Slide;
  const FoldMaps& maps = blocks_.maps[j];
  const SlideMaps& slide = blocks_.slide_maps[j];
  for (int k = 0; k < dof_.size[variable]; ++k) {
    if (!is_placed_[dof_.first[variable] + k]) continue;
    if (slides)
      set_column(slide.released_left, slide.released_right);
    else
      set_column(maps.left.col(k), maps.right.col(k));
  }
  for_each_master(model_, joint, order_.window(j), [&](int, int i) {
    if (slides)
      set_node(slide.left[i], slide.right[i]);
    else
      set_node(arm_columns(maps.lever_left), arm_columns(maps.lever_right));
  });
}

void BorderedElimination::add_geometric(const JointMap& joint, int j) {
  const bool slides = joint.kind == JointMapKind::Slide;
  const FoldMaps& maps = blocks_.maps[j];
  const SlideMaps& slide = blocks_.slide_maps[j];
  const int variable = dof_.variable_of_joint(j), size = dof_.size[variable], first = dof_.first[variable];
  for (int r = 0; r < size; ++r) {
    if (!is_placed_[first + r]) continue;
    for (int c = 0; c < size; ++c)
      if (is_placed_[first + c])
        front_.row(front_.row_place(first + r))[front_.column_place(first + c)] +=
            slides ? slide.released_released : maps.released_released(r, c);
    for_each_master(model_, joint, order_.window(j), [&](int node, int i) {
      if (slides) {
        front_.add(first + r, 6 * node, slide.released_master[i].data(), 1, 6, 1);
        front_.add(6 * node, first + r, slide.master_released[i].data(), 6, 1, 6);
      } else {
        front_.add(first + r, 6 * node + 3, maps.released_spin.data() + r, 1, 3, size);
        front_.add(6 * node + 3, first + r, maps.moment_released.data() + 3 * r, 3, 1, 3);
      }
    });
  }
  for_each_master(model_, joint, order_.window(j), [&](int node, int i) {
    if (!slides) return front_.add(6 * node + 3, 6 * node + 3, maps.moment_spin.data(), 3, 3, 3);
    for_each_master(model_, joint, order_.window(j), [&](int other, int k) {
      front_.add(6 * node + 3, 6 * other, slide.moment_master[i * slide.count + k].data(), 3, 6, 3);
    });
  });
}

void BorderedElimination::fold_mimics(const TreePart& part, Factors& factors) {
  factors.mimics = allocate(2 * static_cast<int>(part.mimics.size()));
  for (std::size_t i = 0; i < part.mimics.size(); ++i) {
    const DegreesOfFreedom::Mimic& mimic = dof_.mimics[part.mimics[i]];
    const MimicMap& map = blocks_.mimics[part.mimics[i]];
    double* factor = memory(factors.mimics) + 2 * i;
    factor[0] = map.left;
    factor[1] = map.right;
    const int master = dof_.first[mimic.master_variable];
    if (!is_placed_[master]) continue;
    front_.fold(dof_.first[mimic.slave_variable], 1, &map.left, &map.right, 1, &master, 1);
    front_.add(master, master, &map.geometric, 1, 1, 1);
  }
}

void BorderedElimination::hold_rows(int index, Factors& factors) {
  factors.held = scalars_.size();
  for (const TreeBlocks::HeldRow& held : blocks_.held) {
    const int variable = dof_.variable_of_joint(held.joint);
    if (order_.parts()[order_.completion(variable)].front != index) continue;
    const int scalar = dof_.first[variable] + held.component;
    scalars_.push_back(scalar);
    front_.clear_row(scalar);
    for (int k = 0; k < held.coefficients.size(); ++k)
      if (is_placed_[dof_.first[variable] + held.first + k])
        front_.row(front_.row_place(scalar))[front_.column_place(dof_.first[variable] + held.first + k)] =
            held.coefficients[k];
  }
  factors.held_count = static_cast<int>(scalars_.size() - factors.held);
}

}  // namespace flexarm
