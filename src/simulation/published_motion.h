#pragma once
/// Velocities and accelerations for output, computed on request: derivatives of the motion, without the oscillations of
/// the scheme's own velocities (docs/theory/time_integration.md, "Published velocities and efforts").

#include <array>
#include <vector>

#include "flexarm/model/results.h"
#include "joints/joint_map.h"
#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/time_rule.h"

namespace flexarm {

/// What functions of a state for output look at.
struct MotionView {
  const Model& model;
  const DegreesOfFreedom& dof;
  const TimeRule& rule;
  const State& state;
};

// ---------------------------------------------------------------- velocities

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

// ---------------------------------------------------------------- accelerations of points

// From where they were after the last steps.

/// Mean rates of a vector over the last steps, newest first, and how long these were.
struct MeanRates {
  static constexpr int kMost = 4;
  int count = 0;
  std::array<Vector3, kMost> rate;
  std::array<double, kMost> length;  ///< [s]; parts of a composed step may be negative

  /// The rate's own rate at the end of the newest step: of second order where the motion is smooth over four steps, and
  /// without what alternates from step to step. Zero where fewer than two steps are known. Invariant under rotations.
  Vector3 change_at_end() const;
};

/// The configurations after the last steps. They follow from the increments that the state remembers for the
/// predictor: nothing else is kept. Allocates only for another model than before.
class PastMotion {
 public:
  void update(const MotionView& view);
  ProbeAcceleration acceleration(const MotionView& view, const ProbePoint& point) const;

 private:
  void go_back(const MotionView& view, int step, double begin);

  int count_ = 0;
  std::array<double, MeanRates::kMost> length_{};
  State earlier_;                                       // nodes and released coordinates only
  std::vector<NodePose> poses_;                         // of earlier_
  std::array<State, MeanRates::kMost> configurations_;  // nodes only: at the beginnings of the steps, newest first
};

// ---------------------------------------------------------------- both

/// Keeps what was asked for until the state changes.
class PublishedMotion {
 public:
  void forget() { holds_rates_ = holds_velocities_ = holds_past_ = false; }
  bool holds_rates() const { return holds_rates_; }
  bool holds_velocities() const { return holds_velocities_; }
  bool holds_past() const { return holds_past_; }

  /// Those of coordinates alone.
  const OutputVelocities& rates(const MotionView& view) {
    if (!holds_rates_) velocities_.update_rates(view.model, view.dof, view.rule, view.state);
    holds_rates_ = true;
    return velocities_;
  }
  const OutputVelocities& velocities(const MotionView& view) {
    rates(view);
    if (!holds_velocities_) velocities_.update_nodes(view.model, view.dof, view.rule, view.state);
    holds_velocities_ = true;
    return velocities_;
  }
  const PastMotion& past(const MotionView& view) {
    if (!holds_past_) past_.update(view);
    holds_past_ = true;
    return past_;
  }

 private:
  OutputVelocities velocities_;
  PastMotion past_;
  bool holds_rates_ = false, holds_velocities_ = false, holds_past_ = false;
};

}  // namespace flexarm
