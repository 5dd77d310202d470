#pragma once
/// Finds equilibria as minima of the potential.

#include <string>
#include <vector>

#include "analysis/joint_potential.h"
#include "analysis/touched_stops.h"

namespace flexarm {

/// How an equilibrium is held in its joint coordinates.
struct JointHold {
  std::vector<std::size_t> free;  ///< coordinates that nothing holds: neither force nor curvature is above round-off
  std::size_t weakest = 0;        ///< the held coordinate that round-off of forces may move farthest
  double weakness = 0;            ///< by how much it may move that [rad or m]
  double least = 0;               ///< smallest curvature of held motions, relative to what weight and loads make

  /// Whether no motion is so soft that Newton's method might fail.
  bool is_firm() const;
};

/// How joints are held in an equilibrium. Empty if loads have no potential.
JointHold joint_hold(const Model& model, const State& equilibrium);

/// Descends the potential in the joint coordinates. Steps are within a trust region, in the motions that diagonalise
/// the curvature (More and Sorensen 1983): Newton's steps where the curvature is positive, and steps along negative
/// curvature. If a coordinate comes to a stop or leaves one, its part of the step ends there, and the other coordinates
/// go on. Where it comes to rest, motions to both sides are tried along negative curvature, with each set of the
/// coordinates that may leave their stops. Motions whose force and curvature are both below round-off are left out, so
/// that coordinates which nothing holds stay where they are.
class Descent {
 public:
  /// See JointPotentials; exist() must be true.
  Descent(const Model& model, const Scheme& scheme, const StepSettings& settings);

  /// Descends from `state` to a minimum; beams first come to rest while loads grow in `load_steps` steps. Returns false
  /// if there is no minimum on the way down; then `result` says why, and `state` is where it was given up. If the loads
  /// move a coordinate without limit, it is the place of the failure.
  bool find(State& state, int load_steps, StepResult& result);
  /// Brings beams to rest under all loads, while joints stay where they are.
  bool rest(State& state, StepResult& result);
  /// Whether joint coordinates are the only unknowns.
  bool is_rigid() const { return potentials_.is_rigid(); }
  /// Improves a minimum to round-off, by Newton's method, as long as its steps become shorter.
  bool sharpen(State& state);
  /// Finds out how joints are held in an equilibrium. Returns false if that cannot be computed.
  bool judge(const State& equilibrium, JointHold& hold);
  /// Finds the multipliers of an equilibrium, see JointPotential. Returns false if that fails.
  bool find_multipliers(const State& equilibrium, Eigen::VectorXd& multipliers);
  /// The first unstable equilibrium that find() has passed; null if there was none.
  const State* left() const { return has_left_ ? &left_ : nullptr; }

 private:
  /// Motions of the coordinates that diagonalise the curvature. Stiff coordinates have a larger weight in their norm.
  struct Modes {
    Eigen::VectorXd curvature, force, round_off;
    Eigen::MatrixXd motions;  // columns: motions of the coordinates
    bool is_flat(Eigen::Index i) const {
      return std::abs(curvature[i]) <= round_off[i] && std::abs(force[i]) <= round_off[i];
    }
    /// Length of Newton's step along motion i.
    double way(Eigen::Index i) const { return std::abs(force[i]) / std::max(std::abs(curvature[i]), round_off[i]); }
  };
  struct Step {
    Eigen::VectorXd ways;
    double length = 0;           // in the norm of the modes
    double promise = 0;          // predicted fall of the potential, by the quadratic model
    bool has_two_sides = false;  // goes along negative curvature without a force
  };

  /// How a step is looked for.
  struct Search {
    double radius;
    double side = 1;  // along negative curvature that has no force
    double weak = 0;  // forces along negative curvature that count as none [J]
  };
  using AxisSet = std::vector<std::size_t>;

  bool begin(const State& state);
  Modes modes(const JointPotential& at, const Eigen::VectorXd& force, const Eigen::MatrixXd& curvature,
              const std::vector<bool>& is_fixed);
  Modes modes(const JointPotential& at);
  Modes modes(const JointPotential& at, const TouchedStops& stops);
  static Eigen::VectorXd step_in(const Modes& modes, const Search& search, bool& has_two_sides);
  Step step_from(const JointPotential& at, const TouchedStops& stops, const Search& search);
  Step best_step(const JointPotential& at, TouchedStops& stops, double radius);
  bool rests(const JointPotential& at, const TouchedStops& stops);
  bool take(JointPotential& at, const Step& step, double& share, StepResult& result);
  bool follow_valley(JointPotential& at, TouchedStops& stops, StepResult& result);
  bool take_and_sink(JointPotential& at, const Step& step, StepResult& result);
  bool step_out(JointPotential& at, const Step& step, StepResult& result);
  bool is_stiff(const Modes& modes, Eigen::Index i) const;
  bool sink(StepResult& result);
  bool descend(JointPotential& at, StepResult& result);
  bool leave(JointPotential& at, TouchedStops& stops, StepResult& result);
  std::vector<AxisSet> unstable_sets(const JointPotential& at, TouchedStops& stops);
  std::vector<Step> ways_out(const JointPotential& at, TouchedStops& stops, const std::vector<AxisSet>& sets,
                             double radius);
  void polish(const JointPotential& at, State& state);
  void find_unheld(const State& start, const State& end, StepResult& result);

  JointPotentials potentials_;
  double tolerance_;
  JointPotential next_, sunk_;  // where steps lead
  State left_;
  bool has_left_ = false;
};

}  // namespace flexarm
