#pragma once
/// Coordinates of a tree of rigid links that follow others or functions of time, for explicit schemes: joints that
/// mimic others, prescribed motions, and joints of loops. (docs/notes/explicit.md 4)

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

#include "integrators/stage_derivatives.h"
#include "joints/articulated_bodies.h"
#include "joints/closure_maps.h"
#include "model/state.h"

namespace flexarm {

/// The rates u of all joints are u = G v + g: v are the rates of independent coordinates, and g those that the motions
/// cause. So the equations of motion of v are G^T (M u' + h - efforts) = 0. Allocates no memory after construction.
class DependentRates {
 public:
  DependentRates(const Model& model, const ArticulatedBodies& bodies, const ExplicitTableau& tableau);

  /// Whether there are such coordinates. If not, nothing else may be called.
  bool any() const { return any_; }
  bool has_motions() const { return !motions_.empty(); }

  /// Begins a step: samples the motions over it, and chooses the dependent coordinates of loops. `released`, `rates`:
  /// at the beginning. Returns false if a loop is at a dead point.
  bool begin(double time, double step, std::vector<Released>& released, double* rates, ArticulatedBodies& bodies);
  /// Sets positions and rates of dependent coordinates at stage `stage` (or at the end, if that is the number of
  /// stages), and the bodies to them. `positions`: of the motions, by history. Returns false if a loop cannot be
  /// closed.
  bool place(std::size_t stage, const std::vector<double>& positions, std::vector<Released>& released, double* rates,
             ArticulatedBodies& bodies);
  /// Computes the derivatives of all rates, for bodies that place() has set and forces act on, and the efforts of the
  /// motions. `efforts`, `armatures`: per rate.
  void accelerate(std::size_t stage, const double* efforts, const double* armatures, ArticulatedBodies& bodies,
                  double* rates_change);
  /// The effort that drives a prescribed coordinate, given by its rate.
  double drive(int rate) const { return drives_[root_column_[rate]]; }
  /// Adds the forces that loop joints transmit to the bodies, and keeps them. To be called after accelerate(), when the
  /// bodies have been set anew to the same numbers.
  void add_closure_forces(ArticulatedBodies& bodies);
  /// Per closure: {force, moment about the node} on its child, world axes.
  const std::vector<Vector6>& closure_forces() const { return closure_forces_; }
  /// If the rates of motions jump at the beginning of a step, changes the others as the impulse of the drives does.
  /// `before`: rates so far. Returns the work of the impulse [J].
  double strike(const double* before, const double* armatures, ArticulatedBodies& bodies, double* rates);
  /// The largest violation of constraints that follow from the others, relative to the model's length or 1.
  double largest_opening(const ArticulatedBodies& bodies) const;

 private:
  struct Motion {
    int rate, joint, history;
    StageDerivatives::Samples samples;
  };
  struct Follower {
    int rate, joint, leader_rate, leader_joint;
    const MimicLaw* law;
  };
  /// A rate of a coordinate that loops may make dependent.
  struct Place {
    int joint, component;
  };
  double derivative(std::size_t stage, int order, const Motion& motion) const;
  void follow(std::vector<Released>& released, double* rates);
  void find_constraints(const ArticulatedBodies& bodies);
  double find_curvature(const LoopClosure& closure, const ClosureConstraint& constraint,
                        const ArticulatedBodies& bodies) const;
  void solve_loops(const Eigen::Ref<const Eigen::VectorXd>& given);
  void find_columns();
  void move(std::vector<Released>& released);

  const Model& model_;
  StageDerivatives derivatives_;
  bool any_ = false;
  int rates_, rows_ = 0;  // numbers of rates and of constraints
  std::vector<Motion> motions_;
  std::vector<Follower> followers_;
  // Roots are coordinates that follow none: first those of motions, then the others. Each rate is `factors_` times that
  // of its root.
  std::vector<int> root_column_;              // per rate
  std::vector<double> factors_;               // per rate
  std::vector<int> roots_;                    // rates of the roots, by column
  std::vector<int> dependent_, independent_;  // columns of roots that loops make dependent, and of the others
  std::vector<Place> places_;                 // per rate
  std::vector<Vector6> closure_forces_;
  double step_ = 0;
  Eigen::VectorXd values_, drives_, follower_bends_, bend_, needed_, forces_, change_, reduced_, right_, root_rates_;
  Eigen::MatrixXd rows_of_rates_, jacobian_, scaled_, block_, transfer_, columns_, mass_, moved_, small_;
  Eigen::PartialPivLU<Eigen::MatrixXd> loops_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> choice_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace flexarm
