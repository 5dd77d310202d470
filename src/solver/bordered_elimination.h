#pragma once
/// Elimination of those parts of a tree whose fronts have a border: lines with their sliders, loops, mimics.

#include <vector>

#include "solver/dense_front.h"
#include "solver/tree_blocks.h"
#include "solver/tree_order.h"

namespace flexarm {

/// One dense front for each part that TreeOrder finds to have a border, or for several of them: what they add, what
/// others have passed on, the fold of a slave, elimination of what is complete. What remains goes into the block of the
/// inboard node or, where it couples more than that, to a later part. A released coordinate or a multiplier without a
/// pivot that is large enough is passed on, too, until it finds one: multipliers have zeros on their diagonal, and a
/// loop that is cut open may move without inertia or stiffness.
class BorderedElimination {
 public:
  /// All must outlive it.
  BorderedElimination(const Model& model, const DegreesOfFreedom& dof, const TreeOrder& order, TreeBlocks& blocks);

  /// Forgets all factors.
  void begin();
  /// False if the part is singular. Of parts that share a front the last one eliminates all.
  bool eliminate(int part);
  /// `values`: per scalar of the mechanism, the right-hand side by rows, and after backward() the solution by columns.
  void forward(int part, const Eigen::VectorXd& b, std::vector<double>& values);
  void backward(int part, std::vector<double>& values) const;

 private:
  /// Offsets into `scalars_` and, in vectors of four numbers, into `memory_`.
  struct Factors {
    int size = 0, pivots = 0, delayed = 0, stride = 0;
    std::size_t rows = 0, columns = 0, lower = 0, upper = 0, reciprocals = 0, forwarded = 0;
    std::size_t remainder = 0;  ///< Schur complement for a later part
    int joint = -1;             ///< whose slave is folded
    int target_count = 0, held_count = 0;
    std::size_t targets = 0, left = 0, right = 0, held = 0, mimics = 0;
  };

  struct Run {
    int from, place, count;
  };

  double* memory(std::size_t fours) { return numbers(memory_) + 4 * fours; }
  const double* memory(std::size_t fours) const { return numbers(memory_) + 4 * fours; }
  std::size_t allocate(int numbers);
  void reserve();
  void lay_out(int index);
  template <class Visit>
  void for_each_member(int index, const Visit& visit) const;
  bool is_folded(const TreePart& part, int variable) const;
  void add_scalars(int variable);
  void assemble(int index);
  void add_diagonal(int variable);
  void add_closure(int closure);
  void add_coupling(int coupling);
  void add_remainder(const Factors& factors);
  void fold_slave(const TreePart& part, Factors& factors);
  void set_targets(const JointMap& joint, int j, Factors& factors);
  void set_maps(const JointMap& joint, int j, const Factors& factors);
  void add_geometric(const JointMap& joint, int j);
  void fold_mimics(const TreePart& part, Factors& factors);
  void hold_rows(int index, Factors& factors);
  void keep(int pivots, Factors& factors);
  void pass_on(const TreePart& part, Factors& factors);

  const Model& model_;
  const DegreesOfFreedom& dof_;
  const TreeOrder& order_;
  TreeBlocks& blocks_;
  DenseFront front_;
  int candidates_ = 0;
  std::vector<int> certain_;      // of the front's nodes, those of each of its parts end there
  std::vector<char> is_placed_;   // per scalar: it has rows and columns in fronts
  std::vector<Factors> factors_;  // per part
  std::vector<int> scalars_;
  std::vector<Run> runs_;
  FrontMemory memory_;
  std::size_t used_ = 0;  // of the memory
  mutable FrontMemory work_;
};

}  // namespace flexarm
