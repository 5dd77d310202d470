#pragma once
/// Neighbours of a run. Their steps are solved with the factors of the run's own tangent; the differences are
/// derivatives with respect to parameters and start. (docs/notes/sensitivities.md)

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "flexarm/model/run_event.h"
#include "integrators/event_march.h"
#include "integrators/step_follower.h"
#include "integrators/step_system.h"

namespace flexarm {

/// Another run of a like mechanism, close to the one whose derivative is sought.
struct Neighbour {
  double offset = 0;                   ///< how far it is off, in units of Direction::difference
  double weight = 0;                   ///< in the derivative: of how far off it has come, over Direction::difference
  std::unique_ptr<StepSystem> system;  ///< of its own model; null: it has that of the run
  State state;
};

/// What a run is differentiated by, and the derivative of its state as a difference of neighbours.
struct Direction {
  double difference = 0;             ///< in the parameter's unit, or that of the state's coordinate
  bool has_free_difference = false;  ///< it may be chosen anew in any step: neighbours have the run's own model
  std::vector<Neighbour> neighbours;
  std::vector<double> derivative = {};  ///< of all numbers of the state (model/state_numbers.h), see measure()
};

/// Takes neighbours along with a run. The derivative of a step's solution is what the equations of the neighbours come
/// to beside it, whose own Newton's method it is, with the factors of the run's tangent. Every few sub-steps
/// they are put anew to the state of the run, +- difference times the derivative: so they stay as close however long
/// the run is. Sub-steps with events of stops and dry friction they go in pieces, with the time of the event as it
/// changes (EventMarch). Allocates nothing once they have been put back for the first time, but for the list of events.
class NeighbourSteps : public StepFollower, private MarchFollower {
 public:
  /// Of a run of that model and scheme; the model must outlive this.
  /// @throws ModelError if the scheme has no derivatives.
  NeighbourSteps(const Model& model, const Scheme& scheme);

  std::vector<Direction>& directions() { return directions_; }
  const std::vector<Direction>& directions() const { return directions_; }
  /// Why there are no derivatives any more; empty: there are.
  const std::string& lost() const { return lost_; }
  void lose(const std::string& why) {
    if (lost_.empty()) lost_ = why;
  }
  /// In the order in which they came.
  const std::vector<RunEvent>& events() const { return events_; }
  /// Call it before you use the neighbours: the run has come to `state`.
  void settle(const State& state);
  /// True in a hit, which has a course of its own: models of neighbours must stay.
  bool is_in_hit() const { return is_in_hit_; }

  /// Direction::derivative from what the neighbours and the run, in `state`, have come to.
  void measure(Direction& direction, const State& state);
  /// Puts the neighbours beside the run, in `state`, by difference and derivative.
  void place(Direction& direction, const State& state);
  /// How far neighbours are off at best, where their difference may be chosen: the third derivative of what beams do,
  /// (way over radius of gyration)^2, and round-off of velocities, round-off over step over way, are alike there.
  static constexpr double kDistance = 1e-5;
  /// How far the neighbours are off the run, in `state`: the largest displacement over the model's length scale or
  /// rotation [rad], that which velocities make in `step` [s] included.
  double distance(const Direction& direction, const State& state, double step) const;

  void begin_step() override;
  void end_step(double duration) override;
  void keep() override;
  void take_back() override;
  void follow(const State& state, const StepSystem& solved) override;

 private:
  void follow_piece(const State& state, const StepSystem& solved) override;
  void cross(const Crossing& crossing) override;
  /// The run once more over events and hits, by one number of pieces, and its neighbours in their order.
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
  bool make_factors(const State& state, const StepSystem& solved);
  /// Why it does not go along, or nothing.
  std::string advance(Neighbour& neighbour, const State& state, const StepSystem& solved);
  /// False if it does not converge.
  bool solve(StepSystem& system);
  template <class Visit>
  void for_each_neighbour(const Visit& visit) {
    for (Direction& direction : directions_)
      for (Neighbour& neighbour : direction.neighbours) visit(neighbour);
  }

  const Model& model_;
  StepSystem system_;  // the run's once more: its factors are kept here
  std::vector<Direction> directions_;
  std::string lost_;
  double factorised_step_ = 0;     // for which the factors hold [s]; 0: none
  long followed_ = 0;              // sub-steps
  int updates_ = 0;                // of the present sub-step, by all neighbours
  IncrementHistory made_, guess_;  // by the run in the present sub-step; the same of a neighbour, as is expected
  Eigen::VectorXd update_;
  std::vector<NodePose> poses_;  // scratch
  std::vector<double> numbers_;  // scratch
  std::vector<State> kept_;      // at the beginning of a step that may be taken back
  // ---- events
  std::unique_ptr<EventMarch> march_;  // null where there are none
  std::array<Way, 2> ways_;            // by pieces and by twice as many
  State begin_;                        // of a sub-step of a way
  bool is_ahead_ = false;              // neighbours are beside ways
  bool is_in_hit_ = false;             // ways go on
  double hit_begin_ = 0;               // [s]
  double longest_hit_ = 0;             // [s]
  bool notes_events_ = false;
  std::vector<std::vector<double>> coarse_;  // derivatives by the first way, per direction
  std::vector<double> motor_rests_;
  std::vector<char> touches_;  // per force element
  std::vector<RunEvent> events_;
};

}  // namespace flexarm
