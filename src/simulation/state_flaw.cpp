#include "simulation/state_flaw.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "model/state_numbers.h"

namespace flexarm {
namespace {

/// Steps normalise quaternions to within some units of round-off. The tolerance leaves room for states from other
/// sources.
constexpr double kUnitTolerance = 1e-12;

/// Keeps the first flaw found.
class Flaw {
 public:
  void require(bool ok, const char* what, double value, const std::string& expected) {
    if (!ok && text_.empty()) text_ = fmt::format("{} is {}, expected {}", what, value, expected);
  }
  void require_range(const char* what, double value, double least, double most) {
    require(value >= least && value <= most, what, value, fmt::format("{} to {}", least, most));
  }
  void require_size(const char* what, std::size_t size, std::size_t expected) {
    require(size == expected, what, static_cast<double>(size), std::to_string(expected));
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void check_left_lines(const Model& built, const State& state, Flaw& flaw) {
  for (auto left = state.left_lines.begin(); left != state.left_lines.end(); ++left) {
    const bool leaves = *left >= 0 && *left < static_cast<int>(built.joints.size()) && built.joints[*left].leaving >= 0;
    flaw.require(leaves, "a joint that has left its line", *left, "one that may leave it");
    flaw.require(std::find(state.left_lines.begin(), left, *left) == left, "a joint that has left its line", *left,
                 "each at most once");
  }
}

void check_sizes(const State& initial, const State& state, Flaw& flaw) {
  const std::size_t left = state.left_lines.size();
  const auto of_nodes = [&](std::size_t initial_size) { return initial_size == 0 ? 0 : initial_size + left; };
  flaw.require_size("the number of nodes", state.nodes.size(), of_nodes(initial.nodes.size()));
  flaw.require_size("the number of joints", state.released.size(), initial.released.size());
  flaw.require_size("the number of mass points", state.study.mass_points.size(), initial.study.mass_points.size());
  flaw.require_size("the number of strain rates", state.study.strain_rates.size(), initial.study.strain_rates.size());
  flaw.require_size("the number of strains of Maxwell elements", state.branch_strains.size(),
                    initial.branch_strains.size());
  flaw.require_size("the number of commands", state.commands.size(), initial.commands.size());
  flaw.require_size("the number of efforts", state.efforts.size(), initial.efforts.size());
  flaw.require_size("the number of impulses of motions", state.drives.impulse.size(), initial.drives.impulse.size());
  for (const std::vector<double>& means : state.drives.means)
    flaw.require_size("the number of efforts of motions", means.size(), initial.efforts.size());
  flaw.require_range("the number of past efforts of motions", state.drives.count, 0, StepMeans::kLength);
  flaw.require_size("the number of impulses of joints", state.transmitted.impulse.size(),
                    initial.transmitted.impulse.size());
  flaw.require_range("the number of past forces of joints", state.transmitted.count, 0, StepMeans::kLength);
  flaw.require_size("the number of samples", state.samples.size(), initial.samples.size());
  flaw.require_size("the number of marks of rest", state.rests.size(), initial.rests.size());
  flaw.require_size("the number of actuators", state.actuators.size(), initial.actuators.size());
  for (std::size_t i = 0; i < std::min(state.actuators.size(), initial.actuators.size()); ++i)
    flaw.require_size("the number of a servo's outputs", state.actuators[i].servo.outputs.size(),
                      initial.actuators[i].servo.outputs.size());
  flaw.require_size("the number of strain memories", state.strain_memory.size(), initial.strain_memory.size());
  flaw.require_size("the number of rotations of stiffness points", state.study.stiffness_rotations.size(),
                    initial.study.stiffness_rotations.size());
  flaw.require_size("the number of rotations of mass points", state.study.mass_rotations.size(),
                    initial.study.mass_rotations.size());
  flaw.require_size("the number of total rotations", state.study.total_rotations.size(),
                    of_nodes(initial.study.total_rotations.size()));
  flaw.require_size("the number of nodal forces", state.study.forces.size(), of_nodes(initial.study.forces.size()));
  flaw.require_size("the number of momentum rates", state.study.momentum_rates.size(),
                    of_nodes(initial.study.momentum_rates.size()));
  if (!state.study.reactions.empty())
    flaw.require_size("the number of reactions", state.study.reactions.size(), state.nodes.size());
}

void check_servos(const Model& built, const State& state, Flaw& flaw) {
  for (std::size_t i = 0; i < std::min(state.actuators.size(), built.actuators.size()); ++i) {
    const ServoState& servo = state.actuators[i].servo;
    const auto& description = built.actuators[i].servo;
    const double last = description ? static_cast<double>(description->laws.size()) - 1 : 0;
    flaw.require(servo.law == std::floor(servo.law) && servo.law >= 0 && servo.law <= last, "the mode of a servo",
                 servo.law, fmt::format("a whole number from 0 to {}", last));
    flaw.require(servo.law == 0 || !std::isnan(servo.set_point), "the set point of a servo", servo.set_point,
                 "a number if its mode has been switched");
  }
}

void check_held_joints(const Model& built, const State& state, Flaw& flaw) {
  for (std::size_t j = built.joints.size(); j < std::min(state.released.size(), built.initial_released.size()); ++j) {
    const double position = state.released[j].displacement[0], held = built.initial_released[j].displacement[0];
    flaw.require(position == held, "the position of a joint whose motion is constant", position,
                 fmt::format("{}", held));
  }
}

void check_wrenches(const Model& built, const State& state, Flaw& flaw) {
  for (const NodalLoad& wrench : state.wrenches) {
    flaw.require_range("the link of a wrench", wrench.link, -1, static_cast<double>(built.links.size()) - 1);
    flaw.require_range("the node of a wrench", wrench.node, 0, static_cast<double>(state.nodes.size()) - 1);
    for (const double number : {wrench.pull.stiffness, wrench.pull.damping})
      flaw.require(number >= 0, "the spring of a wrench", number, ">= 0");
  }
}

void check_history(const IncrementHistory& history, Flaw& flaw) {
  flaw.require_range("the number of past increments", history.count, 0, IncrementHistory::kLength);
  flaw.require_range("the order of extrapolation", history.order, IncrementHistory::kNoMotion,
                     IncrementHistory::kHighestOrder);
  for (int i = 0; i < std::min<int>(history.count, history.steps.size()); ++i) {
    flaw.require(history.steps[i] != 0, "the length of a past step", history.steps[i], "another number than 0");
    flaw.require_size("the number of increments of a past step", history.increments[i].size(),
                      history.increments[0].size());
  }
}

}  // namespace

std::string state_flaw(const Model& built, const State& initial, int finest_halving, const State& state) {
  Flaw flaw;
  check_left_lines(built, state, flaw);
  check_sizes(initial, state, flaw);
  check_servos(built, state, flaw);
  check_held_joints(built, state, flaw);
  check_wrenches(built, state, flaw);
  check_history(state.history, flaw);
  flaw.require(state.steps >= 0, "the number of steps", static_cast<double>(state.steps), "0 or more");
  flaw.require_range("the halving level", state.halving_level, 0, finest_halving);
  flaw.require(state.good_steps >= 0, "the number of good steps", state.good_steps, "0 or more");
  for_each_number(state, [&](const char* what, double number) {
    if (what == kCommand && std::isnan(number)) return;
    flaw.require(std::isfinite(number), what, number, "a finite number");
    flaw.require(what != kDuration || number >= 0, what, number, ">= 0");
  });
  const auto require_unit = [&](const char* what, const Quaternion& q) {
    flaw.require(std::abs(q.squaredNorm() - 1) <= kUnitTolerance, what, q.norm(), "1");
  };
  for (const NodeState& node : state.nodes) require_unit("the norm of a node's orientation", node.orientation);
  for (const Released& released : state.released) require_unit("the norm of a joint's rotation", released.rotation);
  const auto require_mark = [&](const char* what, double mark) {
    flaw.require(mark == 0 || mark == 1, what, mark, "0 or 1");
  };
  for (const double rest : state.rests) require_mark("a mark of rest", rest);
  for (const ActuatorState& actuator : state.actuators) {
    require_mark("a mark of rest", actuator.rest);
    require_mark("a mark of what is off", actuator.servo.off);
  }
  return flaw.text();
}

}  // namespace flexarm
