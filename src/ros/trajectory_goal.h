#pragma once
/// Judges whether joints follow the trajectory of a goal within its tolerances.

#include <cstddef>
#include <string>
#include <vector>

#include "control_types.h"
#include "stepping/trajectory_follower.h"

namespace flexarm::node {

/// Allowed deviations of a joint; 0 or less: no limit.
struct JointTolerance {
  double position = 0, velocity = 0;  ///< [rad or m]; [rad/s or m/s]
};

/// Why these tolerances do not fit a trajectory of the joints `names`, or "".
std::string fault_of_tolerances(const std::vector<control::JointTolerance>& given,
                                const std::vector<std::string>& names);
/// One tolerance for each of the `joints`; joints without a given tolerance have no limits. `joints` may differ from
/// those that the trajectory names: a trajectory without points stops all joints that move.
std::vector<JointTolerance> tolerances_of(const std::vector<control::JointTolerance>& given,
                                          const std::vector<std::string>& joints);

/// What the followed trajectory must meet.
struct TrajectoryGoal {
  enum class Verdict { Underway, Reached, OffPath, NotReached };
  struct Judgement {
    Verdict verdict = Verdict::Underway;
    std::size_t joint = 0;          ///< index in the goal's `joints` of the one that exceeds its tolerance
    const char* quantity = "";      ///< "position" or "velocity"
    double error = 0, allowed = 0;  ///< of that quantity
  };

  std::vector<std::size_t> joints;
  std::vector<JointTolerance> path, at_end;  ///< per joint
  double end = 0;                            ///< when the trajectory ends [s]
  double patience = 0;                       ///< how long after `end` joints may still exceed their tolerances [s]

  /// @param time     [s]
  /// @param desired  of each of the goal's joints, at `time`; `actual` likewise
  /// @throws std::invalid_argument if a vector does not have one entry for each joint
  Judgement judge(double time, const std::vector<JointPoint>& desired, const std::vector<JointPoint>& actual) const;
};

}  // namespace flexarm::node
