/// Measures how late the steps of the node begin, and after how many steps a command acts. Follows the node's states,
/// one message for each step, and answers each with an effort that identifies it.
///
///   bench_node_latency JOINT SECONDS
///
/// Writes a table in Markdown. The exit status is 1 if a message was missed or stamped unevenly.
/// scripts/measure_latency starts this program.
#include <flexarm/JointForceCommand.h>
#include <flexarm/SimulatorStatus.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

/// Number of commands after which efforts repeat, and the difference of two efforts [N m]. No command acts so late that
/// it could be mistaken for another one.
constexpr std::size_t kEfforts = 1000;
constexpr double kEffortUnit = 0.01;
constexpr std::size_t kLongest = 10;  // number of steps of delay that are distinguished

class Follower {
 public:
  Follower(ros::NodeHandle& node, const std::string& joint) : joint_(joint) {
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    commands_ = node.advertise<flexarm::JointForceCommand>("joint_force_command", 1000);
    states_ = node.subscribe("joint_states", 100000, &Follower::receive_state, this, hints);
    status_ = node.subscribe("flexarm/status", 100, &Follower::receive_status, this, hints);
  }

  /// Starts the measurement.
  void begin() {
    stamps_.clear();
    ages_.fill(0);
    first_ = last_;
  }
  /// @returns whether a message came for each step, with even stamps
  bool report() const;

 private:
  void receive_status(const flexarm::SimulatorStatus& status) { last_ = status; }
  void receive_state(const sensor_msgs::JointState& state);
  std::uint64_t uneven_gaps() const;

  std::string joint_;
  std::vector<ros::Time> stamps_;
  std::size_t received_ = 0;
  // Counts of states by the age of the state that their effort answers; the last one counts all older ages
  std::array<std::uint64_t, kLongest + 1> ages_{};
  flexarm::SimulatorStatus first_, last_;
  ros::Publisher commands_;
  ros::Subscriber states_, status_;
};

void Follower::receive_state(const sensor_msgs::JointState& state) {
  const auto name = std::find(state.name.begin(), state.name.end(), joint_);
  if (name == state.name.end()) return;
  const double effort = state.effort[static_cast<std::size_t>(name - state.name.begin())];
  const auto acting = static_cast<std::size_t>(std::lround(effort / kEffortUnit));
  // The effort in the step that ends with this state answered the state `age` steps earlier.
  const std::size_t age = (received_ % kEfforts + kEfforts - acting % kEfforts) % kEfforts;
  ++ages_[std::min(age, kLongest)];
  stamps_.push_back(state.header.stamp);
  flexarm::JointForceCommand command;
  command.names = {joint_};
  command.efforts = {kEffortUnit * static_cast<double>(received_ % kEfforts)};
  commands_.publish(command);
  ++received_;
}

/// Returns how many distances of stamps are not a whole number of steps, to within a nanosecond.
std::uint64_t Follower::uneven_gaps() const {
  const auto step = std::lround(1e9 * last_.step);
  std::uint64_t uneven = 0;
  for (std::size_t i = 1; i < stamps_.size(); ++i) {
    const long rest = (stamps_[i] - stamps_[i - 1]).toNSec() % step;
    uneven += std::min(rest, step - rest) > 1;
  }
  return uneven;
}

void print_statistics(const char* what, const flexarm::DurationStatistics& statistics) {
  std::printf("| %s: 50 %% / 99 %% / 99.9 %% / longest [ms] | %.3f / %.3f / %.3f / %.3f |\n", what,
              1e3 * statistics.median, 1e3 * statistics.p99, 1e3 * statistics.p999, 1e3 * statistics.max);
}

bool Follower::report() const {
  const std::uint64_t dropped = last_.overruns - first_.overruns, missed = last_.missed - first_.missed;
  std::uint64_t gap = 0;
  if (!stamps_.empty()) {
    const double span = (stamps_.back() - stamps_.front()).toSec() / last_.step;
    gap = static_cast<std::uint64_t>(std::lround(span)) + 1 - stamps_.size();
  }
  std::printf("| | |\n|---|---|\n| messages of a step | %zu |\n| steps that were dropped | %lu |\n", stamps_.size(),
              dropped);
  std::printf("| stamps that are missing | %lu |\n| uneven stamps | %lu |\n| states passed over | %lu |\n", gap,
              uneven_gaps(), missed);
  print_statistics("lateness of steps", last_.lateness);
  print_statistics("wall time of steps", last_.step_time);
  std::uint64_t all = 0;
  for (const std::uint64_t count : ages_) all += count;
  for (std::size_t age = 0; age < ages_.size(); ++age)
    if (ages_[age] > 0)
      std::printf("| efforts that answer the state %zu%s step%s before | %.4f %% |\n", age,
                  age == kLongest ? " or more" : "", age == 1 ? "" : "s",
                  100 * static_cast<double>(ages_[age]) / static_cast<double>(all));
  return !stamps_.empty() && uneven_gaps() == 0 && missed == 0 && gap <= dropped;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "node_latency", ros::init_options::AnonymousName);
  if (argc != 3) {
    std::fprintf(stderr, "bench_node_latency JOINT SECONDS\n");
    return 2;
  }
  ros::NodeHandle node;
  Follower follower(node, argv[1]);
  const auto spin = [](double seconds) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (ros::ok() && ros::WallTime::now() < end)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  };
  spin(2);
  follower.begin();
  spin(std::atof(argv[2]));
  return follower.report() ? 0 : 1;
}
