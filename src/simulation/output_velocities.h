#pragma once
/// Velocities for output: derivatives of the motion, free of what rings in the scheme's own velocities (theory.md,
/// "Published velocities and efforts").

#include <array>
#include <vector>

#include "joints/joint_map.h"
#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/time_rule.h"

namespace flexarm {

/// Lengths of the last steps, newest first: what turns mean rates of these steps into the rate at the end.
struct LastSteps {
  static constexpr int kMost = 4;
  int count = 2;                       ///< at least two
  std::array<double, kMost> length{};  ///< [s]; parts of a composed step may be negative

  /// Mean rates of a quantity of Size 1 or 3 in these steps: increments over lengths, newest first.
  template <int Size>
  using MeanRates = std::array<Eigen::Matrix<double, Size, 1>, kMost>;
  /// The rate at the end of the newest step: of third order where the motion is smooth over four steps, else the mean
  /// of the newest step, which is of second order where the rate has an extremum. Invariant under rotations. Right
  /// behind the start, where fewer steps are known, three are asked or two.
  template <int Size>
  Eigen::Matrix<double, Size, 1> rate_at_end(const MeanRates<Size>& mean) const;
};

/// Velocities of a state. They follow from the increments that the state remembers for the predictor: nothing else is
/// kept from step to step. At the start and after the first step they are the scheme's own. Allocates only for another
/// model than before.
class OutputVelocities {
 public:
  void update_rates(const Model& model, const DegreesOfFreedom& dof, const TimeRule& rule, const State& state);
  /// After update_rates() of the same state.
  void update_nodes(const Model& model, const DegreesOfFreedom& dof, const TimeRule& rule, const State& state);

  /// Per node: {v, w}, world axes [m/s, rad/s].
  const std::vector<Vector6>& nodes() const { return nodes_; }
  /// Of a released coordinate [rad/s or m/s].
  double rate(const Coordinate& coordinate) const { return rates_[coordinate.joint][coordinate.component]; }

 private:
  void set_poses(const State& state);
  void set_scheme_velocities(const State& state);
  void set_free_nodes(const DegreesOfFreedom& dof, const TimeRule& rule, const State& state);
  void set_rates(const Model& model, const DegreesOfFreedom& dof, const TimeRule& rule, const State& state);
  void set_slaves(const Model& model, const State& state);

  bool has_steps_ = false;  ///< that tell more than the scheme's own velocities
  LastSteps steps_;
  std::vector<NodePose> poses_;
  std::vector<Vector6> nodes_;
  std::vector<ReleasedVector> rates_;  // per joint
};

}  // namespace flexarm
