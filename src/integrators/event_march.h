#pragma once
/// Repeats a sub-step of a run in pieces that end at its events, where the equations change. This yields derivatives
/// over events. (docs/notes/sensitivities.md 3)

#include <string>
#include <vector>

#include "integrators/event_modes.h"
#include "integrators/newton.h"
#include "integrators/step_system.h"
#include "joints/joint_kinematics.h"

namespace flexarm {

/// A law with corners: one side of a stop, or dry friction of a carrier. It has several stages, and is smooth in each.
struct Corner {
  bool is_friction = false;
  int coordinate = -1;  ///< of the stop, or the carrier's coordinate
  int place = 0;        ///< stop: 0 for the lower, 1 for the upper; friction: index of the carrier
  double damping = 0;   ///< of the stop's damper
};

/// An event, at which a law changes its stage. There a neighbour's state changes by s+ = s- + jump dt, with dt =
/// -(guard of the neighbour - guard of the run) / slope.
struct Crossing {
  double time = 0;  ///< [s]
  std::size_t corner = 0;
  int from = 0, to = 0;                       ///< stages
  bool jumps = false;                         ///< whether rates jump; otherwise derivatives are continuous
  double guard = 0, slope = 0;                ///< of the run: its guard, zero at the event, and the guard's rate
  const std::vector<double>* jump = nullptr;  ///< jump of the rates of all state numbers (model/state_numbers.h)
  std::string doubt;                          ///< why the derivative of the event's time is unreliable; else empty
};

/// Interface for an object that is told about each piece and each event of a march.
class MarchFollower {
 public:
  virtual ~MarchFollower() = default;
  /// The equations of a piece that begins at `state` are solved. The solution is accepted afterwards.
  virtual void follow_piece(const State& state, const StepSystem& solved) = 0;
  virtual void cross(const Crossing& crossing) = 0;
};

/// Locates events of stops and dry friction. Between events the branches of these laws are fixed, so that the motion is
/// a smooth function of time and of the initial state.
class EventMarch {
 public:
  /// The model must outlive this.
  EventMarch(const Model& model, const Scheme& scheme);

  bool has_corners() const { return !corners_.empty(); }
  const Corner& corner(std::size_t index) const { return corners_[index]; }
  /// The branches that hold now; neighbours refer to them.
  const EventModes& modes() const { return modes_; }
  const std::vector<int>& stages() const { return stages_; }
  void set_stages(const std::vector<int>& stages);
  /// Sets all stages to those that a state has.
  void restart(const State& state);
  /// Whether a step that was solved from `state` has to be repeated in pieces: it contains an event, or a hit. In a
  /// hit, errors of the steps would be divided by the short duration of the hit.
  bool is_wanted(const State& state, const StepSystem& solved);
  /// Whether a coordinate oscillates on a stop in that state, with the given stages; null: the stages that the state
  /// has.
  bool is_hit(const State& state, const std::vector<int>* stages);
  /// Advances `state` by `length` [s], with `pieces` equal pieces between events. Returns the reason if that fails,
  /// otherwise an empty string.
  std::string go(State& state, double length, int pieces, MarchFollower& follower);
  /// The guard of a stage in a state of a similar model: > 0 within the stage, 0 at its end. Not for friction that
  /// sticks.
  double guard(std::size_t corner, int stage, const Model& model, const State& state);

  /// Stages of stops: out of contact, in contact, and inside but without force. Stages of friction are the sign of its
  /// slip, 0 while it sticks.
  enum Stage {
    kOut = static_cast<int>(StopStage::Out),
    kIn = static_cast<int>(StopStage::In),
    kReleased = static_cast<int>(StopStage::Released)
  };

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  /// The reaction that dry friction exerts on a sticking carrier, and its capacity, at the end of the last piece.
  struct Hold {
    double reaction = 0, capacity = 0, before = 0;
    int pieces = 0;
  };
  StopReach reach(const Corner& corner, const Model& model, const State& state);
  void set_stage(std::size_t corner, int stage);
  bool solve(const State& state, double step);
  void note_holds();
  bool advance(State& state, double step);
  /// Advances `pieces` times. Stops after the first piece in which a corner leaves its stage, and sets `left` and
  /// `piece`.
  bool run(State& state, double length, int pieces, std::size_t& left, int& piece);
  std::size_t violated(const State& state);
  double guard_now(std::size_t corner, const State& state);
  bool guard_after(const State& start, double length, int pieces, std::size_t corner, double& guard);
  bool locate(const State& start, double begin, double end, int pieces, std::size_t corner, double& length);
  bool find_next(const State& start, double left, int pieces, std::size_t& corner, double& length);
  bool march(State& state, double length, int pieces, MarchFollower& follower);
  int next_stage(std::size_t corner, State& state, double step);
  bool find_jump(const State& state, const EventModes& before, double step, Crossing& crossing);
  bool find_rate_slope(const State& state, const EventModes& before, double step, Crossing& crossing);
  bool cross(State& state, std::size_t corner, double step, double piece, MarchFollower& follower);

  const Model& model_;
  bool at_end_;
  StepSettings settings_;
  StepSystem system_;
  NewtonIteration newton_;
  std::vector<Corner> corners_;
  std::vector<int> stages_;
  std::vector<Hold> holds_;  // per carrier
  EventModes modes_, before_;
  State trial_, other_;
  std::vector<double> jump_, first_, second_, third_;
  double last_jump_time_ = 0;
  std::size_t last_jump_ = kNone;
  StateRates rate_;
};

}  // namespace flexarm
