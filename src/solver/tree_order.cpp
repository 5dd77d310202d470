#include "solver/tree_order.h"

#include <algorithm>
#include <cassert>

namespace flexarm {

TreeOrder::TreeOrder(const Model& model, const DegreesOfFreedom& dof)
    : model_(model), dof_(dof), windows_(model.joints.size(), {0, 0}), receives_(dof.node_count) {
  const std::vector<Vector6> at_rest(model_.nodes.size(), Vector6::Zero());
  for (const auto& element : model_.force_elements) {
    const ForcePieces& pieces = element->pieces();
    Coupling& coupling = couplings_.emplace_back();
    find_nodes(*element, {model_.nodes, at_rest}, coupling.nodes);
    coupling.in_pieces = !pieces.pairs.empty();
    coupling.auxiliary_count = pieces.rank > 0 ? static_cast<int>(pieces.groups.size()) : 0;
    coupling.first_auxiliary = static_cast<int>(dof_.size.size());
    for (int g = 0; g < coupling.auxiliary_count; ++g) dof_.add_variable(pieces.rank);
  }
  completion_.assign(dof_.size.size(), -1);
  visited_.assign(dof_.size.size(), -1);
  order_parts();
  if (parts_.empty()) return;
  place_variables();
  place_mimics();
  place_pieces();
  for (std::size_t v = 0; v < completion_.size(); ++v)
    if (completion_[v] >= 0) parts_[completion_[v]].complete.push_back(static_cast<int>(v));
  last_ = completion_;
  place_closures();
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    if (model_.joints[j].kind != JointMapKind::Slide) continue;
    const SlideLine& line = model_.slide_lines[model_.joints[j].line];
    const int piece = line.piece_at(model_.initial_released[j].displacement[0]);
    windows_[j] = line.support(piece, piece);
  }
  count_riders();
  complete_ = true;
  update();
}

void TreeOrder::set_window(int joint, NodeRange window) {
  assert(window.first >= 0 && window.first < window.end);
  NodeRange& old = windows_[joint];
  if (old.first == window.first && old.end == window.end) return;
  old = window;
  old_ = true;
}

void TreeOrder::set_coupling(int coupling, const int* nodes, int count) {
  assert(coupling >= 0 && static_cast<std::size_t>(coupling) < couplings_.size() && count >= 0);
  std::vector<int>& old = couplings_[coupling].nodes;
  if (couplings_[coupling].in_pieces) return;  // it always couples the same nodes
  if (std::equal(nodes, nodes + count, old.begin(), old.end())) return;
  old.assign(nodes, nodes + count);
  old_ = true;
}

void TreeOrder::update() {
  if (old_) find_borders();
  old_ = false;
}

/// Per variable: the parts that couple it, apart from windows of sliders.
std::vector<std::vector<int>> TreeOrder::parts_of_variables() const {
  std::vector<std::vector<int>> parts(last_.size());
  for (std::size_t p = 0; p < parts_.size(); ++p)
    for_each_of_its_own(parts_[p], [&](int variable) {
      if (parts[variable].empty() || parts[variable].back() != static_cast<int>(p))
        parts[variable].push_back(static_cast<int>(p));
    });
  return parts;
}

/// Per part: the next part to which it may pass something; -1: none. It is computed as if every slider coupled its
/// whole line. For any windows, a part then passes only to parts on its path in this tree. (Liu, The role of
/// elimination trees in sparse factorization, 1990)
std::vector<int> TreeOrder::elimination_tree(std::vector<std::vector<int>> parts) const {
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointMap& joint = model_.joints[j];
    if (joint.kind != JointMapKind::Slide) continue;
    for (const int node : model_.slide_lines[joint.line].nodes) parts[node].push_back(completion_[joint.slave]);
  }
  // A force element may couple any two nodes of its reach. For this, the tree must have a path through all of them.
  for (std::size_t k = 0; k < couplings_.size(); ++k) {
    if (couplings_[k].in_pieces) continue;
    std::vector<int> nodes = model_.force_elements[k]->reach();
    std::sort(nodes.begin(), nodes.end(), [&](int a, int b) { return completion_[a] < completion_[b]; });
    for (std::size_t i = 1; i < nodes.size(); ++i) parts[nodes[i]].push_back(completion_[nodes[i - 1]]);
  }
  std::vector<std::vector<int>> ending(parts_.size());  // per part: variables that are in borders up to this part
  for (std::size_t v = 0; v < last_.size(); ++v)
    if (last_[v] >= 0) ending[last_[v]].push_back(static_cast<int>(v));  // < 0: the variable is held
  std::vector<int> next(parts_.size(), -1), ancestor(parts_.size(), -1);
  for (int p = 0; p < static_cast<int>(parts_.size()); ++p)
    for (const int variable : ending[p])
      for (const int part : parts[variable])
        for (int at = part; at >= 0 && at < p;) {
          const int above = ancestor[at];
          ancestor[at] = p;
          if (above < 0) next[at] = p;
          at = above;
        }
  return next;
}

/// Counts riders, for any windows. A variable rides from the part that couples it to the one that eliminates it. The
/// window of a slider may ride up to the last part of its line. Coordinates of a loop may wait for pivots as long as
/// the multipliers of the loop.
void TreeOrder::count_riders() {
  const std::vector<std::vector<int>> parts = parts_of_variables();
  const std::vector<int> next = elimination_tree(parts);
  most_riders_.assign(parts_.size(), 0);
  std::vector<int> last_rider(parts_.size(), -1);
  const int first_multiplier = dof_.node_count + dof_.joint_count;
  for (int v = 0; v < static_cast<int>(parts.size()); ++v)
    for (const int part : parts[v])
      for (int p = next[part]; p >= 0 && p < last_[v] && last_rider[p] != v; p = next[p]) {
        last_rider[p] = v;
        most_riders_[p] += v < first_multiplier ? dof_.size[v] : 2 * dof_.size[v];
      }
  for (const JointMap& joint : model_.joints) {
    if (joint.kind != JointMapKind::Slide) continue;
    const SlideLine& line = model_.slide_lines[joint.line];
    const int last = last_part_of_line(line), scalars = 6 * static_cast<int>(line.most_active_nodes());
    for (int p = completion_[joint.slave]; p >= 0 && p < last; p = next[p]) most_riders_[p] += scalars;
  }
  count_riders_of_couplings(next);
  // Each variable rides only once, even if several force elements couple it.
  int all = 0;
  for (const int size : dof_.size) all += 2 * size;
  for (int& riders : most_riders_) riders = std::min(riders, all);
  std::size_t variables = 0;
  for (const std::vector<int>& own : parts) variables += own.size();
  for (const auto& element : model_.force_elements) variables += element->most_nodes();
  for (const int riders : most_riders_) variables += riders;  // upper bound: a node counts as six, a coordinate as one
  border_.reserve(variables);
}

/// The nodes of a force element may ride from any part of its reach to the last part of its reach.
void TreeOrder::count_riders_of_couplings(const std::vector<int>& next) {
  std::vector<int> last_rider(parts_.size(), -1);
  for (std::size_t k = 0; k < model_.force_elements.size(); ++k) {
    if (couplings_[k].in_pieces) continue;  // counted as what parts couple by themselves
    const ForceElement& element = *model_.force_elements[k];
    std::vector<int> completions;
    for (const int node : element.reach()) completions.push_back(completion_[node]);
    const int last = *std::max_element(completions.begin(), completions.end());
    for (const int first : completions)
      for (int p = first; p >= 0 && p < last && last_rider[p] != static_cast<int>(k); p = next[p]) {
        last_rider[p] = static_cast<int>(k);
        most_riders_[p] += 6 * element.most_nodes();
      }
  }
}

void TreeOrder::find_borders() {
  place_couplings();
  border_.clear();
  std::fill(visited_.begin(), visited_.end(), -1);
  for (TreePart& part : parts_) part.first_child = part.next_sibling = -1;
  for (std::size_t p = 0; p < parts_.size(); ++p) find_border(static_cast<int>(p));
  find_fronts();
  find_kept_interiors();
}

/// Lets parts share fronts. A part joins the front of the next part if that part has nothing else to eliminate or to
/// leave, such as a slider and the elements of its window. The shared front has no additional zeros, and saves passing
/// a remainder. (Fundamental supernodes: Liu, Ng and Peyton 1993)
void TreeOrder::find_fronts() {
  const int count = static_cast<int>(parts_.size());
  for (int p = 0; p < count; ++p) {
    TreePart& part = parts_[p];
    part.first_member = p;
    part.next_member = -1;
    int child = part.first_child;
    while (child >= 0 && !may_join(parts_[child], part)) child = parts_[child].next_sibling;
    if (child < 0) continue;
    parts_[child].next_member = p;
    part.first_member = parts_[child].first_member;
  }
  for (int p = count - 1; p >= 0; --p)
    parts_[p].front = parts_[p].next_member < 0 ? p : parts_[parts_[p].next_member].front;
}

bool TreeOrder::may_join(const TreePart& part, const TreePart& next) const {
  for (const TreePart* each : {&part, &next})
    if (!each->closures.empty() || !each->mimics.empty() || each->couples_forces()) return false;
  int folds = next.joint >= 0 ? 1 : 0;
  for (int p = part.first_member; p >= 0; p = parts_[p].next_member) folds += parts_[p].joint >= 0 ? 1 : 0;
  const int* rest = border(part);
  const int first_multiplier = dof_.node_count + dof_.joint_count;  // multipliers wait for fronts after their closure
  return folds <= 1 && next.complete.size() + next.border_count == static_cast<std::size_t>(part.border_count) &&
         std::all_of(rest, rest + part.border_count, [&](int variable) { return variable < first_multiplier; });
}

void TreeOrder::find_kept_interiors() {
  std::fill(receives_.begin(), receives_.end(), false);
  for (const TreePart& part : parts_)
    if (part.passes_node && part.border_count == 1) receives_[*border(part)] = true;
  for (TreePart& part : parts_)
    part.keeps_interior = part.node_count > 2 && !part.has_border &&
                          std::none_of(part.nodes.begin() + 1, part.nodes.begin() + part.node_count - 1,
                                       [&](int node) { return receives_[node]; });
}

/// Visits the variables that a part couples by itself, without windows of sliders and remainders of other parts.
template <class Visit>
void TreeOrder::for_each_of_its_own(const TreePart& part, const Visit& visit) const {
  for (const int e : part.elements) std::for_each_n(parts_[e].nodes.begin(), parts_[e].node_count, visit);
  for (const int k : part.closures) {
    const LoopClosure& closure = model_.closures[k];
    if (closure.parent >= 0) visit(closure.parent);
    visit(closure.child);
  }
  for (int k = part.first_coupling; k >= 0; k = couplings_[k].next)
    std::for_each(couplings_[k].nodes.begin(), couplings_[k].nodes.end(), visit);
  for (const auto& [coupling, piece] : part.pieces)
    for (const int node : model_.force_elements[coupling]->pieces().pairs[piece])
      visit(couplings_[coupling].nodes[node]);
  for (const TreePart::Factor& factor : part.factors) visit(auxiliary(factor.coupling, factor.group));
  for (const auto& [coupling, row, column] : part.inners) {
    visit(auxiliary(coupling, row));
    visit(auxiliary(coupling, column));
  }
  std::for_each(part.complete.begin(), part.complete.end(), visit);
  if (part.joint >= 0) {
    const JointMap& joint = model_.joints[part.joint];
    const int variable = dof_.variable_of_joint(part.joint);
    if (dof_.size[variable] > 0) visit(variable);
    if (joint.kind != JointMapKind::Slide && joint.master >= 0) visit(joint.master);
  }
  for (const int i : part.mimics) visit(dof_.mimics[i].master_variable);
}

template <class Visit>
void TreeOrder::for_each_coupled(const TreePart& part, const Visit& visit) const {
  for (int child = part.first_child; child >= 0; child = parts_[child].next_sibling)
    std::for_each_n(border(parts_[child]), parts_[child].border_count, visit);
  for_each_of_its_own(part, visit);
  if (part.joint < 0 || model_.joints[part.joint].kind != JointMapKind::Slide) return;
  const std::vector<int>& nodes = model_.slide_lines[model_.joints[part.joint].line].nodes;
  std::for_each(nodes.begin() + windows_[part.joint].first, nodes.begin() + windows_[part.joint].end, visit);
}

void TreeOrder::find_border(int index) {
  TreePart& part = parts_[index];
  part.first_border = static_cast<int>(border_.size());
  int next = static_cast<int>(parts_.size());
  for_each_coupled(part, [&](int variable) {
    if (visited_[variable] == index || last_[variable] <= index) return;
    visited_[variable] = index;
    border_.push_back(variable);
    next = std::min(next, last_[variable]);
  });
  part.border_count = static_cast<int>(border_.size()) - part.first_border;
  part.passes_node = part.border_count == 0 || (part.border_count == 1 && border_[part.first_border] < dof_.node_count);
  const bool has_own_element =
      part.joint >= 0 ? part.elements.empty() : part.elements.size() == 1 && part.elements[0] == index;
  part.has_border = part.first_child >= 0 || part.couples_forces() || !part.passes_node || !part.closures.empty() ||
                    !part.mimics.empty() || !has_own_element;
  if (part.passes_node) return;
  part.next_sibling = parts_[next].first_child;
  parts_[next].first_child = index;
}

}  // namespace flexarm
