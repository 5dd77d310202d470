#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/page_options.h"
#include "cli/recording_library.h"
#include "cli/scene_input.h"
#include "flexarm/simulation/checkpoint.h"
#include "pictures/page.h"
#include "pictures/recorded_rows.h"

namespace flexarm::cli {
namespace {

struct ReplayArguments {
  SceneInput scene;
  SimulationOptions simulation;
  recording::ReplayOptions replay;
  std::string resume;
  PageOptions page;
};

/// Keeps the recorded run and its replay, for a page that shows them side by side.
class BothRuns {
 public:
  explicit BothRuns(const Simulation& simulation)
      : start_(simulation.copy()), replayed_(simulation, {"replay"}), recorded_{{{"time", "s"}}, {}} {
    for (const char* pattern : {"joint/*/position", "joint/*/effort"}) {
      if (simulation.coordinate_names().empty()) continue;
      const ResultColumns chosen(simulation, ResultColumns::Solver::Without, {pattern});
      recorded_.columns.insert(recorded_.columns.end(), chosen.columns().begin() + 1, chosen.columns().end());
    }
  }

  void keep(const Simulation& simulation, const recording::RecordedJoints& joints) {
    if (!replayed_.is_due(simulation)) return;
    replayed_.keep(simulation, {});
    recorded_.values.push_back(simulation.time());
    for (const std::vector<double>& values : {joints.positions, joints.efforts})
      recorded_.values.insert(recorded_.values.end(), values.begin(), values.end());
  }

  std::vector<pictures::EncodedRun> encode() const {
    return {pictures::record_rows(start_, recorded_, {"recorded run", kAllRows}), replayed_.encode()};
  }

 private:
  static constexpr double kAllRows = 1e9;  ///< a rate with which all rows are shown, since only few are kept

  Simulation start_;
  pictures::Recording replayed_;
  pictures::ResultRows recorded_;
};

/// "up to 1 step earlier or later".
std::string shifts_text(const recording::OtherTimes& times) {
  const auto steps = [](int count) { return fmt::format("{} step{}", count, count == 1 ? "" : "s"); };
  return times.earlier == times.later
             ? fmt::format("up to {} earlier or later", steps(times.later))
             : fmt::format("up to {} earlier or {} later", steps(times.earlier), steps(times.later));
}

void print_verdict(const recording::ReplayReport& report, double largest) {
  const auto farthest = [&](double recording::JointDeviation::*how) {
    return *std::max_element(report.joints.begin(), report.joints.end(),
                             [&](const auto& a, const auto& b) { return a.*how < b.*how; });
  };
  const bool agrees = report.agrees(largest);
  if (report.other_times.replays == 0) {
    fmt::print("{}: positions differ by {} {:g}\n", agrees ? "agrees" : "DIFFERS", agrees ? "at most" : "more than",
               largest);
    return;
  }
  fmt::print("The bag does not say in which step a command acted: {} replays with commands {} than recorded\n",
             report.other_times.replays, shifts_text(report.other_times));
  fmt::print("differ from this one as \"explained by times\" says.\n");
  if (agrees) {
    fmt::print("agrees, apart from differences that the times of commands explain\n");
    return;
  }
  const recording::JointDeviation worst = farthest(&recording::JointDeviation::unexplained);
  fmt::print("DIFFERS: at t = {:.4g} s joint '{}' is off by {:.3g} more than the times of commands explain\n",
             worst.unexplained_time, worst.joint, worst.unexplained);
}

void print_report(const recording::ReplayReport& report, double largest) {
  fmt::print("{} commands given, {} states compared, {} steps\n", report.commands, report.states, report.steps);
  if (report.refused > 0) fmt::print("{} commands refused; the first: {}\n", report.refused, report.first_refusal);
  const bool has_times = report.other_times.replays > 0;
  fmt::print("{:<24} {:>28} {:>28}{}\n", "largest difference", "position [rad, m] at [s]", "velocity [/s] at [s]",
             has_times ? " explained by times" : "");
  for (const recording::JointDeviation& joint : report.joints) {
    fmt::print("{:<24} {:>18.3g} {:>9.4g} {:>18.3g} {:>9.4g}", joint.joint, joint.position, joint.position_time,
               joint.velocity, joint.velocity_time);
    if (has_times) fmt::print(" {:>18.3g}", joint.by_times);
    fmt::print("\n");
  }
  print_verdict(report, largest);
}

int replay(const ReplayArguments& arguments) {
  const std::string page = page_path(arguments.page, arguments.scene, "_replay");
  Simulation simulation = load_simulation(arguments.scene, arguments.simulation);
  try {
    if (!arguments.resume.empty()) read_checkpoint(simulation, arguments.resume);
  } catch (const std::runtime_error& error) {
    throw InputError(std::string("flexarm: ") + error.what());
  }
  try {
    recording::ReplayOptions options = arguments.replay;
    std::optional<BothRuns> runs;
    if (!page.empty()) {
      runs.emplace(simulation);
      options.on_state = [&](const Simulation& replayed, const auto& recorded) { runs->keep(replayed, recorded); };
    }
    const recording::ReplayReport report = recording_library().replay(std::move(simulation), options);
    print_report(report, arguments.replay.largest);
    if (runs) write_page(arguments.page, page, runs->encode(), stdout);
    return report.agrees(arguments.replay.largest) ? kDone : kFailed;
  } catch (const std::invalid_argument& error) {
    throw InputError(std::string("flexarm: ") + error.what());
  }
}

}  // namespace

void add_replay(CommandLine& line) {
  const auto arguments = std::make_shared<ReplayArguments>();
  Command& command =
      line.command("replay", "Repeats the commands of a recorded run, and compares the motion of the joints");
  command.argument("bag", arguments->replay.bag, "bag recorded with rosbag").check(check_existing_file);
  add_scene(command, arguments->scene);
  command.heading("The run");
  command.option("--namespace", arguments->replay.ns, "namespace of the arm's topics, such as /left");
  command.flag("--lock-step", arguments->replay.lock_step,
               "each command made one step in the recorded run (~lock_step)");
  command
      .option("--real-time-factor", arguments->replay.real_time_factor,
              "of the recorded run; has no effect if the bag has /clock")
      .shows_default()
      .check(check_positive);
  command.option("--command-timeout", arguments->replay.command_timeout, "of the recorded run [s]; 0: none")
      .shows_default()
      .check(check_non_negative);
  command
      .option("--stop-duration", arguments->replay.stop_duration,
              "of the recorded run: time in which an empty trajectory stops the joints [s]; 0: at once")
      .shows_default()
      .check(check_non_negative);
  command.option("--step", arguments->simulation.step, "of the recorded run, if it was not the scene's [s]")
      .check(check_positive);
  command.option("--scheme", arguments->simulation.scheme, "of the recorded run, if it was not the scene's")
      .choices(scheme_choices());
  command
      .option("--resume", arguments->resume,
              "state file with which the recorded run began; by default the scene's start")
      .shown_as("FILE");
  command.heading("Comparison");
  command.option("--largest", arguments->replay.largest, "difference of positions up to which the runs agree [rad, m]")
      .shows_default()
      .check(check_non_negative);
  command
      .option("--timing", arguments->replay.timing,
              "number of steps by which commands may have acted earlier or later than recorded")
      .shows_default()
      .check(whole_number_between(0, 1000));
  add_page(command, arguments->page);
  command.runs([arguments] { return replay(*arguments); });
}

}  // namespace flexarm::cli
