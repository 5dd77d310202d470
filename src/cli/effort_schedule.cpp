#include "cli/effort_schedule.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "flexarm/scene/scene_description.h"

namespace flexarm::cli {
namespace {

template <class T>
T value_of(const YAML::Node& command, const char* key, T otherwise) {
  return command[key] ? command[key].as<T>() : otherwise;
}

void append_pulses(const YAML::Node& command, std::vector<EffortPulse>& pulses) {
  const auto names = command["names"].as<std::vector<std::string>>();
  const auto efforts = command["efforts"].as<std::vector<double>>();
  if (names.empty() || names.size() != efforts.size())
    throw YAML::RepresentationException(command.Mark(), "one effort for each name");
  const double time = command["time"].as<double>(), duration = command["duration"].as<double>(),
               every = value_of(command, "every", 0.0);
  const int repeat = value_of(command, "repeat", 1);
  for (std::size_t i = 0; i < names.size(); ++i)
    for (int k = 0; k < repeat; ++k) {
      const double begin = time + k * every;
      pulses.push_back({names[i], begin, begin + duration, efforts[i]});
    }
}

EffortSchedule schedule_of(const YAML::Node& file, const std::string& path) {
  EffortSchedule schedule;
  schedule.period = value_of(file, "period", 0.0);
  for (const YAML::Node& command : file["commands"]) {
    try {
      append_pulses(command, schedule.pulses);
    } catch (const YAML::Exception& error) {
      throw std::runtime_error(fmt::format(
          "{}:{}: expected {{time: s, names: [joint, ...], efforts: [N m, ...], duration: s}}, got '{}' ({})", path,
          command.Mark().line + 1, YAML::Dump(command), error.msg));
    }
  }
  if (schedule.pulses.empty()) throw std::runtime_error(fmt::format("{}: expected at least one command", path));
  return schedule;
}

}  // namespace

EffortSchedule read_effort_schedule(const std::string& path) {
  try {
    return schedule_of(YAML::LoadFile(path), path);
  } catch (const YAML::BadFile&) {
    throw std::runtime_error(fmt::format("cannot read '{}'", path));
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(fmt::format("{}:{}: {}", path, error.mark.line + 1, error.msg));
  }
}

EffortPlayer::EffortPlayer(const std::vector<EffortPulse>& pulses, const Simulation& simulation) {
  for (const EffortPulse& pulse : pulses) {
    const std::optional<std::size_t> coordinate = simulation.find_coordinate(pulse.joint);
    if (!coordinate || !simulation.is_commandable(*coordinate))
      throw std::runtime_error(fmt::format("a command names '{}', which is not a joint of '{}' that takes efforts",
                                           pulse.joint, simulation.scene().name));
    auto track = std::find_if(tracks_.begin(), tracks_.end(),
                              [&](const Track& candidate) { return candidate.coordinate == *coordinate; });
    if (track == tracks_.end()) track = tracks_.insert(track, Track{*coordinate, {}});
    track->pulses.push_back(pulse);
  }
}

void EffortPlayer::command(Simulation& simulation) const {
  const double step = simulation.step_size(), begin = simulation.time(), end = begin + step;
  // Times of steps are sums with round-off. Pulses that overlap a step only by that much count as outside, or as full.
  constexpr double kRoundOff = 1e-6;
  for (const Track& track : tracks_) {
    double effort = 0;
    for (const EffortPulse& pulse : track.pulses) {
      const double part = (std::min(end, pulse.end) - std::max(begin, pulse.begin)) / step;
      if (part > kRoundOff) effort += pulse.effort * (part > 1 - kRoundOff ? 1.0 : part);
    }
    simulation.command_effort(track.coordinate, effort);
  }
}

std::function<std::function<void(Simulation&)>(const Simulation&)> effort_commands(const std::string& path) {
  if (path.empty()) return [](const Simulation&) { return [](Simulation&) {}; };
  return [pulses = read_effort_schedule(path).pulses](const Simulation& simulation) {
    return [player = EffortPlayer(pulses, simulation)](Simulation& commanded) { player.command(commanded); };
  };
}

}  // namespace flexarm::cli
