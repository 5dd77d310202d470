#pragma once
/// The thread that steps the simulation at the pace of the wall clock.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "flexarm/accuracy/companion.h"
#include "flexarm/simulation/simulation.h"
#include "flexarm/simulation/spsc_ring.h"
#include "grips.h"
#include "pacer.h"
#include "renumbering.h"
#include "semaphore.h"
#include "stepped_time.h"
#include "timed_commands.h"
#include "trajectory_follower.h"
#include "wrench_schedule.h"

namespace flexarm::node {

/// How fast the simulation is stepped.
struct Pace {
  double real_time_factor = 1;   ///< simulated time / wall time; 0: as fast as possible
  double max_catch_up = 0.1;     ///< largest backlog that is caught up, in wall time [s]; the rest is dropped
  bool lock_step = false;        ///< each step waits for a message that commands it, independent of wall time
  bool cuts_late_steps = false;  ///< a step that ran out of time (recovery_wall_time) does not count as failed
  double error_window = 0;       ///< window of the Companion that estimates errors [s]; 0: no estimate

  /// Simulated time per second of message stamps. It is 1 if stamps are simulated times themselves (`are_simulated`),
  /// or if simulated time has no fixed ratio to wall time.
  double per_stamp(bool are_simulated) const {
    return are_simulated || lock_step || real_time_factor == 0 ? 1 : real_time_factor;
  }
};

/// The outcome of a step, for publishers.
struct StepReport {
  Snapshot state;  ///< after the step, or after its last good sub-step
  StepResult result;
  bool has_failed = false;
  std::uint64_t steps = 0;     ///< number of steps since the beginning
  double time = 0;             ///< simulated time since the beginning, which resets do not set back [s]
  std::uint64_t overruns = 0;  ///< steps dropped since the beginning
  std::optional<std::chrono::steady_clock::time_point> due;  ///< when the step was due; empty if not paced by the clock
  double lateness = 0;                                       ///< delay of its beginning [s]
  double duration = 0;                                       ///< wall time that it took [s]
};

/// While it runs, this thread steps and reports. While it is halted, the thread that halted it (the one that spins ROS
/// callbacks) may access the simulation. The two threads exchange commands and reports through rings, without waiting
/// for each other.
class SteppingThread {
 public:
  /// Creates a halted thread. @param notify  called by this thread after each report
  SteppingThread(Simulation simulation, const Pace& pace, std::function<void()> notify);
  ~SteppingThread();
  SteppingThread(const SteppingThread&) = delete;
  SteppingThread& operator=(const SteppingThread&) = delete;

  // ---- for the thread that spins ROS callbacks
  /// Continues stepping. @param anew  whether to ignore the wall time since the halt
  void run(bool anew);
  /// Halts the thread. Returns at the end of the present step.
  void halt();
  /// To be called for a report with `has_failed`. The thread has halted after such a report.
  void note_failure();
  /// Calls `act(simulation)` while the thread is halted; then continues if the thread was running.
  template <class Act>
  void between_steps(const Act& act);
  /// Hands over a message whose commands act from the next step on; in lock step, each message causes one step.
  /// @returns false if too many commands are waiting
  bool command(const std::vector<Command>& message);
  /// In lock step, causes one step without new commands. @returns as command()
  bool command_step();
  /// The reports of steps, in order. If the caller reads them too slowly, some are lost, unless steps wait for it.
  SpscRing<StepReport>& reports() { return reports_; }
  /// Gives the thread real-time priority, and locks the memory of the process.
  /// @returns the operations that the system refused, with reasons; empty if none
  std::string make_real_time();

  // ---- for a caller that has halted the thread and taken all reports
  /// Continues with another simulation of the same mechanism. Commands stay in force.
  void go_on_with(Simulation simulation);
  /// Continues with the simulation of a scene in which links have come or gone. Commands, those that wait included,
  /// trajectories, grips and wrenches follow their coordinates and links by name. They end for coordinates and links
  /// that are gone, wrenches also for links that are now fixed to the world. All pulls end.
  /// @param places  those of the present simulation's coordinates and links in the other one
  void go_on_with_scene(Simulation simulation, const Renumbering& places);
  /// Starts with the simulation of another scene. All commands are forgotten.
  void begin_with(Simulation simulation);
  void set_pace(const Pace& pace);

  // ---- for a caller that has halted the thread
  Simulation& simulation() { return simulation_; }
  WrenchSchedule& wrenches() { return wrenches_; }
  /// Times in trajectories are those of time(). A command for a joint's set point ends its trajectory.
  TrajectoryFollower& trajectories() { return trajectories_; }
  /// A command for a joint's set point ends its grip.
  Grips& grips() { return grips_; }
  /// Whether a Companion estimates errors. It cannot if servos are sampled in every step, or in an odd number of steps.
  bool estimates_errors() const { return companion_.has_value(); }
  /// Simulated time since the beginning, which resets do not set back [s].
  double time() const { return time_.seconds(); }
  /// Does one step, with commands and report. @returns false if it failed
  bool advance();
  /// Applies waiting commands now; not in lock step, where they belong to later steps.
  void take_commands();
  /// Drops waiting commands. Those in force no longer expire.
  void forget_commands();
  /// The commanded set point of this coordinate no longer expires.
  void forget_set_point(std::size_t coordinate) { timed_commands_.forget_set_point(coordinate); }

 private:
  void loop();
  /// Returns true if the next step may begin. Otherwise waits for a while and returns false.
  bool wait_for_step();
  /// `lateness`: of a step that is paced by the wall clock [s].
  bool make_step(std::optional<double> lateness);
  void take_message();
  /// Messages that wait still cause a step each in lock step, even if all that they command is gone.
  void renumber_waiting_commands(const Renumbering& places);
  /// Allocates the memory of all reports in advance, with the size of a state after a step.
  void make_room();
  void begin_companion();
  /// Gives the set points of trajectories and grips for the next step.
  void follow_trajectories();

  Simulation simulation_;
  std::optional<Companion> companion_;  ///< estimates the error of simulation_
  TimedCommands timed_commands_;
  WrenchSchedule wrenches_;
  TrajectoryFollower trajectories_;
  Grips grips_;
  Pace pace_;
  Pacer pacer_;
  std::chrono::steady_clock::time_point last_look_;  ///< when the clock was read last
  std::uint64_t steps_ = 0;
  SteppedTime time_;
  bool has_failed_ = false;  ///< whether the last step failed
  SpscRing<StepReport> reports_;
  SpscRing<Command> commands_;
  std::function<void()> notify_;
  bool is_running_ = false;  ///< only used by the thread that spins
  std::atomic<bool> may_run_{false}, is_over_{false};
  Semaphore wake_, halted_, start_;
  std::thread thread_;
};

template <class Act>
void SteppingThread::between_steps(const Act& act) {
  struct Pause {
    SteppingThread& thread;
    const bool was_running = thread.is_running_;
    ~Pause() {
      if (was_running && !thread.has_failed_) thread.run(false);
    }
  };
  const Pause pause{*this};
  halt();
  take_commands();
  act(simulation_);
  if (companion_) companion_->begin(simulation_);
}

}  // namespace flexarm::node
