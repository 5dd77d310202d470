#include "flexarm/accuracy/companion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "accuracy/corners.h"
#include "flexarm/accuracy/trajectory.h"
#include "flexarm/scene/scene_description.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

constexpr double kUnknownEstimate = std::numeric_limits<double>::quiet_NaN();

/// Whether the wrenches act at the same places, so that they differ in strength only.
bool act_alike(const std::vector<NodalLoad>& a, const std::vector<NodalLoad>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const NodalLoad& x, const NodalLoad& y) {
    return x.node == y.node && x.follows == y.follows && x.arm == y.arm && x.pull.stiffness == y.pull.stiffness &&
           x.pull.damping == y.pull.damping;
  });
}

/// Replaces efforts and wrenches by their means over both steps, which have the same impulse. Set points are those at
/// the end.
void take_means(const Commands& first, Commands& second) {
  for (std::size_t i = 0; i < first.efforts.size(); ++i)
    if (!std::isnan(first.efforts[i]) && !std::isnan(second.efforts[i]))
      second.efforts[i] = 0.5 * (first.efforts[i] + second.efforts[i]);
  for (std::size_t i = 0; i < second.wrenches.size(); ++i) {
    NodalLoad& mean = second.wrenches[i];
    mean.force = 0.5 * (first.wrenches[i].force + mean.force);
    mean.moment = 0.5 * (first.wrenches[i].moment + mean.moment);
    mean.pull.target = 0.5 * (first.wrenches[i].pull.target + mean.pull.target);
  }
}

/// A bound of what steps over corners may do to positions. Both simulations may have the same error there, so that
/// their distance does not show it. If the acceleration of a point jumps by da, a step that uses the acceleration of
/// one side, or a sample in its middle, has an error of at most da h/2 in the velocity, which stays. If a velocity
/// jumps by dv, as in a hit, it does so at most h/2 too early or too late.
class CornerDoubt {
 public:
  CornerDoubt(const Simulation& simulation, const JudgedPoints& points) : corners_(simulation), points_(points) {
    for (std::vector<Vector3>& positions : past_) positions.resize(points.size());
    begin(simulation);
  }

  /// Starts again, after the simulation's state was changed from outside.
  void begin(const Simulation& simulation) {
    restart();
    known_ = 0;
    passed_ = 0;
    if (!corners_.may_come()) return;
    corners_.begin(simulation);
    add_points(simulation);
  }
  /// Forgets the errors so far.
  void restart() { position_ = velocity_ = 0; }
  void follow(const Simulation& simulation);
  /// The bound [m]. NaN: there was a corner so early that the motion before it is not known well enough.
  double amount() const { return position_; }

 private:
  void add_points(const Simulation& simulation) {
    std::rotate(past_.begin(), past_.end() - 1, past_.end());
    points_.positions(simulation, past_[0]);
    known_ = std::min(known_ + 1, past_.size());
  }

  Corners corners_;
  const JudgedPoints& points_;
  std::array<std::vector<Vector3>, 6> past_;  // positions after the last steps, newest first
  std::size_t known_ = 0;                     // how many of them are known
  unsigned passed_ = 0;                       // bit k: there was a corner within the step k steps ago
  double position_ = 0, velocity_ = 0;        // [m, m/s]
};

void CornerDoubt::follow(const Simulation& simulation) {
  if (!corners_.may_come()) return;
  const double h = simulation.step_size();
  position_ += h * velocity_;
  add_points(simulation);
  passed_ = (passed_ << 1) | (corners_.passed(simulation) ? 1u : 0u);
  if ((passed_ & 4u) == 0) return;  // the motion after a corner is known two steps later
  if (known_ < past_.size()) {
    position_ = kUnknownEstimate;
    return;
  }
  double acceleration = 0, velocity = 0;  // largest jumps
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto x = [&](std::size_t k) -> const Vector3& { return past_[k][i]; };
    const Vector3 after = x(0) - 2 * x(1) + x(2), before = x(3) - 2 * x(4) + x(5);
    acceleration = std::max(acceleration, (after - before).norm() / (h * h));
    // Without the part that both accelerations contribute in the meantime.
    velocity = std::max(velocity, (x(0) - x(1) - x(3) + x(4) - 1.5 * (after + before)).norm() / h);
  }
  constexpr double kStepsSince = 2.5;  // since the middle of the step with the corner
  velocity_ += 0.5 * h * acceleration;
  position_ += 0.5 * h * (velocity + kStepsSince * h * acceleration);
}

}  // namespace

struct Companion::Implementation {
  Implementation(const Simulation& simulation, double window)
      : companion(simulation.copy()),
        points(simulation),
        doubt(simulation, points),
        window(window),
        share(1 / (std::pow(2, make_scheme(simulation.scene().integrator).order) - 1)) {
    if (!(window > 0)) throw std::invalid_argument(fmt::format("window: expected a time > 0, got {} s", window));
    companion.set_step_size(2 * simulation.step_size());
    // The scheme's constants follow the companion's step, so that its error includes what depends on these constants.
    set_step_of_constants(companion, 2 * step_of_constants(simulation));
    begin(simulation);
  }

  void begin(const Simulation& simulation);
  double follow(const Simulation& simulation);

  Simulation companion;
  JudgedPoints points;
  CornerDoubt doubt;
  double window, share;   // share: the simulation's error over its distance from the companion
  double begin_time = 0;  // of the window [s]
  double last_time = 0;   // of the simulation, after the last step [s]
  bool is_half = false;   // the companion is one step behind
  double largest = 0, largest_before = kUnknownEstimate;
  Commands first, second;  // of the two steps that the companion makes in one
  Snapshot start;
  std::vector<Vector3> positions, companion_positions;

 private:
  bool step(const Simulation& simulation);
  double distance(const Simulation& simulation);
};

void Companion::Implementation::begin(const Simulation& simulation) {
  simulation.snapshot(start);
  companion.restore(start);
  companion.set_step_size(2 * simulation.step_size());
  begin_time = last_time = simulation.time();
  is_half = false;
  largest = 0;
  doubt.restart();
}

bool Companion::Implementation::step(const Simulation& simulation) {
  take_commands(simulation, second);
  const double step = simulation.step_size();
  if (act_alike(first.wrenches, second.wrenches)) {
    take_means(first, second);
    give_commands(second, companion);
    return companion.step().converged;
  }
  // The wrenches act at other places: the companion makes these two steps like the simulation.
  companion.set_step_size(step);
  give_commands(first, companion);
  bool is_done = companion.step().converged;
  give_commands(second, companion);
  is_done = is_done && companion.step().converged;
  companion.set_step_size(2 * step);
  return is_done;
}

double Companion::Implementation::distance(const Simulation& simulation) {
  points.positions(simulation, positions);
  points.positions(companion, companion_positions);
  double distance = 0;
  for (std::size_t i = 0; i < positions.size(); ++i)
    distance = std::max(distance, (positions[i] - companion_positions[i]).norm());
  return distance;
}

double Companion::Implementation::follow(const Simulation& simulation) {
  const double step = simulation.step_size();
  const bool goes_on = std::abs(simulation.time() - last_time - step) < 0.5 * step && companion.step_size() == 2 * step;
  if (!goes_on) {
    begin(simulation);
    doubt.begin(simulation);
    return largest_before = kUnknownEstimate;
  }
  last_time = simulation.time();
  doubt.follow(simulation);
  is_half = !is_half;
  if (is_half) {
    take_commands(simulation, first);
  } else if (!this->step(simulation)) {
    begin(simulation);
  } else {
    largest = std::max(largest, share * distance(simulation) + doubt.amount());
    if (simulation.time() - begin_time > window - step) {
      largest_before = largest;
      begin(simulation);
    }
  }
  if (std::isnan(doubt.amount())) return kUnknownEstimate;
  return simulation.time() - begin_time > 1.5 * step || !std::isnan(largest_before) ? std::fmax(largest, largest_before)
                                                                                    : kUnknownEstimate;
}

Companion::Companion(const Simulation& simulation, double window)
    : implementation_(std::make_unique<Implementation>(simulation, window)) {}
Companion::~Companion() = default;
Companion::Companion(Companion&&) noexcept = default;
Companion& Companion::operator=(Companion&&) noexcept = default;

double Companion::follow(const Simulation& simulation) {
  return implementation_->follow(simulation);
}

void Companion::begin(const Simulation& simulation) {
  implementation_->begin(simulation);
  implementation_->doubt.begin(simulation);
  implementation_->largest_before = kUnknownEstimate;
}

}  // namespace flexarm
