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

/// The arguments of functions that compute output from a state.
struct MotionView {
  const Model& model;
  const DegreesOfFreedom& dof;
  const TimeRule& rule;
  const State& state;
};

// ---------------------------------------------------------------- velocities

/// Lengths of the last steps, newest first. Converts mean rates in these steps to the rate at the end of the newest
/// one.
struct LastSteps {
  static constexpr int kMost = 5;
  int count = 2;                       ///< at least two
  std::array<double, kMost> length{};  ///< [s]; parts of a composed step may be negative

  /// Mean rates of a quantity of Size 1 or 3 in these steps: increments over lengths, newest first.
  template <int Size>
  using MeanRates = std::array<Eigen::Matrix<double, Size, 1>, kMost>;
  /// The rate at the end of the newest step. It is of third order if the motion is smooth: the slopes of the rate agree
  /// over four steps or, around an extremum of the rate, its curvatures over five. Otherwise it is the mean rate of the
  /// newest step. Invariant under rotations. Soon after the start, when fewer steps are known, three or two are used.
  template <int Size>
  Eigen::Matrix<double, Size, 1> rate_at_end(const MeanRates<Size>& mean) const;
};

/// Velocities of a state, for output. They are computed from the increments that the state stores for the predictor, so
/// that nothing else has to be kept from step to step. At the start and after the first step they are the scheme's own
/// velocities. Allocates memory only if the model changes.
class OutputVelocities {
 public:
  void update_rates(const Model& model, const DegreesOfFreedom& dof, const TimeRule& rule, const State& state);
  /// Call update_rates() for the same state first.
  void update_nodes(const Model& model, const DegreesOfFreedom& dof, const TimeRule& rule, const State& state);

  /// Per node: {v, w}, world axes [m/s, rad/s].
  const std::vector<Vector6>& nodes() const { return nodes_; }
  /// Rate of a released coordinate [rad/s or m/s].
  double rate(const Coordinate& coordinate) const { return rates_[coordinate.joint][coordinate.component]; }

 private:
  void set_poses(const State& state);
  void set_scheme_velocities(const State& state);
  void set_free_nodes(const DegreesOfFreedom& dof, const TimeRule& rule, const State& state);
  void set_rates(const Model& model, const DegreesOfFreedom& dof, const TimeRule& rule, const State& state);
  void set_slaves(const Model& model, const State& state);

  bool has_steps_ = false;  ///< enough steps are known; otherwise the scheme's own velocities are used
  LastSteps steps_;
  std::vector<NodePose> poses_;
  std::vector<Vector6> nodes_;
  std::vector<ReleasedVector> rates_;  // per joint
};

// ---------------------------------------------------------------- accelerations of points

// They are computed from positions and orientations after the last steps.

/// Mean rates of a vector in the last steps, and the lengths of these steps, newest first.
struct MeanRates {
  static constexpr int kMost = 4;
  int count = 0;
  std::array<Vector3, kMost> rate;
  std::array<double, kMost> length;  ///< [s]; parts of a composed step may be negative

  /// The rate's derivative at the end of the newest step. It is of second order if the motion is smooth over four
  /// steps, and contains nothing that alternates from step to step. Zero if fewer than two steps are known. Invariant
  /// under rotations.
  Vector3 change_at_end() const;
};

/// The configurations at the beginnings of the last steps. They are computed from the increments that the state stores
/// for the predictor: nothing else is kept. Allocates memory only if the model changes.
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

// ---------------------------------------------------------------- velocities and past configurations

/// Computes velocities and past configurations when they are first requested, and keeps them until the state changes.
class PublishedMotion {
 public:
  void forget() { holds_rates_ = holds_velocities_ = holds_past_ = false; }
  bool holds_rates() const { return holds_rates_; }
  bool holds_velocities() const { return holds_velocities_; }
  bool holds_past() const { return holds_past_; }

  /// Only the rates of coordinates are valid in the result.
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
