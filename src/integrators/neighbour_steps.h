#pragma once
/// Steps neighbours of a run, which have slightly different parameters or initial states. Differences of neighbours
/// yield the derivatives of the run. (docs/notes/sensitivities.md)

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "flexarm/model/run_event.h"
#include "integrators/event_march.h"
#include "integrators/step_follower.h"
#include "integrators/step_system.h"

namespace flexarm {

/// A run of a similar mechanism with slightly other parameters or another initial state.
struct Neighbour {
  double offset = 0;                   ///< distance from the run, in units of Direction::difference
  double weight = 0;                   ///< weight in the derivative: of its deviation / Direction::difference
  std::unique_ptr<StepSystem> system;  ///< of its own model; null: it has the same model as the run
  State state;
};

/// A parameter or initial state, and the derivative of the run's state with respect to it.
struct Direction {
  double difference = 0;             ///< in the unit of the parameter or of the initial state
  bool has_free_difference = false;  ///< it may be changed in any step, since neighbours have the model of the run
  std::vector<Neighbour> neighbours;
  std::vector<double> derivative = {};  ///< of all numbers of the state (model/state_numbers.h), see measure()
};

/// Steps neighbours beside a run. Each sub-step of a neighbour is solved by Newton's method with the factors of the
/// run's tangent. Every few sub-steps neighbours are put back to the state of the run, +- difference times the
/// derivative, so that they stay close to it during a long run. Sub-steps with events of stops and dry friction are
/// repeated in pieces, which account for the change of the event's time (EventMarch). Allocates no memory after
/// neighbours were put back for the first time, except for the list of events.
class NeighbourSteps : public StepFollower, private MarchFollower {
 public:
  /// For runs of that model and scheme; the model must outlive this object.
  /// @throws ModelError if the scheme has no derivatives.
  NeighbourSteps(const Model& model, const Scheme& scheme);

  std::vector<Direction>& directions() { return directions_; }
  const std::vector<Direction>& directions() const { return directions_; }
  /// Why the derivatives were lost; empty if they are valid.
  const std::string& lost() const { return lost_; }
  void lose(const std::string& why) {
    if (lost_.empty()) lost_ = why;
  }
  /// All events so far, in chronological order.
  const std::vector<RunEvent>& events() const { return events_; }
  /// Brings the neighbours to the end of the last step, where the run is in `state`. To be called before they are read.
  void settle(const State& state);
  /// Whether the run is in a hit. During a hit the models of neighbours must not be replaced.
  bool is_in_hit() const { return is_in_hit_; }

  /// Computes Direction::derivative from the states of the neighbours and that of the run, `state`.
  void measure(Direction& direction, const State& state);
  /// Places the neighbours beside the run, which is in `state`, according to difference and derivative.
  void place(Direction& direction, const State& state);
  /// Best distance of neighbours whose difference may be chosen. It balances two errors: the third derivative of beams,
  /// (distance / radius of gyration)^2, and the round-off of velocities, round-off / step / distance.
  static constexpr double kDistance = 1e-5;
  /// Distance of the neighbours from the run, which is in `state`: the largest displacement divided by the model's
  /// length scale, or rotation [rad]. Includes the displacements due to velocities over `step` [s].
  double distance(const Direction& direction, const State& state, double step) const;

  void begin_step() override;
  void end_step(double duration) override;
  void keep() override;
  void take_back() override;
  void follow(const State& state, const StepSystem& solved) override;

 private:
  void follow_piece(const State& state, const StepSystem& solved) override;
  void cross(const Crossing& crossing) override;
  /// The repetition of a run over events and hits with one number of pieces, and its neighbours in their order.
  struct Way {
    State ahead;
    std::vector<State> neighbours;
    std::vector<int> stages;
  };
  void go_over_events(const State& state, double step);
  void go_on(Way& way, double step, int pieces);
  void start_ways(const State& state);
  void obey(Way& way, const State& state);
  bool hit_goes_on(const State& state);
  void jump(Neighbour& neighbour, const Crossing& crossing);
  void note_motors(const State& state);
  void note_hits(const State& state);
  void note_stops(const State& state, const StepSystem& solved);
  void put_beside(Direction& direction, const State& state, double step);
  void place_slaves(Neighbour& neighbour);
  void hold_modes(StepSystem& system, const StepSystem& solved) const;
  bool make_factors(const State& state, const StepSystem& solved);
  /// Steps a neighbour. Returns the reason if that fails, otherwise an empty string.
  std::string advance(Neighbour& neighbour, const State& state, const StepSystem& solved);
  /// Returns false if the iteration does not converge.
  bool solve(StepSystem& system);
  template <class Visit>
  void for_each_neighbour(const Visit& visit) {
    for (Direction& direction : directions_)
      for (Neighbour& neighbour : direction.neighbours) visit(neighbour);
  }

  const Model& model_;
  StepSystem system_;  // same model as the run's; contains the factors for all neighbours
  std::vector<Direction> directions_;
  std::string lost_;
  double factorised_step_ = 0;  // step size for which the factors are valid [s]; 0: no factors
  long followed_ = 0;           // number of sub-steps
  bool was_led_ = false;        // in the last sub-step (StepConfiguration::lead())
  int updates_ = 0;             // in the present sub-step, of all neighbours
  // Increments of the run in the present sub-step, and the expected increments of a neighbour.
  IncrementHistory made_, guess_;
  Eigen::VectorXd update_;
  std::vector<NodePose> poses_;  // scratch
  std::vector<double> numbers_;  // scratch
  std::vector<State> kept_;      // states at the beginning of a step that may be taken back
  // ---- events
  std::unique_ptr<EventMarch> march_;  // null if there can be no events
  std::array<Way, 2> ways_;            // the second one has twice as many pieces
  State begin_;                        // of the present sub-step of a way
  bool is_ahead_ = false;              // states of neighbours belong to ways, not to the run
  bool is_in_hit_ = false;             // the ways continue in the next sub-step
  double hit_begin_ = 0;               // [s]
  double longest_hit_ = 0;             // [s]
  bool notes_events_ = false;
  std::vector<std::vector<double>> coarse_;  // per direction: derivative by the first way
  std::vector<double> motor_rests_;
  std::vector<char> touches_;  // per force element
  std::vector<RunEvent> events_;
};

}  // namespace flexarm
