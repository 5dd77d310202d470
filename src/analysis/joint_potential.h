#pragma once
/// The potential of a mechanism as a function of its joint coordinates alone.

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "integrators/step_settings.h"
#include "integrators/step_system.h"
#include "solver/sparse_tangent.h"

namespace flexarm {

/// What the potential does about a configuration while beams follow the joints in equilibrium. Ways of coordinates
/// count in rad, or over the model's length scale.
struct JointPotential {
  State state;                 ///< the configuration
  Eigen::VectorXd force;       ///< gradient, per coordinate [J]
  Eigen::MatrixXd curvature;   ///< symmetric [J]
  Eigen::MatrixXd motions;     ///< of all unknowns, a column per coordinate, for a way of 1
  Eigen::VectorXd correction;  ///< Newton's step of beams while joints stand
  /// Of all unknowns: multipliers of loops that balance what they are found with, others zero.
  Eigen::VectorXd multipliers;
};

/// Looks at JointPotential, and moves along it. With b the unknowns of beams, q the coordinates, and K the static
/// tangent,
///   curvature = K_qq - K_qb K_bb^-1 K_bq,   force = g_q - K_qb K_bb^-1 g_b.
/// Where multipliers close loops, q are as many coordinates as loops leave, those by which the others are found best;
/// the others and the multipliers are among b, whose solution closes the loops: these are the reduced gradient and
/// Hessian of the constrained potential.
class JointPotentials {
 public:
  /// Whether there is a potential: no load circulates, and at most a few hundred coordinates are not prescribed.
  static bool exist(const Model& model, const State& state);

  /// `scheme`: made by statics_of(), with interpolation that knows no past. Both references must outlive this.
  JointPotentials(const Model& model, const Scheme& scheme, const StepSettings& settings);

  /// Of the unknowns.
  struct Axis {
    int equation;
    std::size_t coordinate;
    double scale;  ///< way per unit of the coordinate: 1, or 1/m
  };
  /// A stop of a coordinate or of one that follows it, in the coordinate's own unit.
  struct Bound {
    std::size_t axis;
    double place, inward;  ///< inward: 1 where the coordinate is stopped above the place, -1 below it
    double stiffness, give;
  };
  const std::vector<Axis>& axes() const { return axes_; }
  const std::vector<Bound>& bounds() const { return bounds_; }
  /// There are no other unknowns.
  bool is_rigid() const { return axes_.size() == static_cast<std::size_t>(system_.degrees_of_freedom().unknowns); }
  /// Of an axis; of a free rotation, 0.
  double position(const State& state, std::size_t axis) const;

  /// Largest curvature that weight and loads make, or what stands for it [J]; 0: nothing acts.
  double reference() const { return reference_; }
  /// Chooses it, and the axes. False if nothing moves there, or something is not finite.
  bool begin(const State& state);
  /// Chooses the axes of loops anew, and their bounds. True if these are other ones.
  bool choose_axes(const State& state);

  /// Fills in everything but the state, which is given. False if the tangent is not finite, or singular.
  bool look(JointPotential& at);
  /// Moves the joints by `ways` from there, beams after them, and lets these come to rest. False if they do not.
  bool move(const JointPotential& from, const Eigen::VectorXd& ways, State& to, StepResult& result);
  /// Loads times `factor` act on beams, while joints are held where they are. False if these do not come to rest.
  bool rest(State& state, double factor, StepResult& result);
  /// One step of Newton's method along `ways`, with the correction; returns its UnknownScales::norm(), infinite where
  /// it fails.
  double shift(const JointPotential& from, const Eigen::VectorXd& ways, State& to);
  /// Ways of coordinates between two configurations.
  Eigen::VectorXd ways(const State& from, const State& to) const;
  /// Of forces and curvatures along motions of the coordinates, columns: what round-off may make of them [J].
  Eigen::VectorXd round_off(const JointPotential& at, const Eigen::MatrixXd& motions) const;
  /// The same, by weight and loads alone.
  double round_off_of_loads(const Eigen::VectorXd& motion) const;

 private:
  using Matrix = Eigen::Map<const Eigen::SparseMatrix<double>>;
  const SparseTangent& tangent() const { return system_.tangent().matrix(); }
  void hold_joints();
  bool rest(State& state, double factor, double largest_rotation, StepResult& result);
  Eigen::VectorXd step(const JointPotential& from, const Eigen::VectorXd& ways) const;
  bool place(const JointPotential& from, const Eigen::VectorXd& step, State& to);
  bool find_multipliers(JointPotential& at);
  Matrix tangent_matrix() const;
  std::vector<std::size_t> independent() const;
  void find_bounds();
  void add_bounds(std::size_t axis, const Coordinate& coordinate, double multiplier, double offset);

  const Model& model_;
  const Scheme scheme_;
  const StepSettings& settings_;
  StepSystem system_;
  std::vector<Axis> coordinates_;  // all that nothing prescribes
  std::vector<Axis> axes_;
  std::vector<Bound> bounds_;
  std::vector<int> multipliers_;  // equations
  double reference_ = 0;
};

}  // namespace flexarm
