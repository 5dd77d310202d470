#pragma once
/// The solver for the tangent of a step: a sparse matrix, or fronts along the tree. Nothing else knows which of both is
/// used. Code that needs the matrix itself requests it (BackendChoice::Matrix, TangentBackend::matrix()).

#include <memory>
#include <vector>

#include "joints/closure_maps.h"
#include "joints/joint_map.h"
#include "joints/slide_map.h"
#include "model/degrees_of_freedom.h"

namespace flexarm {

class InteriorCondensation;
class SparseTangent;

/// Of a coordinate that follows another one: the factors of its row and of its column, the derivative of the former,
/// and that derivative times the row, see ReducedResidual::fold_mimics.
struct MimicMap {
  double left, right, left_derivative;
  double geometric = 0;
};

/// Accumulates the nodal tangent in blocks, folds slaves into their masters and released coordinates, and solves.
///
/// Life of a tangent: set_zero(), blocks, closures and couplings, then folds from leaf to root, mimics, finish(), rows
/// that are held, factorise(); then as many solutions as are needed.
class TangentBackend {
 public:
  virtual ~TangentBackend() = default;

  // ---- accumulation
  virtual void set_zero() = 0;
  /// Column-major block on the diagonal of a variable, size x size; of a node, in the plane, as element_block().
  double* diagonal_block(int variable) { return diagonal_blocks_[variable]; }
  /// Adds to a node's block on the diagonal, in world axes.
  virtual void add_to_node(int node, const Matrix6& block) { Eigen::Map<Matrix6>(diagonal_block(node)) += block; }
  /// Block (node i, node j) of an element, column-major; `index` = element.first_block + i * Nodes + j. 6 x 6; in the
  /// plane 3 x 3 in its axes, columns four numbers apart (planar::BlockSystem).
  double* element_block(int index) { return element_blocks_[index]; }
  /// True where no two elements share a block. Then set_zero() leaves these blocks alone, and who writes first into
  /// those of an element sets them; else all add.
  bool keeps_elements_apart() const { return keeps_elements_apart_; }
  /// To be called once where beams evaluate packs of elements: a backend that eliminates interior nodes side by side
  /// then has a condensation().
  virtual void condense_interiors() {}
  /// Where packs of elements with interior nodes are evaluated, in the place of their element_block(). Or null.
  virtual InteriorCondensation* condensation() { return nullptr; }
  /// Adds constraint `index` of a closure with its multiplier, before joints are folded.
  virtual void add_closure(int closure, int index, double multiplier, const ClosureMaps& maps) = 0;
  /// The nodes that coupling `index` couples from now on, each once; one for each force element of the model. To be
  /// called before set_zero().
  virtual void couple(int index, const int* nodes, int count) = 0;
  /// Adds the blocks of a coupling's nodes with each other, 6 count x 6 count, before joints are folded.
  virtual void add_coupling(int index, const Eigen::Ref<const Eigen::MatrixXd>& blocks) = 0;

  // ---- reduction
  /// Where the maps of a joint, or of one that slides, are to be written for fold().
  virtual FoldMaps& fold_maps(int joint) = 0;
  virtual SlideMaps& slide_maps(int joint) = 0;
  /// Folds the slave of `joint` by the maps that stand there; leaf to root.
  virtual void fold(int joint) = 0;
  /// Folds coordinates that follow others; after all joints. `maps`: per entry of DegreesOfFreedom::mimics.
  virtual void fold_mimics(const std::vector<MimicMap>& maps) = 0;
  /// Everything is folded.
  virtual void finish() = 0;
  /// Replaces the row of a released component by `coefficients` in the columns of the joint's components from `first`
  /// on, and zeros; after finish().
  virtual void hold_row(int joint, int component, int first, const ReleasedVector& coefficients) = 0;

  // ---- solution
  /// False if the tangent is singular or not finite.
  virtual bool factorise() = 0;
  /// factorise(), then solve(b): backends may do part of both at once.
  virtual bool factorise_and_solve(Eigen::VectorXd& b) { return factorise() && solve(b); }
  /// The variable whose elimination has failed then; -1: the backend cannot tell.
  virtual int singular_variable() const { return -1; }
  /// Replaces b, one entry per equation, by the solution with the factors made last. False if that is not finite.
  virtual bool solve(Eigen::VectorXd& b) = 0;
  /// The last solution for all scalars (DegreesOfFreedom::first), slaves as the maps of the last factors move them.
  /// Null if the backend does not know these.
  virtual const double* expanded_solution() = 0;

  /// An iteration with new factors costs about so much more than one with kept ones, see FactorReuse.
  virtual double cost_of_factors() const = 0;

  /// The backend of BackendChoice::Matrix itself, which has the tangent as a matrix after finish().
  /// @throws std::logic_error if this one never makes a matrix
  virtual const SparseTangent& matrix() const;

 protected:
  std::vector<double*> diagonal_blocks_, element_blocks_;
  bool keeps_elements_apart_ = false;
};

enum class BackendChoice {
  Fastest,  ///< what the model allows
  Matrix    ///< the sparse matrix: the reference for all others
};
/// Of a model; both must outlive it.
std::unique_ptr<TangentBackend> make_tangent_backend(const Model& model, const DegreesOfFreedom& dof,
                                                     BackendChoice choice = BackendChoice::Fastest);

}  // namespace flexarm
