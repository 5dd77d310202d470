#include "flexarm/accuracy/accurate_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Of what is asked for: the largest estimate that is good enough, for true errors were up to 1.35 times their
/// estimates; and at what the next try aims, so that an error a little larger than foreseen is small enough, too.
constexpr double kEnough = 0.8, kAim = 0.6;
/// The least by which steps are multiplied between tries: below it, a difference of runs says little.
constexpr double kLeastGrowth = 1.2;
/// An error is known the better, the smaller it is; from it, how many times as many steps the next try has at most.
double most_growth(double estimate) {
  return estimate > 0.1 ? 2 : estimate > 0.01 ? 4 : 8;
}
/// Differences of runs as large as this, of the way that points move, have no order: they move in another way.
constexpr double kSaturated = 0.3;
/// A difference of runs that is so many times the expected one was foreseen badly: less is made of it.
constexpr double kSurprise = 2;
/// Tries in turn that make an error no smaller, after which it is given up: small ones are round-off, large ones chaos,
/// or a motion that the first tries are far too coarse for.
constexpr double kRoundOffBelow = 1e-6;
constexpr int kMostStagnations = 4;
/// Tries in turn, each with twice the steps, in which a step fails: it has another reason than its length.
constexpr int kMostFailures = 8;
/// Newton's method leaves the square of its tolerance in every step, of which all add up to this share of what is asked
/// for; and a tolerance between which bounds it may be.
constexpr double kRemainderShare = 0.01, kLeastTolerance = 1e-13, kMostTolerance = 1e-3;
/// Points that move less, of the model's length, are at rest: what they do is round-off, or what a start leaves.
constexpr double kRest = 1e-6;
/// Events are found to a part of what is asked for of the whole time, which bounds what they do to the error.
constexpr double kEventShare = 1.0 / 8;
constexpr int kMostEventHalvings = 10;

/// The multiple of which all numbers of steps must be, so that servos are sampled at ends of steps; 0: there is none.
int multiple_for_samples(const Model& model, double interval) {
  int multiple = 1;
  for (const Actuator& actuator : model.actuators) {
    const double sample_time = actuator.servo ? actuator.servo->sample_time : 0;
    if (sample_time == 0) continue;
    if (!hits_samples(sample_time, interval)) return 0;
    multiple = std::lcm(multiple, static_cast<int>(std::lround(interval / sample_time)));
  }
  return multiple;
}

class TriesOfARun {
 public:
  TriesOfARun(Simulation& simulation, const AccuracyRequest& request, RunWatcher& watcher)
      : simulation_(simulation),
        request_(request),
        watcher_(watcher),
        points_(simulation, request.frame),
        start_(simulation.snapshot()),
        begin_(simulation.time()),
        order_(make_scheme(simulation.scene().integrator).order),
        intervals_(request.intervals) {
    const auto require = [](bool ok, const char* what) {
      if (!ok) throw std::invalid_argument(what);
    };
    require(request.accuracy > 0 && request.accuracy < 1, "an accuracy must lie between 0 and 1");
    require(std::isfinite(request.until) && request.until > begin_, "the end must be later than the beginning");
    require(request.intervals >= 1, "there must be an interval at least");
    require(!request.scale || *request.scale > 0, "the scale of errors must be > 0");
    require(points_.size() > 0, "nothing moves by which a run could be judged");
    // Fewer and longer ones, where that lets samples be at their ends.
    while (intervals_ > 0 && (multiple_ = multiple_for_samples(model_of(simulation), interval())) == 0) --intervals_;
    require(intervals_ > 0, "the whole time is no multiple of the sample times of the servos");
  }

  AccurateRun run() {
    int steps = multiple_;  // in an interval
    double expected = kUnknown;
    while (may_try(steps)) {
      const bool is_done = attempt(steps, expected);
      if (run_.end == AccurateRun::End::Interrupted) break;
      failures_ = is_done ? 0 : failures_ + 1;
      if (failures_ > kMostFailures) break;
      if (is_done && judge(steps)) break;
      const double estimate = run_.estimate();
      const double growth = std::isnan(estimate)
                                ? 2
                                : std::clamp(std::pow(estimate / (kAim * request_.accuracy), 1.0 / order_),
                                             kLeastGrowth, most_growth(estimate));
      const double next = multiple_ * std::ceil(growth * steps / multiple_);
      if (total(next) > request_.most_steps) {
        run_.end = AccurateRun::End::OutOfSteps;
        break;
      }
      expected = estimate * std::pow(steps / next, order_);
      steps = static_cast<int>(next);
    }
    return std::move(run_);
  }

 private:
  double interval() const { return (request_.until - begin_) / intervals_; }

  double total(double steps) const { return steps * intervals_; }

  bool may_try(int steps) {
    const bool has_tries = static_cast<int>(run_.tries.size()) < request_.most_tries;
    const bool has_steps = static_cast<double>(run_.steps) + total(steps) <= request_.most_steps;
    if (!has_tries) run_.end = AccurateRun::End::OutOfTries;
    if (!has_steps) run_.end = AccurateRun::End::OutOfSteps;
    return has_tries && has_steps;
  }

  void set_steps(int steps) {
    const double step = interval() / steps;
    const double finest = kEventShare * request_.accuracy * (request_.until - begin_);
    const int halvings = step > finest ? static_cast<int>(std::ceil(std::log2(step / finest))) : 0;
    simulation_.set_step_size(step, std::min(halvings, kMostEventHalvings));
    const double remainder = kRemainderShare * request_.accuracy / total(steps);
    simulation_.set_tolerance(std::clamp(std::sqrt(remainder), kLeastTolerance, kMostTolerance));
  }

  /// False if a step has failed, or the run was interrupted.
  bool run_interval(int steps) {
    for (int n = 0; n < steps; ++n) {
      watcher_.before_step(simulation_);
      run_.last = simulation_.step();
      ++run_.steps;
      run_.end = AccurateRun::End::Interrupted;
      if (!watcher_.after_step(simulation_, run_.last)) return false;
      run_.end = AccurateRun::End::Failed;
      if (!run_.last.converged) return false;
    }
    return true;
  }

  /// The largest distance of any point from where the run before had it, at the end of an interval [m].
  double distance(const std::vector<Vector3>& positions, int interval) const {
    double largest = 0;
    for (std::size_t i = 0; i < positions.size(); ++i)
      largest = std::max(largest, (positions[i] - before_.points[i][interval]).norm());
    return largest;
  }

  /// The error of a run over its difference to the one before, by the order of the scheme.
  double share(int steps) const { return 1 / (std::pow(static_cast<double>(steps) / steps_before_, order_) - 1); }

  /// False if a step has failed, or the run was interrupted.
  bool attempt(int steps, double expected) {
    simulation_.restore(start_);
    set_steps(steps);
    run_.steps_per_interval = steps;
    run_.interval = interval();
    run_.tries.push_back({static_cast<long>(total(steps)), kUnknown});
    watcher_.begin(simulation_, run_.tries.back().steps, expected);
    run_.motion = JudgedMotion(points_.size());
    for (int i = 0; i <= intervals_; ++i) {
      if (i > 0 && !run_interval(steps)) return false;
      const std::vector<Vector3> positions = points_.positions(simulation_);
      run_.motion.add(positions);
      watcher_.after_interval(simulation_, steps_before_ > 0 ? share(steps) * distance(positions, i) : kUnknown);
    }
    return true;
  }

  /// Estimates the error of a try from its difference to the one before. True if nothing more is to be tried.
  bool judge(int steps) {
    run_.scale = request_.scale.value_or(
        std::max(run_.motion.largest_displacement(), kRest * model_of(simulation_).length_scale));
    const bool is_first = steps_before_ == 0;
    const double last = estimate_before_;
    if (!is_first) {
      const double difference = motion_error(run_.motion, before_, run_.scale);
      double share = this->share(steps);
      // Much more than the run before has in error itself: half of the order is assumed.
      if (kSurprise * last / (1 + share) < difference) share = 1 / (std::sqrt(1 + 1 / share) - 1);
      double estimate = difference * share;
      if (difference > kSaturated) estimate = std::max(estimate, difference);
      run_.tries.back().estimate = estimate_before_ = estimate;
    }
    before_ = run_.motion;
    steps_before_ = steps;
    if (is_first) return false;
    if (run_.estimate() <= kEnough * request_.accuracy) {
      run_.end = AccurateRun::End::Met;
      return true;
    }
    // Tries that make nothing better, each with more steps: round-off, or a motion that amplifies it.
    stagnations_ = run_.estimate() > 0.5 * last ? stagnations_ + 1 : 0;
    if (stagnations_ < (last < kRoundOffBelow ? 1 : kMostStagnations)) return false;
    run_.end = AccurateRun::End::NoConvergence;
    return true;
  }

  Simulation& simulation_;
  const AccuracyRequest& request_;
  RunWatcher& watcher_;
  JudgedPoints points_;
  Snapshot start_;
  double begin_;  // [s]
  int order_, intervals_, multiple_ = 1, stagnations_ = 0, failures_ = 0;
  JudgedMotion before_;   // of the try before
  int steps_before_ = 0;  // of that, in an interval; 0: there was none
  double estimate_before_ = kUnknown;
  AccurateRun run_;
};

}  // namespace

AccurateRun run_to_accuracy(Simulation& simulation, const AccuracyRequest& request, RunWatcher& watcher) {
  const double step = simulation.step_size(), tolerance = simulation.tolerance();
  AccurateRun run = TriesOfARun(simulation, request, watcher).run();
  simulation.set_step_size(step);
  simulation.set_tolerance(tolerance);
  return run;
}

const char* to_string(AccurateRun::End end) {
  switch (end) {
    case AccurateRun::End::Met:
      return "met";
    case AccurateRun::End::Interrupted:
      return "interrupted";
    case AccurateRun::End::Failed:
      return "a step has failed";
    case AccurateRun::End::NoConvergence:
      return "shorter steps make the error no smaller: round-off, or a motion that is chaotic";
    case AccurateRun::End::OutOfTries:
      return "the most tries have been made";
    case AccurateRun::End::OutOfSteps:
      return "the most steps have been made";
  }
  return "";
}

}  // namespace flexarm
