#pragma once
/// Steps of explicit Runge-Kutta methods, for rigid links. (docs/notes/explicit.md)

#include <vector>

#include "flexarm/model/results.h"
#include "integrators/dependent_rates.h"
#include "integrators/explicit_events.h"
#include "integrators/explicit_motors.h"
#include "integrators/explicit_reactions.h"
#include "integrators/explicit_rotors.h"
#include "joints/articulated_bodies.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Limit for the violation of a loop's implied constraints: far above the errors of Newton and of rounded input.
constexpr double kOpenLoop = 1e-4;

/// Integrates the released coordinates, their rates, the integrals of servos, the angles and rates of rotors behind
/// elastic gears, and the work and the dissipation that the state adds up. Allocates no memory after construction.
class ExplicitStep {
 public:
  /// The model must outlive the step.
  /// @throws ModelError naming what explicit schemes cannot simulate, if the model has some of it
  ExplicitStep(const Model& model, const Scheme& scheme);

  /// Advances the state by a step [s], in pieces that end at events (ExplicitEvents). Returns why it cannot, and
  /// leaves the state as it was then: numbers are no longer finite, or a loop is at a dead point or opens. `reuses`:
  /// the step may use accelerations that the last step computed at its end. Without it, a run that continues from a
  /// restored state has the same bits.
  StepResult::Reason advance(State& state, double step, bool reuses);

  /// Derivatives of the rates of all joints with respect to efforts on them, at a state: the inverse of the mass
  /// matrix, or what loops, mimics and motions leave of it. `step`: of samples of motions [s]. Empty if a loop is at a
  /// dead point. Forgets what was known from the last step; allocates memory.
  Eigen::MatrixXd mobility(const State& state, double step);
  /// The index of a coordinate's rate; -1: it is held.
  int rate_of(const Coordinate& coordinate) const;

 private:
  struct Joint {
    int first_position, first_rate;
    JointMapKind kind;
  };
  /// Makes a step from the state, which stays as it is. `goes_on`: the last step ended there. `keeps_contacts`: stops
  /// push as in the last attempt; else, as they do in the state.
  StepResult::Reason attempt(const State& state, double step, bool goes_on, bool keeps_contacts);
  /// Attempts shorter steps, until one ends just behind the first event. `whole`: the
  /// step of the caller; `length`: of the last attempt, before and after [s].
  StepResult::Reason end_at_event(const State& state, double whole, double& length);
  /// Attempts the rest of a step, or its first piece.
  StepResult::Reason attempt_piece(const State& state, double whole, double rest, bool goes_on, double& length);
  /// Attempts the rest of a step with stops that push where they are penetrated.
  StepResult::Reason attempt_freely(const State& state, double rest, double& length);
  /// Takes the state to the end of the last attempt.
  void accept(State& state, double step);
  void pack(const State& state);
  void unpack(const std::vector<double>& numbers);
  /// Finds what depends on time at a part of a step, which is that of a stage or of the end.
  void find_inputs(const State& state, double step, std::size_t stage);
  void find_values(double begin, double step, double part);
  /// Computes derivatives at a stage, or at the end, which follows the last stage. Sets dependent coordinates among the
  /// numbers. Returns false if a loop cannot be closed.
  bool evaluate(const State& state, std::size_t stage, std::vector<double>& numbers, std::vector<double>& change);
  bool place(std::size_t stage, std::vector<double>& numbers);
  void accelerate(std::size_t stage, const double* efforts, std::vector<double>& change);
  bool begin_dependent(const State& state, double step, double& work);
  void find_efforts(const State& state, const std::vector<double>& numbers, std::vector<double>& change);
  bool strike(const State& state, std::size_t stage, std::vector<double>& numbers);
  void add_drives(const double* rates, std::vector<double>& change);
  void add_loads(const State& state, std::vector<double>& change);
  void add_passive(std::size_t coordinate, const ExplicitRotors::Motion& link, std::vector<double>& change);
  void drive(std::size_t actuator, const State& state, const ExplicitRotors::Motion& link,
             const std::vector<double>& numbers, std::vector<double>& change, double& applied);
  ExplicitRotors::Motion link_motion(std::size_t coordinate, const std::vector<double>& numbers) const;
  bool find_impulses(const State& state, std::size_t stage);
  double half_work_on_rotors(const std::vector<double>& numbers) const;
  void normalise(std::vector<double>& numbers) const;
  void write_positions(std::vector<double>& numbers) const;
  bool is_as_left(const State& state) const;
  bool acts_as_before(const State& state) const;
  void write(State& state, double step);
  void write_actuators(State& state, double step);
  void write_reactions(State& state);

  const Model& model_;
  const ExplicitTableau& tableau_;
  ArticulatedBodies bodies_;
  DependentRates dependent_;
  ExplicitMargins margins_;
  ExplicitMotors motors_;
  ExplicitRotors rotors_;
  ExplicitReactions reactions_;
  // Places among the margins, per coordinate and per actuator.
  std::vector<int> limits_, plays_, rubbing_joints_, rubbing_rotors_;
  ExplicitEvents events_;
  std::vector<Joint> joints_;
  std::vector<int> places_;  // per coordinate: its rate; -1: it is held
  std::vector<NodePose> poses_;
  std::vector<Vector6> velocities_;
  std::vector<Released> released_;
  std::vector<double> efforts_, no_efforts_, applied_, armatures_;  // per rate; `applied_`: per coordinate, not passive
  std::vector<double> impulses_;                                    // per actuator
  /// Positions of all joints, their rates, work, dissipation, integrals of servos, unknowns of rotors: at the
  /// beginning, and at a stage or the end.
  std::vector<double> begin_, stage_, before_;
  std::vector<std::vector<double>> changes_;  // per stage
  std::vector<double> last_change_, last_commands_;
  double gained_work_ = 0, lost_ = 0;  // in the last attempt [J]
  State kept_;                         // at the beginning of a step in pieces
  std::size_t rates_ = 0, work_ = 0, integrals_ = 0,
              own_ = 0;                       // where the rates, work and dissipation, and so on begin
  std::vector<int> varying_;                  // functions of time that are not constant
  std::vector<double> values_, last_values_;  // of all functions of time: now, and at the end of the last step
  double last_time_ = 0;
  std::vector<NodeState> last_nodes_;  // as they were left; empty: there was no step
};

}  // namespace flexarm
