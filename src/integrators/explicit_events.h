#pragma once
/// Events at which steps of explicit schemes end: stops are touched or left, motors come to a limit.
/// (docs/notes/explicit.md 3)

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "joints/joint_stop.h"
#include "model/model.h"

namespace flexarm {

/// A stop that pushes at the beginning of a step, or does not, goes on with that to the end of the step. So the
/// equations are smooth within it, and a step that ends where a stop is touched, lets go or is left keeps its order.
/// Where a motor comes to a limit its effort has a kink, and a step that ends there keeps its order, too.
class ExplicitEvents {
 public:
  /// Stops of coordinates that are held do not count. `kinks`: number of margins of begin_kinks().
  ExplicitEvents(const Model& model, std::size_t kinks);

  bool any() const { return has_stops() || !kinks_.empty(); }
  bool has_stops() const { return !sides_.empty(); }
  /// The law that each stop of a coordinate follows: below, above.
  const std::array<StopContact, 2>& contacts(std::size_t coordinate) const { return contacts_[coordinate]; }

  /// Begins a step. `motion_of`: returns the motion of a coordinate there, with `angle` and `rate`. Returns whether a
  /// stop pushes that did not, or the reverse.
  template <class MotionOf>
  bool begin(const MotionOf& motion_of) {
    bool changes = false;
    for (Side& side : sides_) {
      side.begin = side.low = side.now = reach(side, motion_of(side.coordinate));
      changes = set(side, stop_stage(side.begin)) || changes;
    }
    return changes;
  }
  /// Completes begin() by numbers that vanish where efforts have kinks (ExplicitMargins).
  void begin_kinks(const std::vector<double>& margins);
  /// Looks at the end of a step, which has begun at the last call of begin().
  template <class MotionOf>
  void look(const MotionOf& motion_of, const std::vector<double>& margins) {
    for (Side& side : sides_) side.now = reach(side, motion_of(side.coordinate));
    for (std::size_t i = 0; i < kinks_.size(); ++i) kinks_[i].now = margins[i];
  }
  /// What has happened between begin() and look(), by an index: the first event, judged by straight lines. A step may
  /// end there.
  std::optional<std::size_t> first() const;
  /// Remembers that nothing had happened at the last look().
  void keep_low();
  /// > 0 before an event: at the last look(), and at the last keep_low() or begin().
  double guard(std::size_t event) const;
  double low_guard(std::size_t event) const;
  /// Takes what has happened into account, until the next call of begin().
  void turn(std::size_t event);
  /// Lets all stops push where they are penetrated, and looks for no events, until the next call of begin().
  void let_go();

 private:
  using Stage = std::optional<StopStage>;
  struct Side {
    std::size_t coordinate;
    bool is_above;
    Stage stage = {};  ///< empty: it pushes by its depth, whatever happens
    StopReach begin = {}, low = {}, now = {};
  };
  struct Kink {
    double sign = 0, low = 0, now = 0;  ///< sign: at the beginning, or 0: it does not count
  };
  template <class Motion>
  StopReach reach(const Side& side, const Motion& motion) const {
    return stop_reach(*model_.coordinates[side.coordinate].limit, side.is_above, motion.angle, motion.rate);
  }
  bool set(Side& side, Stage stage);
  static double guard(const Side& side, const StopReach& at);

  const Model& model_;
  std::vector<Side> sides_;
  std::vector<Kink> kinks_;
  std::vector<std::array<StopContact, 2>> contacts_;
};

}  // namespace flexarm
