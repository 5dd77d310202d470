#pragma once
/// The potential of a mechanism as a function of its joint coordinates alone.

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "integrators/step_settings.h"
#include "integrators/step_system.h"
#include "joints/joint_stop.h"
#include "solver/sparse_tangent.h"

namespace flexarm {

/// The potential near a configuration, if beams follow the joints in equilibrium. Motions of coordinates, called ways,
/// are in rad, or in units of the model's length scale.
struct JointPotential {
  State state;                ///< the configuration
  Eigen::VectorXd force;      ///< gradient, per coordinate [J]
  Eigen::MatrixXd curvature;  ///< symmetric [J]
  /// The parts of `force` and of the diagonal of `curvature` that stops of the axes make, and their energy [J].
  Eigen::VectorXd stop_force, stop_curvature;
  double stop_energy = 0;
  Eigen::MatrixXd motions;     ///< of all unknowns; one column per coordinate, for a way of 1
  Eigen::VectorXd correction;  ///< Newton's step of beams while joints stand still
  /// Per unknown: the multipliers of loops that best balance the residual; zero for all other unknowns.
  Eigen::VectorXd multipliers;
};

/// Computes a JointPotential, and moves along it. With the unknowns b of beams, the coordinates q, and the static
/// tangent K,
///   curvature = K_qq - K_qb K_bb^-1 K_bq,   force = g_q - K_qb K_bb^-1 g_b.
/// If multipliers close loops, q contains as many coordinates as the loops leave free, chosen so that they determine
/// the other coordinates well. These and the multipliers belong to b, whose solution closes the loops. Then force and
/// curvature are the reduced gradient and Hessian of the constrained potential.
class JointPotentials {
 public:
  /// Whether there is a potential: no load is circulatory, there are at most a few hundred coordinates, and at least
  /// one of them is an unknown.
  static bool exist(const Model& model, const State& state);

  /// `scheme`: made by statics_of(), with an interpolation that does not depend on the past. `model` and `settings`
  /// must outlive this object.
  JointPotentials(const Model& model, const Scheme& scheme, const StepSettings& settings);

  /// A joint coordinate that is an unknown.
  struct Axis {
    int equation;
    std::size_t coordinate;
    double scale;  ///< way per unit of the coordinate: 1, or 1/m
  };
  /// A stop of a coordinate, or of one that follows it. All values are in the unit of the coordinate.
  struct Bound {
    std::size_t axis;
    double place, inward;  ///< inward: 1 if the stop acts above the place, -1 below it
    double stiffness, give;
  };
  const std::vector<Axis>& axes() const { return axes_; }
  const std::vector<Bound>& bounds() const { return bounds_; }
  /// Whether the axes are the only unknowns.
  bool is_rigid() const { return axes_.size() == static_cast<std::size_t>(system_.degrees_of_freedom().unknowns); }
  /// Position of an axis; 0 for a component of a free rotation.
  double position(const State& state, std::size_t axis) const;

  /// Largest curvature that weight and loads make; without these, the largest moment of the residual; if nothing acts,
  /// the largest stiffness of a coordinate, or 1 if there is none [J].
  double reference() const { return reference_; }
  /// Chooses the axes and reference() for this state. Returns false if nothing can move there, or if something is not
  /// finite.
  bool begin(const State& state);
  /// Chooses the axes of loops anew, and their bounds. Returns true if the axes have changed.
  bool choose_axes(const State& state);

  /// Computes all members of `at` from its state. Returns false if the tangent is not finite, or singular.
  bool look(JointPotential& at);
  /// Moves the joints by `ways` from there, and beams with them. Then brings the beams to rest. Returns false if that
  /// fails, or if bodies that may touch would pass through each other.
  bool move(const JointPotential& from, const Eigen::VectorXd& ways, State& to, StepResult& result);
  /// Brings beams to rest under `factor` times the loads, while joints are held. Returns false if that fails.
  bool rest(State& state, double factor, StepResult& result);
  /// Makes one step of Newton's method along `ways`, with the correction of beams. Returns its UnknownScales::norm(),
  /// infinite if it fails.
  double shift(const JointPotential& from, const Eigen::VectorXd& ways, State& to);
  /// The ways of coordinates between two configurations.
  Eigen::VectorXd ways(const State& from, const State& to) const;
  /// For each motion of the coordinates (a column): by how much round-off may change its force and curvature [J].
  /// `curvature`: that of `at`, with or without stops.
  Eigen::VectorXd round_off(const JointPotential& at, const Eigen::MatrixXd& curvature,
                            const Eigen::MatrixXd& motions) const;
  /// The part of round_off() by weight and loads alone.
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
  std::vector<std::size_t> independent(const State& state) const;
  void find_bounds();
  void add_bounds(std::size_t axis, std::size_t coordinate);
  void add_stops(JointPotential& at) const;
  bool find_reference(const State& state);

  const Model& model_;
  const Scheme scheme_;
  const StepSettings& settings_;
  StepSystem system_;
  std::vector<Axis> coordinates_;  // all that are unknowns
  std::vector<Axis> axes_;
  /// A coordinate with stops that is an axis, or follows one.
  struct Stopped {
    std::size_t axis, coordinate;
    double multiplier;  // of the axis
  };
  std::vector<Stopped> stopped_;
  std::vector<Bound> bounds_;     // of these
  std::vector<int> multipliers_;  // their equations
  double reference_ = 0;
};

}  // namespace flexarm
