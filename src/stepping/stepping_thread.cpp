#include "stepping_thread.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace flexarm::node {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// A waiting thread checks its conditions again after this time, unless the other thread wakes it earlier.
constexpr std::chrono::milliseconds kLongestWait{100};
constexpr std::chrono::microseconds kWaitForRoom{100};
constexpr std::size_t kCommands = 4096;
/// Number of step reports that can wait to be published while the publishers are busy, from the memory that they need.
/// A state has about 17 numbers per unknown.
constexpr std::size_t kFewestReports = 64, kMostReports = 1024, kBytesOfReports = 32 << 20, kBytesPerUnknown = 136;
/// Scheduling priority: above the usual one of real-time programs, below the kernel's own threads.
constexpr int kPriority = 40;

std::size_t report_count(const Simulation& simulation) {
  return std::clamp(kBytesOfReports / (kBytesPerUnknown * (simulation.degrees_of_freedom() + 1)), kFewestReports,
                    kMostReports);
}

using Seconds = std::chrono::duration<double>;

double seconds(SteadyClock::duration duration) {
  return Seconds(duration).count();
}

}  // namespace

SteppingThread::SteppingThread(Simulation simulation, const Pace& pace, std::function<void()> notify)
    : simulation_(std::move(simulation)),
      timed_commands_(simulation_),
      wrenches_(simulation_),
      trajectories_(simulation_.coordinate_names().size()),
      pace_(pace),
      pacer_(simulation_.step_size(), pace.real_time_factor, pace.max_catch_up),
      time_(simulation_.step_size()),
      reports_(report_count(simulation_)),
      commands_(kCommands),
      notify_(std::move(notify)) {
  make_room();
  begin_companion();
  thread_ = std::thread([this] { loop(); });  // last: if anything above throws, no thread is running
  halted_.take();
}

SteppingThread::~SteppingThread() {
  halt();
  is_over_.store(true);
  start_.give();
  thread_.join();
}

void SteppingThread::run(bool anew) {
  if (is_running_) return;
  if (anew) {
    pacer_.clear_backlog();
    last_look_ = SteadyClock::now();
  }
  is_running_ = true;
  has_failed_ = false;
  may_run_.store(true);
  start_.give();
}

void SteppingThread::halt() {
  if (!is_running_) return;
  may_run_.store(false);
  wake_.give();
  halted_.take();
  is_running_ = false;
}

void SteppingThread::note_failure() {
  if (!is_running_) return;
  halted_.take();
  is_running_ = false;
}

bool SteppingThread::command(const std::vector<Command>& message) {
  if (!commands_.has_room(message.size()) && !is_running_) take_commands();
  if (!commands_.has_room(message.size())) return false;
  for (std::size_t i = 0; i < message.size(); ++i) {
    commands_.free_entry(i) = message[i];
    commands_.free_entry(i).ends_message = i + 1 == message.size();
  }
  commands_.push(message.size());
  if (pace_.lock_step) wake_.give();
  return true;
}

bool SteppingThread::command_step() {
  return !pace_.lock_step || command({{Commanded::Nothing}});
}

std::string SteppingThread::make_real_time() {
  std::string refused;
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  if (const int error = pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &parameters); error != 0)
    refused += "SCHED_FIFO of priority " + std::to_string(kPriority) + ": " + std::strerror(error);
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    refused += (refused.empty() ? "" : "; ") + std::string("mlockall: ") + std::strerror(errno);
  return refused;
}

// ---------------------------------------------------------------- while the thread is halted, or called by it

void SteppingThread::make_room() {
  Simulation ahead = simulation_.copy();
  ahead.step();
  for (std::size_t i = 0; reports_.has_room(i + 1); ++i) ahead.snapshot(reports_.free_entry(i).state);
}

void SteppingThread::go_on_with(Simulation simulation) {
  simulation_ = std::move(simulation);
  time_.set_step(simulation_.step_size());
  set_pace(pace_);
  make_room();
}

void SteppingThread::go_on_with_scene(Simulation simulation, const Renumbering& places) {
  go_on_with(std::move(simulation));
  renumber_waiting_commands(places);
  timed_commands_.renumber(places);
  trajectories_.renumber(places.coordinates, simulation_.coordinate_names().size());
  grips_.renumber(places.coordinates);
  wrenches_.renumber(places);
}

void SteppingThread::renumber_waiting_commands(const Renumbering& places) {
  for (std::size_t waiting = commands_.size(); waiting > 0; --waiting) {
    Command command = commands_.front();
    commands_.pop();
    if (command.quantity != Commanded::Nothing) {
      const std::optional<std::size_t> now = places.coordinates[command.coordinate];
      command.coordinate = now.value_or(0);
      if (!now) command.quantity = Commanded::Nothing;
    }
    commands_.free_entry() = command;
    commands_.push();
  }
}

void SteppingThread::begin_with(Simulation simulation) {
  go_on_with(std::move(simulation));
  forget_commands();
  wrenches_.clear();
  trajectories_ = TrajectoryFollower(simulation_.coordinate_names().size());
  grips_.release_all();
}

void SteppingThread::set_pace(const Pace& pace) {
  pace_ = pace;
  pacer_.set_pace(simulation_.step_size(), pace.real_time_factor, pace.max_catch_up);
  pacer_.clear_backlog();
  last_look_ = SteadyClock::now();
  begin_companion();
}

void SteppingThread::begin_companion() {
  companion_.reset();
  if (pace_.error_window <= 0) return;
  try {
    companion_.emplace(simulation_, pace_.error_window);
  } catch (const std::invalid_argument&) {  // no companion is possible, see estimates_errors()
  }
}

bool SteppingThread::advance() {
  return make_step(std::nullopt);
}

bool SteppingThread::make_step(std::optional<double> lateness) {
  take_commands();
  if (pace_.lock_step && !commands_.empty()) take_message();
  follow_trajectories();
  wrenches_.update(time());
  const SteadyClock::time_point start = SteadyClock::now();
  StepResult result = simulation_.step();
  if (companion_ && result.converged) result.error_estimate = companion_->follow(simulation_);
  if (result.converged) {
    ++steps_;
    time_.advance();
  }
  has_failed_ = !result.converged && !(pace_.cuts_late_steps && result.reason == StepResult::Reason::OutOfTime);
  // The last free entry is reserved for the report of a failure, which must not be lost.
  if (!reports_.has_room(has_failed_ ? 1 : 2)) return !has_failed_;
  StepReport& report = reports_.free_entry();
  simulation_.snapshot(report.state);
  report.result = result;
  report.has_failed = has_failed_;
  report.steps = steps_;
  report.time = time();
  report.overruns = pacer_.overruns();
  report.due.reset();
  if (lateness) report.due = last_look_ - std::chrono::duration_cast<SteadyClock::duration>(Seconds(*lateness));
  report.lateness = lateness.value_or(0);
  report.duration = seconds(SteadyClock::now() - start);
  reports_.push();
  notify_();
  return !has_failed_;
}

void SteppingThread::take_commands() {
  timed_commands_.expire(time());
  while (!pace_.lock_step && !commands_.empty()) take_message();
}

void SteppingThread::take_message() {
  for (bool is_at_end = false; !is_at_end; commands_.pop()) {
    const Command& command = commands_.front();
    if (command.quantity == Commanded::SetPoint) {
      trajectories_.release(command.coordinate);
      grips_.release(command.coordinate);
    }
    timed_commands_.apply(command);
    is_at_end = commands_.front().ends_message;
  }
}

void SteppingThread::follow_trajectories() {
  for (std::size_t joint = 0; joint < trajectories_.joint_count(); ++joint) {
    if (!trajectories_.follows(joint)) continue;
    const JointPoint point = trajectories_.at(joint, time() + simulation_.step_size());
    simulation_.command_set_point(joint, point.position, point.velocity, point.acceleration);
  }
  trajectories_.release_arrived(time());
  grips_.command(simulation_);
}

void SteppingThread::forget_commands() {
  while (!commands_.empty()) commands_.pop();
  timed_commands_.forget();
}

// ---------------------------------------------------------------- the thread

void SteppingThread::loop() {
  prctl(PR_SET_TIMERSLACK, 1);  // [ns] wake up exactly on time, instead of together with other timers
  while (true) {
    if (!may_run_.load()) {
      halted_.give();
      start_.take();
      if (is_over_.load()) return;
    } else if (wait_for_step()) {
      const bool is_paced = !pace_.lock_step && !pacer_.as_fast_as_possible();
      if (!make_step(is_paced ? std::optional(pacer_.lateness()) : std::nullopt))
        may_run_.store(false);
      else if (is_paced)
        pacer_.step_done();
    }
  }
}

bool SteppingThread::wait_for_step() {
  const SteadyClock::time_point now = SteadyClock::now();
  if (pace_.lock_step || pacer_.as_fast_as_possible()) {
    const bool has_room = reports_.has_room(2), is_commanded = !pace_.lock_step || !commands_.empty();
    if (has_room && is_commanded) return true;
    wake_.take_until(is_commanded ? now + SteadyClock::duration(kWaitForRoom) : now + kLongestWait);
    return false;
  }
  pacer_.elapse(seconds(now - std::exchange(last_look_, now)));
  if (pacer_.step_due()) return true;
  const Seconds rest(-pacer_.lateness());
  wake_.take_until(now + std::min<SteadyClock::duration>(std::chrono::ceil<SteadyClock::duration>(rest), kLongestWait));
  return false;
}

}  // namespace flexarm::node
