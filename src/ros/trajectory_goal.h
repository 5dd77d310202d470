#pragma once
/// Whether joints do what a trajectory asks of them.

#include <cstddef>
#include <string>
#include <vector>

#include "control_types.h"
#include "stepping/trajectory_follower.h"

namespace flexarm::node {

/// How far a joint may be from where it is to be; 0 or less: as far as it likes.
struct JointTolerance {
  double position = 0, velocity = 0;  ///< [rad or m; over s]
};

/// Why tolerances cannot be those of a trajectory of joints with these names, or nothing.
std::string fault_of_tolerances(const std::vector<control::JointTolerance>& given,
                                const std::vector<std::string>& names);
/// One for each of the `joints`, which may be others than the trajectory names: one without points stops those that
/// move. Of who does not move none is kept.
std::vector<JointTolerance> tolerances_of(const std::vector<control::JointTolerance>& given,
                                          const std::vector<std::string>& joints);

/// What somebody wants to be told about.
struct TrajectoryGoal {
  enum class Verdict { Underway, Reached, OffPath, NotReached };
  struct Judgement {
    Verdict verdict = Verdict::Underway;
    std::size_t joint = 0;          ///< of the goal, that is off its path or not where it is to be
    const char* quantity = "";      ///< "position" or "velocity"
    double error = 0, allowed = 0;  ///< of that quantity
  };

  std::vector<std::size_t> joints;
  std::vector<JointTolerance> path, at_end;  ///< per joint
  double end = 0;                            ///< of its trajectory [s]
  double patience = 0;                       ///< how long after that joints may still be beyond their tolerances [s]

  /// `desired`, `actual`: of each of its joints, at `time` [s].
  /// @throws std::invalid_argument if any of these has not as many entries as joints
  Judgement judge(double time, const std::vector<JointPoint>& desired, const std::vector<JointPoint>& actual) const;
};

}  // namespace flexarm::node
