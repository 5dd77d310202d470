#include "bench/effort_schedule.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace flexarm::bench {
namespace {

/// The words of `key: value` or `key: [value, ...]` in a line; none where the key is missing.
std::vector<std::string> values_of(const std::string& line, const std::string& key) {
  std::smatch match;
  const std::regex pattern("\\b" + key + ": *(?:\\[([^\\]]*)\\]|([^,}\\s]+))");
  if (!std::regex_search(line, match, pattern)) return {};
  std::istringstream words(std::regex_replace(match[1].str() + match[2].str(), std::regex(","), " "));
  return {std::istream_iterator<std::string>(words), {}};
}

double number(const std::string& word) {
  std::size_t used = 0;
  const double value = std::stod(word, &used);
  if (used != word.size()) throw std::invalid_argument(word);
  return value;
}

double number_of(const std::string& line, const std::string& key) {
  const std::vector<std::string> values = values_of(line, key);
  if (values.size() != 1) throw std::invalid_argument(key);
  return number(values[0]);
}

double number_of(const std::string& line, const std::string& key, double otherwise) {
  return values_of(line, key).empty() ? otherwise : number_of(line, key);
}

void append_pulses(const std::string& line, std::vector<EffortPulse>& pulses) {
  const std::vector<std::string> names = values_of(line, "names"), efforts = values_of(line, "efforts");
  if (names.empty() || names.size() != efforts.size()) throw std::invalid_argument("names");
  const double time = number_of(line, "time"), duration = number_of(line, "duration"),
               repeat = number_of(line, "repeat", 1), every = number_of(line, "every", 0);
  for (std::size_t i = 0; i < names.size(); ++i)
    for (int k = 0; k < repeat; ++k) {
      const double begin = time + k * every;
      pulses.push_back({names[i], begin, begin + duration, number(efforts[i])});
    }
}

}  // namespace

std::vector<EffortPulse> read_effort_schedule(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(fmt::format("cannot read '{}'", path));
  std::vector<EffortPulse> pulses;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::size_t first = line.find_first_not_of(' ');
    if (first == std::string::npos || line[first] != '-') continue;
    try {
      append_pulses(line, pulses);
    } catch (const std::logic_error& error) {
      throw std::runtime_error(
          fmt::format("{}:{}: expected {{time: s, names: [joint, ...], efforts: [N m, ...], duration: s}} on one line, "
                      "got '{}' ({})",
                      path, number, line.substr(first), error.what()));
    }
  }
  if (pulses.empty()) throw std::runtime_error(fmt::format("{}: expected at least one command", path));
  return pulses;
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
  // Times of steps are sums: what a pulse has of a step but for their round-off is all or nothing.
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

}  // namespace flexarm::bench
