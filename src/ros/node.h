#pragma once
/// A thread steps the simulation, this one lets everybody know.

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "beam_state_publisher.h"
#include "bell.h"
#include "clock_publisher.h"
#include "command_interface.h"
#include "contact_publisher.h"
#include "diagnostics.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"
#include "frame_watch.h"
#include "marker_publisher.h"
#include "master_watch.h"
#include "parameters.h"
#include "publication_schedule.h"
#include "pull_handles.h"
#include "reconfiguration.h"
#include "run_state.h"
#include "sensor_publisher.h"
#include "services.h"
#include "slowness_warning.h"
#include "state_publisher.h"
#include "status_publisher.h"
#include "stepping/stepping_thread.h"

namespace flexarm::node {

/// A simulation on the ROS graph. All but steps happens in the one thread that spins. It looks at a copy of what is
/// stepped, which gets each state in turn.
class Node {
 public:
  /// Reads parameters and scene, and starts.
  /// @throws ParameterError, ModelError if they cannot be used.
  Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Steps of a paused simulation that somebody makes end, too (StepService).
  void pause();
  /// After a failed step, goes on from the last good state, with what was commanded since.
  /// @returns false, and stays paused, if the step fails again; run().failure says why
  bool resume();
  /// Back to the scene's initial state; time of the stamps goes on, and paused stays paused.
  void reset();
  /// The same, and time begins again at zero: /clock jumps back, and all stamps with it.
  /// @returns why not, or nothing
  std::string reset_with_clock();
  /// Reads the scene again, from where it came, and begins with its initial state; joints, links and sensors may be
  /// others. Time of the stamps goes on, and paused stays paused; commands, wrenches and trajectories are over.
  /// @throws ParameterError, ModelError, and others if it cannot be used; all is as before then.
  void reload();
  /// Goes on with the scene that `edit` makes of this one (payloads.h), from the state of now. Commands go on. So do
  /// trajectories, grips and wrenches if joints and links keep their places: what comes is behind the others, what goes
  /// was the last; else they are over.
  /// @throws what `edit` throws; all is as before then.
  void edit(const std::function<void(Simulation&)>& edit);
  /// Goes on, from the state of now, by other parameters, and by another scene if there is one, which must be the same
  /// but for its <integrator>, gravity and gains of servos. What was commanded goes on.
  /// @throws ModelError, std::invalid_argument if they cannot be used; all is as before then.
  void change(std::optional<scene::SceneDescription> scene, const Parameters& parameters);
  /// Goes on from a state in a file; time of the stamps goes on, and paused stays paused. Applied wrenches are over.
  /// @throws std::runtime_error as read_checkpoint(); all is as before then.
  void load_state(const std::string& file);
  /// Puts joints elsewhere, or gives them other velocities; commands and what they follow go on.
  /// @throws std::invalid_argument as Simulation::set_joint_state(); all is as before then.
  void set_joint_state(const std::vector<CoordinateState>& coordinates);
  /// @returns why the modes cannot be switched, or nothing
  std::string switch_mode(const std::vector<std::string>& names, const std::vector<std::string>& modes);
  /// @param start     by the stamps of messages; in the past: with the next step
  /// @param duration  [s]; < 0: for ever, 0: nothing, less than a step: one step
  /// @throws std::invalid_argument as Simulation::apply_wrenches().
  void apply_wrench(const AppliedWrench& wrench, const ros::Time& start, double duration);
  /// Those of pulls, too.
  void clear_wrenches();
  /// Makes a step of a paused simulation. @returns false if it failed; run().failure says why
  bool step() { return advance(); }
  /// Tells everybody of the state, whatever their rates.
  void publish_state() { publish(true); }
  /// How often pause() was called.
  std::uint64_t pauses() const { return pauses_; }

  const RunState& run() const { return run_; }
  const Parameters& parameters() const { return parameters_; }
  const Simulation& simulation() const { return shown_; }
  /// What was commanded up to now is in simulation(), too.
  void catch_up();

 private:
  /// The names of all services.
  std::vector<std::string> service_names() const;
  /// What is due now and then.
  void tick();
  /// Publishes what steps came to.
  void take_reports();
  void take(const StepReport& report);
  /// One step while the thread is halted. @returns false if it failed
  bool advance();
  void warn_of_recoveries(const StepReport& report);
  void be_real_time();
  /// Lets rviz pull on links.
  void be_interactive();
  void publish(bool force);
  /// Says what is simulated.
  void announce() const;
  /// What is stepped is of another scene than what is shown.
  void adopt_scene();
  /// Tells the clocks how fast steps are to be.
  void set_pace();
  /// Topics begin anew with their rates, and with any stamp.
  void set_rates();
  /// Steps were made (see ClockPublisher), or something else is news.
  void advance_clock(std::uint64_t steps, std::uint64_t overruns, std::optional<ClockPublisher::WallTime> due);
  void publish_news();
  /// Takes over the state of what is stepped, between two steps.
  void show();
  /// The same, where it is another one than the last step's, and tells everybody.
  void show_new_state();
  /// That, and nothing that was commanded before acts any more.
  void begin_anew();
  /// That no reset sets back, when messages have that stamp [s].
  double simulated_time(const ros::Time& stamp) const;
  /// Sets ~view, which tells displays where to look.
  void describe_view() const;
  void fail(const StepResult& result);

  ros::NodeHandle node_, private_node_{"~"};
  Parameters parameters_;
  Simulation shown_;
  Snapshot snapshot_;  ///< scratch
  RunState run_;
  std::uint64_t pauses_ = 0;
  SlownessWarning slowness_{run_};
  ClockPublisher clock_publisher_;
  StatePublisher state_publisher_;
  BeamStatePublisher beam_state_publisher_;
  ContactPublisher contact_publisher_;
  MarkerPublisher marker_publisher_;
  SensorPublisher sensor_publisher_;
  StatusPublisher status_publisher_;
  Diagnostics diagnostics_;
  Bell bell_;
  SteppingThread stepping_;
  CommandInterface command_interface_;
  FrameWatch frame_watch_;
  std::optional<PullHandles> pull_handles_;
  PublicationSchedule handle_schedule_;
  Services services_;
  Reconfiguration reconfiguration_;
  MasterWatch master_watch_;
  ros::SteadyTimer timer_;
};

}  // namespace flexarm::node
