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
#include "semaphore.h"
#include "stepped_time.h"
#include "timed_commands.h"
#include "trajectory_follower.h"
#include "wrench_schedule.h"

namespace flexarm::node {

struct Pace {
  double real_time_factor = 1;   ///< simulated per wall time; 0: as fast as possible
  double max_catch_up = 0.1;     ///< backlog that is made up before steps are dropped, wall time [s]
  bool lock_step = false;        ///< each step waits for the message that commands it, whatever the wall clock says
  bool cuts_late_steps = false;  ///< one that runs out of time (SimulationOptions::recovery_wall_time) has not failed
  double error_window = 0;       ///< over which a Companion estimates the error of steps [s]; 0: none does

  /// How much simulated time passes while stamps go on by a second: one, too, where nothing ties the one to the other.
  /// `are_simulated`: they are simulated times themselves.
  double per_stamp(bool are_simulated) const {
    return are_simulated || lock_step || real_time_factor == 0 ? 1 : real_time_factor;
  }
};

/// The outcome of a step.
struct StepReport {
  Snapshot state;  ///< after it, or after the last good sub-step
  StepResult result;
  bool has_failed = false;
  std::uint64_t steps = 0;     ///< that were done since the beginning
  double time = 0;             ///< simulated, since then; a reset does not set it back [s]
  std::uint64_t overruns = 0;  ///< dropped since then
  std::optional<std::chrono::steady_clock::time_point> due;  ///< by the wall clock, if it keeps pace with that,
  double lateness = 0;                                       ///< and began so much later [s]
  double duration = 0;                                       ///< by the wall clock [s]
};

/// While it runs, it steps and reports. While it is halted, the simulation belongs to the thread that halted it, the
/// one that spins. Neither waits for the other: commands go one way through a ring, reports the other way.
class SteppingThread {
 public:
  /// Halted. @param notify  is called by this thread after each report
  SteppingThread(Simulation simulation, const Pace& pace, std::function<void()> notify);
  ~SteppingThread();
  SteppingThread(const SteppingThread&) = delete;
  SteppingThread& operator=(const SteppingThread&) = delete;

  // ---- for the thread that spins
  /// @param anew  time that has passed meanwhile does not count
  void run(bool anew);
  /// Returns at the end of the step that is under way.
  void halt();
  /// A report tells that a step has failed, after which the thread is halted.
  void note_failure();
  /// Halts for as long as `act(simulation)` takes, if it runs.
  template <class Act>
  void between_steps(const Act& act);
  /// A message acts from the next step on; in lock step, each makes one. @returns false if too many wait already
  bool command(const std::vector<Command>& message);
  /// In lock step, makes one step in which nothing new is commanded. @returns false as command()
  bool command_step();
  /// The outcomes of steps, in order. If the caller is too slow and the clock does not wait, some are lost.
  SpscRing<StepReport>& reports() { return reports_; }
  /// Gives the thread real-time priority, and locks the memory of the process.
  /// @returns what the system refuses; empty: nothing
  std::string make_real_time();

  // ---- for a caller that has halted it and has taken all reports
  /// Goes on with another simulation of the same mechanism; commands stay in force.
  void go_on_with(Simulation simulation);
  /// Goes on with that of a scene in which links came or went. Commands stay in force, but for those of what went, and
  /// pulls; if coordinates and links do not keep their places, trajectories, grips and wrenches are over, too.
  void go_on_with_scene(Simulation simulation, bool keeps_places);
  /// Begins with the simulation of another scene; all commands are forgotten.
  void begin_with(Simulation simulation);
  void set_pace(const Pace& pace);

  // ---- for a caller that has halted it
  Simulation& simulation() { return simulation_; }
  WrenchSchedule& wrenches() { return wrenches_; }
  /// Its times are those of time(). Joints whose set points are commanded leave it.
  TrajectoryFollower& trajectories() { return trajectories_; }
  /// So do joints that grip.
  Grips& grips() { return grips_; }
  /// Whether a Companion does: it cannot where servos are sampled in every step, or in an odd number of them.
  bool estimates_errors() const { return companion_.has_value(); }
  /// Simulated, since the beginning; a reset does not set it back [s].
  double time() const { return time_.seconds(); }
  /// One step and what belongs to it. @returns false if it failed
  bool advance();
  /// What was commanded acts now, but in lock step, where it is for the steps to come.
  void take_commands();
  /// Commands that wait are dropped, and none expires any more.
  void forget_commands();
  /// What was commanded as the set point of a coordinate does not expire.
  void forget_set_point(std::size_t coordinate) { timed_commands_.forget_set_point(coordinate); }

 private:
  void loop();
  /// True once the next step may begin; else waits for a while.
  bool wait_for_step();
  /// `lateness`: of a step that keeps pace with the wall clock [s].
  bool make_step(std::optional<double> lateness);
  void take_message();
  /// Reports get room for states as they are after a step, so that the thread need not allocate it.
  void make_room();
  void begin_companion();
  /// Set points of the next step.
  void follow_trajectories();

  Simulation simulation_;
  std::optional<Companion> companion_;  ///< of the simulation
  TimedCommands timed_commands_;
  WrenchSchedule wrenches_;
  TrajectoryFollower trajectories_;
  Grips grips_;
  Pace pace_;
  Pacer pacer_;
  std::chrono::steady_clock::time_point last_look_;  ///< at the clock
  std::uint64_t steps_ = 0;
  SteppedTime time_;
  bool has_failed_ = false;  ///< the last step
  SpscRing<StepReport> reports_;
  SpscRing<Command> commands_;
  std::function<void()> notify_;
  bool is_running_ = false;  ///< as the thread that spins knows it
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
