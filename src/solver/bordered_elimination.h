#pragma once
/// Eliminates those parts of a tree whose fronts have a border: sliders and their lines, loops, mimics.

#include <vector>

#include "solver/dense_front.h"
#include "solver/tree_blocks.h"
#include "solver/tree_order.h"

namespace flexarm {

/// Each part that has a border according to TreeOrder has a dense front, which several parts may share. A front is
/// assembled from the blocks of its parts and the remainders of earlier parts. Then its slaves are folded, and its
/// complete variables are eliminated. The remainder is added to the block of the inboard node or, if it couples more
/// variables, is passed to a later part. A joint coordinate or multiplier without a sufficiently large pivot is
/// postponed to the next front, until it has one. Multipliers need this because their diagonal is zero. So do the
/// coordinates of a loop that is cut open, which may move without inertia or stiffness.
class BorderedElimination {
 public:
  /// All arguments must outlive this object.
  BorderedElimination(const Model& model, const DegreesOfFreedom& dof, const TreeOrder& order, TreeBlocks& blocks);

  /// Discards all factors.
  void begin();
  /// Returns false if the part is singular. If parts share a front, the elimination happens in the last of them.
  bool eliminate(int part);
  /// `values`: per scalar of the mechanism; the right-hand side, named by rows. After backward(): the solution, named
  /// by columns.
  void forward(int part, const Eigen::VectorXd& b, std::vector<double>& values);
  void backward(int part, std::vector<double>& values) const;

 private:
  /// Offsets into `scalars_` and, in vectors of four numbers, into `memory_`.
  struct Factors {
    int size = 0, pivots = 0, delayed = 0, stride = 0;
    std::size_t rows = 0, columns = 0, lower = 0, upper = 0, reciprocals = 0, forwarded = 0;
    std::size_t remainder = 0;  ///< Schur complement that is passed to a later part
    int joint = -1;             ///< the joint whose slave is folded
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
  void add_piece(const TreePart::Piece& piece);
  void add_factor(const TreePart::Factor& factor);
  void add_inner(const TreePart::Inner& inner);
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
  std::vector<int> certain_;      // ends of the groups of nodes in the front, one group for each of its parts
  std::vector<char> is_placed_;   // per scalar: whether fronts have a row and a column for it
  std::vector<Factors> factors_;  // per part
  std::vector<int> scalars_;
  std::vector<Run> runs_;
  FrontMemory memory_;
  std::size_t used_ = 0;  // number of used elements of memory_
  mutable FrontMemory work_;
};

}  // namespace flexarm
