#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/recording_library.h"
#include "cli/scene_input.h"
#include "flexarm/simulation/checkpoint.h"

namespace flexarm::cli {
namespace {

struct ReplayArguments {
  SceneInput scene;
  SimulationOptions simulation;
  recording::ReplayOptions replay;
  std::string resume;
};

/// "up to 1 step earlier or later"
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
  fmt::print("The bag does not tell in which step a command acted: {} replays in which each acts {} than by its time\n",
             report.other_times.replays, shifts_text(report.other_times));
  fmt::print("differ from this one by \"explained by times\".\n");
  if (agrees) {
    fmt::print("agrees within what the times of commands explain\n");
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
  Simulation simulation = load_simulation(arguments.scene, arguments.simulation);
  try {
    if (!arguments.resume.empty()) read_checkpoint(simulation, arguments.resume);
  } catch (const std::runtime_error& error) {
    throw InputError(std::string("flexarm: ") + error.what());
  }
  try {
    const recording::ReplayReport report = recording_library().replay(std::move(simulation), arguments.replay);
    print_report(report, arguments.replay.largest);
    return report.agrees(arguments.replay.largest) ? kDone : kFailed;
  } catch (const std::invalid_argument& error) {
    throw InputError(std::string("flexarm: ") + error.what());
  }
}

}  // namespace

void add_replay(CommandLine& line) {
  const auto arguments = std::make_shared<ReplayArguments>();
  Command& command = line.command(
      "replay", "Gives the commands of a recorded run to the scene again, and compares the joints' motion");
  command.argument("bag", arguments->replay.bag, "recorded by rosbag").check(check_existing_file);
  add_scene(command, arguments->scene);
  command.heading("The run");
  command.option("--namespace", arguments->replay.ns, "of the arm's topics, /left say");
  command.flag("--lock-step", arguments->replay.lock_step, "each command has made one step (~lock_step)");
  command
      .option("--real-time-factor", arguments->replay.real_time_factor,
              "of the run; where it was the clock itself (/clock is in the bag) it does not matter")
      .shows_default()
      .check(check_positive);
  command.option("--command-timeout", arguments->replay.command_timeout, "of the run [s]; 0: none")
      .shows_default()
      .check(check_non_negative);
  command
      .option("--stop-duration", arguments->replay.stop_duration,
              "of the run: in which joints decelerate that an empty trajectory stops [s]; 0: at once")
      .shows_default()
      .check(check_non_negative);
  command.option("--step", arguments->simulation.step, "of the run, if it was not the scene's [s]")
      .check(check_positive);
  command.option("--scheme", arguments->simulation.scheme, "the same").choices(scheme_choices());
  command.option("--resume", arguments->resume, "state file of the beginning; else it is the scene's").shown_as("FILE");
  command.heading("Comparison");
  command.option("--largest", arguments->replay.largest, "difference of positions up to which the runs agree [rad, m]")
      .shows_default()
      .check(check_non_negative);
  command
      .option("--timing", arguments->replay.timing,
              "steps by which a command may have acted earlier or later than the bag's times say")
      .shows_default()
      .check(whole_number_between(0, 1000));
  command.runs([arguments] { return replay(*arguments); });
}

}  // namespace flexarm::cli
