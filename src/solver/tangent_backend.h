#pragma once
/// Interface of the solvers for the tangent of a step: a sparse matrix, or fronts along the tree. Other code does not
/// know which one is used. Code that needs the matrix itself requests it (BackendChoice::Matrix,
/// TangentBackend::matrix()).

#include <memory>
#include <vector>

#include "joints/closure_maps.h"
#include "joints/joint_map.h"
#include "joints/slide_map.h"
#include "model/degrees_of_freedom.h"

namespace flexarm {

class InteriorCondensation;
class SparseTangent;

/// For a coordinate that follows another one: the factors of its row (left) and column (right), and the derivative of
/// `left`. `geometric` is this derivative times the row's residual, see ReducedResidual::fold_mimics.
struct MimicMap {
  double left, right, left_derivative;
  double geometric = 0;
};

/// Collects the tangent of nodes in blocks, folds slaves into their masters and released coordinates, and solves.
///
/// The slave of a joint is its outboard node. The slave's pose follows from that of the inboard node, the master, and
/// from the joint's released coordinates. To fold a slave is to move its rows and columns to these variables. The root
/// of the tree is the world, leaves are outboard. (docs/notes/joints.md)
///
/// Order of calls: set_zero(); blocks, closures and couplings; folds from the leaves to the root; mimics; finish();
/// rows that are held; factorise(); then any number of solutions.
class TangentBackend {
 public:
  virtual ~TangentBackend() = default;

  // ---- accumulation
  virtual void set_zero() = 0;
  /// The diagonal block of a variable, column-major, size x size. In the plane, blocks of nodes are as in
  /// element_block().
  double* diagonal_block(int variable) { return diagonal_blocks_[variable]; }
  /// Adds to the diagonal block of a node, in world axes.
  virtual void add_to_node(int node, const Matrix6& block) { Eigen::Map<Matrix6>(diagonal_block(node)) += block; }
  /// Block (node i, node j) of an element, column-major; `index` = element.first_block + i * Nodes + j. It is 6 x 6; in
  /// the plane 3 x 3 in the plane's axes, with columns four numbers apart (planar::BlockSystem).
  double* element_block(int index) { return element_blocks_[index]; }
  /// Whether no two elements share a block. If so, set_zero() does not clear these blocks, and the first contribution
  /// of an element must set them. Otherwise all contributions are added.
  bool keeps_elements_apart() const { return keeps_elements_apart_; }
  /// To be called once if beams are evaluated in packs of elements. A backend that eliminates interior nodes side by
  /// side then provides a condensation().
  virtual void condense_interiors() {}
  /// The memory in which packs of elements with interior nodes are evaluated, in place of element_block(); or null.
  virtual InteriorCondensation* condensation() { return nullptr; }
  /// Adds constraint `index` of a closure with its multiplier. To be called before joints are folded.
  virtual void add_closure(int closure, int index, double multiplier, const ClosureMaps& maps) = 0;
  /// Sets the nodes that coupling `index` couples from now on, each once. There is one coupling per force element of
  /// the model. To be called before set_zero().
  virtual void couple(int index, const int* nodes, int count) = 0;
  /// Adds the blocks of a coupling's nodes with each other, 6 count x 6 count. To be called before joints are folded.
  virtual void add_coupling(int index, const Eigen::Ref<const Eigen::MatrixXd>& blocks) = 0;
  /// Adds a coupling whose element has ForcePieces, at most once after set_zero(). To be called before joints are
  /// folded.
  virtual void add_coupling(int index, const PieceTangent& tangent) = 0;

  // ---- reduction
  /// The maps of a joint, or of a slider, to be filled before fold().
  virtual FoldMaps& fold_maps(int joint) = 0;
  virtual SlideMaps& slide_maps(int joint) = 0;
  /// Folds the slave of `joint` with these maps. To be called from the leaves to the root.
  virtual void fold(int joint) = 0;
  /// Folds mimic coordinates, after all joints. `maps`: one per entry of DegreesOfFreedom::mimics.
  virtual void fold_mimics(const std::vector<MimicMap>& maps) = 0;
  /// To be called when everything is folded.
  virtual void finish() = 0;
  /// Replaces the row of a released component. The new row has `coefficients` in the columns of the joint's components
  /// from `first` on, and zeros elsewhere. To be called after finish().
  virtual void hold_row(int joint, int component, int first, const ReleasedVector& coefficients) = 0;

  // ---- solution
  /// Returns false if the tangent is singular or not finite.
  virtual bool factorise() = 0;
  /// factorise(), then solve(b). Backends may combine parts of these.
  virtual bool factorise_and_solve(Eigen::VectorXd& b) { return factorise() && solve(b); }
  /// The variable whose elimination failed in factorise(); -1: unknown.
  virtual int singular_variable() const { return -1; }
  /// Replaces b, one entry per equation, by the solution with the last factors. Returns false if it is not finite.
  virtual bool solve(Eigen::VectorXd& b) = 0;
  /// The last solution for all scalars (DegreesOfFreedom::first). Slaves are moved by the maps of the last factors.
  /// Null if the backend cannot provide it.
  virtual const double* expanded_solution() = 0;

  /// Cost of an iteration with new factors relative to one with kept factors, see FactorReuse.
  virtual double cost_of_factors() const = 0;

  /// The tangent as a matrix, after finish(). Requires BackendChoice::Matrix.
  /// @throws std::logic_error if this backend does not form a matrix
  virtual const SparseTangent& matrix() const;

 protected:
  std::vector<double*> diagonal_blocks_, element_blocks_;
  bool keeps_elements_apart_ = false;
};

enum class BackendChoice {
  Fastest,  ///< the fastest one that the model allows
  Matrix    ///< the sparse matrix: the reference for all others
};
/// Creates a backend. The model and `dof` must outlive it.
std::unique_ptr<TangentBackend> make_tangent_backend(const Model& model, const DegreesOfFreedom& dof,
                                                     BackendChoice choice = BackendChoice::Fastest);

}  // namespace flexarm
