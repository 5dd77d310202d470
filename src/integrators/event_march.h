#pragma once
/// A sub-step of a run once more, in pieces that end where its equations change. (docs/notes/sensitivities.md 3)

#include <string>
#include <vector>

#include "integrators/event_modes.h"
#include "integrators/newton.h"
#include "integrators/step_system.h"

namespace flexarm {

/// A law with a corner: one side of a stop, or dry friction. What it does has stages, in each of which it is smooth.
struct Corner {
  bool is_friction = false;
  int coordinate = -1;  ///< of the stop, or that carries the friction
  int place = 0;        ///< of a stop 0 below, 1 above; of friction its carrier
  double damping = 0;   ///< of a stop's damper
};

/// Where equations change: s+ = s- + jump dt, with dt = -(guard - guard of the run) / slope of a neighbour.
struct Crossing {
  double time = 0;  ///< [s]
  std::size_t corner = 0;
  int from = 0, to = 0;                       ///< stages
  bool jumps = false;                         ///< else derivatives are continuous
  double guard = 0, slope = 0;                ///< of the run: it vanishes at the event, and its rate
  const std::vector<double>* jump = nullptr;  ///< of the rates of a state's numbers (model/state_numbers.h)
  std::string doubt;                          ///< why the derivative of its time is not to be trusted; empty: it is
};

/// Sees what the march does.
class MarchFollower {
 public:
  virtual ~MarchFollower() = default;
  /// The equations of a piece that begins at `state` are solved, and about to be accepted.
  virtual void follow_piece(const State& state, const StepSystem& solved) = 0;
  virtual void cross(const Crossing& crossing) = 0;
};

/// Locates events of stops and dry friction. Between them branches are held, so that all is smooth in time and start.
class EventMarch {
 public:
  /// The model must outlive this.
  EventMarch(const Model& model, const Scheme& scheme);

  bool has_corners() const { return !corners_.empty(); }
  const Corner& corner(std::size_t index) const { return corners_[index]; }
  /// Those that hold now; neighbours refer to them.
  const EventModes& modes() const { return modes_; }
  const std::vector<int>& stages() const { return stages_; }
  void set_stages(const std::vector<int>& stages);
  /// Stages as a state shows them.
  void restart(const State& state);
  /// True where a step that was solved from `state` is to be gone in pieces: an event is in it, or a hit, in which what
  /// steps are off by would be divided by how long it lasts.
  bool is_wanted(const State& state, const StepSystem& solved);
  /// True where something swings on a stop in that state, at these stages or, null, at those that the state shows.
  bool is_hit(const State& state, const std::vector<int>* stages);
  /// Goes from `state` over `length` [s], by `pieces` equal ones between events. Why it does not come there, or
  /// nothing.
  std::string go(State& state, double length, int pieces, MarchFollower& follower);
  /// Of a like model's state: > 0 in the stage, 0 where it ends. Of friction that sticks there is none.
  double guard(std::size_t corner, int stage, const Model& model, const State& state);

  /// Stages of stops; those of friction are the signs of its slip, 0 where it sticks.
  enum Stage { kOut = 0, kIn = 1, kReleased = 2 };

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  /// By which it is held against slipping, at the end of the last piece.
  struct Hold {
    double reaction = 0, capacity = 0, before = 0;
    int pieces = 0;
  };
  StopReach reach(const Corner& corner, const Model& model, const State& state);
  double rate(const Model& model, const State& state, int coordinate);
  void set_stage(std::size_t corner, int stage);
  bool solve(const State& state, double step);
  void note_holds();
  bool advance(State& state, double step);
  /// The same over so many pieces, and the first corner that leaves its stage in them, with its piece.
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
  double contact_time_;
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
  std::vector<NodePose> poses_;
  std::vector<Vector6> velocities_;
};

}  // namespace flexarm
