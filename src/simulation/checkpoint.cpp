#include "flexarm/simulation/checkpoint.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace flexarm {
namespace {

constexpr const char* kHeader = "flexarm-checkpoint 5";

/// Calls `visit(number, may_be_nan)` for every number of a state in a fixed order; the one place that knows its layout.
template <class AnyState, class Visit>
void for_each_number(AnyState& state, const Visit& visit) {
  const auto vector = [&](auto& v) {
    for (int k = 0; k < v.size(); ++k) visit(v[k], false);
  };
  const auto quaternion = [&](auto& q) { vector(q.coeffs()); };
  visit(state.time, false);
  for (auto& node : state.nodes) {
    vector(node.position);
    quaternion(node.orientation);
    vector(node.velocity);
    vector(node.angular_velocity);
    vector(node.acceleration);
    vector(node.angular_acceleration);
  }
  for (auto& released : state.released) {
    vector(released.displacement);
    quaternion(released.rotation);
  }
  for (auto& point : state.mass_points) {
    vector(point.angular_velocity);
    vector(point.angular_acceleration);
  }
  for (auto& rate : state.strain_rates) vector(rate);
  for (auto& command : state.commands) visit(command, true);  // nan: none holds
  for (auto& effort : state.efforts) visit(effort, false);
  for (auto& rest : state.rests) visit(rest, false);
  for (auto& made : state.history.increments)
    for (auto& increment : made) visit(increment, false);
  for (auto& step : state.history.steps) visit(step, false);
  visit(state.work, false);
  visit(state.dissipated, false);
  visit(state.energy_defect, false);
  for (auto& memory : state.strain_memory) {
    vector(memory.average);
    vector(memory.rate);
    vector(memory.delayed_rate);
  }
  for (auto* points : {&state.stiffness_rotations, &state.mass_rotations})
    for (auto& point : *points) {
      for (int k = 0; k < 9; ++k) visit(point.rotation(k / 3, k % 3), false);
      vector(point.curvature);
    }
  for (auto& rotation : state.total_rotations) vector(rotation);
  for (auto& force : state.forces) vector(force);
  for (auto& reaction : state.reactions) vector(reaction);
  for (auto& rate : state.momentum_rates) vector(rate);
}

/// What must agree for a state to fit a simulation.
std::string signature(const Simulation& simulation) {
  const State& state = simulation.state();
  const std::size_t kept = state.strain_memory.size() + state.stiffness_rotations.size() + state.mass_rotations.size() +
                           state.total_rotations.size();
  return fmt::format("{} nodes {} joints {} mass_points {} coordinates {} kept {}", simulation.scheme(),
                     state.nodes.size() - state.left_lines.size(), state.released.size(), state.mass_points.size(),
                     state.commands.size(), kept);
}

/// What is kept per node, for another number of nodes.
void resize_nodes(State& state, std::size_t count) {
  if (!state.total_rotations.empty()) state.total_rotations.resize(count, Vector3::Zero());
  if (!state.forces.empty()) state.forces.resize(count, Vector6::Zero());
  if (!state.momentum_rates.empty())
    state.momentum_rates.resize(state.momentum_rates.size() - state.nodes.size() + count, Vector3::Zero());
  state.nodes.resize(count);
}

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw std::runtime_error("checkpoint '" + path + "': " + what);
}

double parse(const std::string& token, const std::string& path) {
  const bool negative = token[0] == '-';
  const char* begin = token.data() + (negative ? 1 : 0);
  const char* end = token.data() + token.size();
  double value = 0;
  const auto result = std::from_chars(begin, end, value, std::chars_format::hex);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
    fail(path, "'" + token + "' is not a finite hexadecimal number");
  return negative ? -value : value;
}

/// std::to_chars in hexadecimal has no "0x", as std::from_chars expects.
std::string hexadecimal(double value) {
  if (std::isnan(value)) return "nan";
  char buffer[64];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::hex);
  return {buffer, result.ptr};
}

}  // namespace

void write_checkpoint(const Simulation& simulation, const std::string& path) {
  const State& state = simulation.state();
  std::string text =
      fmt::format("{}\n{}\nsteps {} level {} good {} increments {} of {} order {} reactions {} left {} {}\n", kHeader,
                  signature(simulation), state.steps, state.halving_level, state.good_steps,
                  state.history.increments[0].size(), state.history.count, state.history.order, state.reactions.size(),
                  state.left_lines.size(), fmt::join(state.left_lines, " "));
  for_each_number(state, [&](double value, bool) { text += hexadecimal(value) + "\n"; });
  text += "end\n";
  const std::string temporary = path + ".partial";
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  if (!out) fail(path, "cannot be written");
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail(path, "cannot be renamed from '" + temporary + "'");
}

void read_checkpoint(Simulation& simulation, const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(path, "cannot be opened");
  std::string header, model;
  std::getline(in, header);
  std::getline(in, model);
  if (header != kHeader)
    fail(path, "expected the first line '" + std::string(kHeader) + "', got '" + header.substr(0, 60) + "'");
  if (model != signature(simulation))
    fail(path, "belongs to another model or scheme: expected '" + signature(simulation) + "', got '" +
                   model.substr(0, 120) + "'");
  State state = simulation.state();
  std::string word;
  IncrementHistory& history = state.history;
  std::size_t increments = 0, reactions = 0, left = 0;
  in >> word >> state.steps >> word >> state.halving_level >> word >> state.good_steps >> word >> increments >> word >>
      history.count >> word >> history.order >> word >> reactions >> word >> left;
  const auto damaged = [&] { fail(path, "is damaged in line 3"); };
  if (!in || state.steps < 0 || state.halving_level < 0 || left > state.released.size()) damaged();
  resize_nodes(state, state.nodes.size() - state.left_lines.size() + left);
  state.left_lines.resize(left);
  for (int& joint : state.left_lines) in >> joint;
  if (!in || increments > 6 * state.nodes.size() + 6 * state.released.size() || reactions > state.nodes.size() ||
      history.count < 0 || history.count > IncrementHistory::kLength || history.order < 0 ||
      history.order > IncrementHistory::kHighestOrder)
    damaged();
  state.reactions.assign(reactions, Vector6::Zero());
  for (std::vector<double>& made : history.increments) made.assign(increments, 0.0);
  for_each_number(state, [&](double& value, bool may_be_nan) {
    if (!(in >> word)) fail(path, "ends too early");
    value = may_be_nan && word == "nan" ? std::nan("") : parse(word, path);
  });
  if (!(in >> word) || word != "end") fail(path, "is damaged at its end");
  simulation.restore(state);
}

}  // namespace flexarm
