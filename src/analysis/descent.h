#pragma once
/// Minima of the potential.

#include <string>
#include <vector>

#include "analysis/joint_potential.h"

namespace flexarm {

/// How an equilibrium is held in its joint coordinates.
struct JointHold {
  std::vector<std::size_t> free;  ///< coordinates that nothing holds: neither force nor curvature is above round-off
  std::size_t weakest = 0;        ///< the coordinate that round-off of forces may move farthest
  double weakness = 0;            ///< by so much, of those that are held [rad or m]
  double least = 0;               ///< curvature of those that are held, beside what weight and loads make

  /// No motion is so soft that Newton's method might lose its way in it.
  bool is_firm() const;
};

/// How joints are held in an equilibrium. Empty if loads have no potential. `contact_time`: of stops [s].
JointHold joint_hold(const Model& model, double contact_time, const State& equilibrium);

/// Goes down the potential in the joint coordinates, by steps within a trust region in the motions that diagonalise
/// the curvature (More and Sorensen 1983): Newton's where that is positive, along negative curvature where it is not. A
/// step ends where a coordinate comes to a stop or leaves one, and goes on in the others. Motions whose force and
/// curvature are both below round-off are left out: what nothing holds stays where it is.
class Descent {
 public:
  /// See JointPotentials; exist() must be true.
  Descent(const Model& model, const Scheme& scheme, const StepSettings& settings);

  /// Descends from `state` to a minimum; beams first come to rest while loads grow in `load_steps` steps. Returns false
  /// if there is no minimum on the way down; then `result` says why, and `state` is where it was given up.
  bool find(State& state, int load_steps, StepResult& result);
  /// Beams come to rest about joints that stay where they are, under all loads.
  bool rest(State& state, StepResult& result);
  /// There are no unknowns but joint coordinates.
  bool is_rigid() const { return potentials_.is_rigid(); }
  /// From a minimum to round-off: as long as Newton's steps become shorter.
  bool sharpen(State& state);
  /// At an equilibrium. False if it cannot be looked at.
  bool judge(const State& equilibrium, JointHold& hold);
  /// Of an equilibrium, see JointPotential. False if they are not found.
  bool find_multipliers(const State& equilibrium, Eigen::VectorXd& multipliers);
  /// The first unstable equilibrium that find() has left; null: it met none.
  const State* left() const { return has_left_ ? &left_ : nullptr; }

 private:
  /// Motions of the coordinates that diagonalise the curvature; stiff coordinates count for more.
  struct Modes {
    Eigen::VectorXd curvature, force, round_off;
    Eigen::MatrixXd motions;  // of coordinates, columns
    bool is_flat(Eigen::Index i) const {
      return std::abs(curvature[i]) <= round_off[i] && std::abs(force[i]) <= round_off[i];
    }
    /// Newton's way along motion i.
    double way(Eigen::Index i) const { return std::abs(force[i]) / std::max(std::abs(curvature[i]), round_off[i]); }
  };
  struct Step {
    Eigen::VectorXd ways;
    double length = 0;   // in the modes' measure
    double promise = 0;  // fall of the potential by the quadratic model
  };

  bool begin(const State& state);
  Modes modes(const JointPotential& at, const std::vector<bool>& is_fixed, const Eigen::VectorXd& ways);
  static Eigen::VectorXd step_in(const Modes& modes, double radius);
  Step step_from(const JointPotential& at, double radius);
  bool stop_at_bound(const JointPotential& at, std::vector<bool>& is_fixed, Eigen::VectorXd& ways) const;
  static bool rests(const Modes& modes, double tolerance);

  JointPotentials potentials_;
  double tolerance_;
  State left_;
  bool has_left_ = false;
};

}  // namespace flexarm
