#pragma once
/// Steps of explicit Runge-Kutta methods, for trees of rigid links. (docs/notes/explicit.md)

#include <vector>

#include "joints/articulated_bodies.h"
#include "joints/joint_stop.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Integrates the released coordinates, their rates, and the work and the dissipation that the state adds up. Allocates
/// no memory after construction.
class ExplicitStep {
 public:
  /// The model must outlive the step.
  /// @throws ModelError naming what explicit schemes cannot simulate, if the model has some of it
  ExplicitStep(const Model& model, const Scheme& scheme);

  /// Advances the state by a step [s]. Returns false, and leaves the state as it was, if numbers are no longer finite.
  /// `reuses`: a step may begin with what the last one knew at its end. If not, a run that continues from a restored
  /// state is the same bit for bit.
  bool advance(State& state, double step, bool reuses);

 private:
  struct Joint {
    int first_position, first_rate;
    JointMapKind kind;
  };
  void pack(const State& state);
  void unpack(const std::vector<double>& numbers);
  void evaluate(const State& state, double time, const std::vector<double>& numbers, std::vector<double>& change);
  void find_efforts(const State& state, double time, const double* rates, std::vector<double>& change);
  void add_loads(const State& state, double time, std::vector<double>& change);
  void add_load(const NodalLoad& load, double scale, std::vector<double>& change);
  void normalise(std::vector<double>& numbers) const;
  bool is_as_left(const State& state) const;
  bool acts_as_before(const State& state) const;
  void write(State& state, double time);

  const Model& model_;
  const ExplicitTableau& tableau_;
  ArticulatedBodies bodies_;
  std::vector<Joint> joints_;
  std::vector<StopPenalty> penalties_;  // per coordinate
  std::vector<NodePose> poses_;
  std::vector<Vector6> velocities_;
  std::vector<Released> released_;
  std::vector<double> efforts_, applied_, armatures_;  // per rate; `applied_`: per coordinate, without passive ones
  /// Positions of all joints, their rates, work, dissipation: at the beginning, and at a stage or the end.
  std::vector<double> begin_, stage_;
  std::vector<std::vector<double>> changes_;  // per stage
  std::vector<double> last_change_, last_commands_;
  std::size_t rates_ = 0, work_ = 0;  // where the rates, and work and dissipation, begin
  double last_time_ = 0;
  std::vector<NodeState> last_nodes_;  // as they were left; empty: there was no step
};

}  // namespace flexarm
