#pragma once
/// The class of the ROS node: a thread steps the simulation, and the thread that runs ros::spin() does all the rest.

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

#include <cstdint>
#include <functional>
#include <memory>
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
#include "web_publisher.h"

namespace flexarm::node {

/// A simulation on the ROS graph. Except for steps, all happens in the thread that runs ros::spin(). This thread reads
/// `shown_`, a copy of the simulation, to which it restores each state that the stepping thread reports.
class Node {
 public:
  /// Reads parameters and scene, and starts the simulation.
  /// @throws ParameterError, ModelError if they cannot be used.
  Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Pauses the simulation. Also ends a call of ~step (StepService).
  void pause();
  /// Goes on. After a failed step, first tries the step again from the last good state, with the commands that came
  /// since.
  /// @returns false, and stays paused, if the step fails again; run().failure says why
  bool resume();
  /// Goes back to the scene's initial state. Stamps go on, and a paused simulation stays paused.
  void reset();
  /// Like reset(), but time begins again at zero: /clock and all stamps jump back.
  /// @returns an error, or ""
  std::string reset_with_clock();
  /// Reads the scene again from its source, and begins with its initial state. Joints, links and sensors may differ.
  /// Stamps go on, and a paused simulation stays paused. Commands, wrenches and trajectories end.
  /// @throws ParameterError, ModelError and others if the scene cannot be used; then nothing has changed
  void reload();
  /// Adds or removes links: goes on from the present state with the scene that `edit` makes of the present one
  /// (payloads.h). Commands, trajectories, goals, grips and wrenches of joints and links that stay go on.
  /// @throws what `edit` throws; then nothing has changed
  void edit(const std::function<void(Simulation&)>& edit);
  /// Goes on from the present state with other parameters and, if `scene` is given, with another scene. It may differ
  /// from the present scene only in its <integrator>, gravity and gains of servos. Commands stay.
  /// @throws ModelError, std::invalid_argument if they cannot be used; then nothing has changed
  void change(std::optional<scene::SceneDescription> scene, const Parameters& parameters);
  /// Goes on from a state in a file. Stamps go on, and a paused simulation stays paused. Applied wrenches end.
  /// @throws std::runtime_error as read_checkpoint() does; then nothing has changed
  void load_state(const std::string& file);
  /// Gives joints other positions or velocities at once. Commands and trajectories stay.
  /// @throws std::invalid_argument as Simulation::set_joint_state() does; then nothing has changed
  void set_joint_state(const std::vector<CoordinateState>& coordinates);
  /// Switches the modes of servos. @returns why they cannot be switched, or ""
  std::string switch_mode(const std::vector<std::string>& names, const std::vector<std::string>& modes);
  /// @param start     as a stamp of messages; if it is in the past, the wrench acts from the next step on
  /// @param duration  [s]; < 0: for ever, 0: nothing, less than a step: one step
  /// @throws std::invalid_argument as Simulation::apply_wrenches() does.
  void apply_wrench(const AppliedWrench& wrench, const ros::Time& start, double duration);
  /// Removes all applied wrenches and all pulls of rviz's handles.
  void clear_wrenches();
  /// Makes one step of a paused simulation. @returns false if it failed; run().failure says why
  bool step() { return advance(); }
  /// Publishes the state on all topics, whatever their rates.
  void publish_state() { publish(true); }
  /// How often pause() was called.
  std::uint64_t pauses() const { return pauses_; }

  const RunState& run() const { return run_; }
  const Parameters& parameters() const { return parameters_; }
  const Simulation& simulation() const { return shown_; }
  /// Makes simulation() up to date, with the effects of all commands that have arrived.
  void catch_up();

 private:
  /// The names of all services.
  std::vector<std::string> service_names() const;
  /// Does what is due regularly, every 0.1 s.
  void tick();
  /// Takes all reports of steps that wait, and publishes the states.
  void take_reports();
  void take(const StepReport& report);
  /// Makes one step while the stepping thread is halted. @returns false if it failed
  bool advance();
  void warn_of_recoveries(const StepReport& report);
  void be_real_time();
  /// Makes the handles with which rviz pulls links.
  void be_interactive();
  void publish(bool force);
  /// Logs what is simulated.
  void announce() const;
  /// Replaces `shown_` and adapts topics after the stepping thread has got another scene.
  void adopt_scene();
  /// Tells stepping thread and clock how fast steps should be made.
  void set_pace();
  /// Sets the rates of all topics and restarts their schedules: the next message may have any stamp.
  void set_rates();
  /// Moves the clock on after steps (see ClockPublisher::advance()), or by one for other news.
  void advance_clock(std::uint64_t steps, std::uint64_t overruns, std::optional<ClockPublisher::WallTime> due);
  void publish_news();
  /// Copies the state of the stepped simulation to `shown_`, between two steps.
  void show();
  /// Like show(), for a state that is not the result of a step; also publishes it.
  void show_new_state();
  /// Like show_new_state(), and drops all commands and wrenches.
  void begin_anew();
  /// Simulated time at which messages have that stamp; no reset sets it back [s].
  double simulated_time(const ros::Time& stamp) const;
  /// Sets the parameters below ~view, which tell displays where to look.
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
  std::unique_ptr<WebPublisher> web_publisher_;  ///< null: there is no page
  Services services_;
  Reconfiguration reconfiguration_;
  MasterWatch master_watch_;
  ros::SteadyTimer timer_;
};

}  // namespace flexarm::node
