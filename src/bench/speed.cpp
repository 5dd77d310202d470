// All runs of a problem in turns, and their errors.
#include "bench/speed.h"

#include <algorithm>
#include <map>

#include "bench/mujoco.h"

namespace flexarm::bench {
namespace {

/// Runs whose median counts, and up to which time of one run there are so many [s]; longer runs are made once.
constexpr int kRepetitions = 3;
constexpr double kShort = 0.5;

/// What a run costs, relative; for the progress bar.
double cost_of(const SpeedProblem& problem, const Discretisation& d) {
  constexpr double kSubSteps = 5;  // of em4
  return problem.until / d.step * std::max(d.elements, 1) * std::max(d.order, 1) * (d.scheme == "em4" ? kSubSteps : 1);
}

Discretisation with_half_the_elements(Discretisation d) {
  d.elements /= 2;
  return d;
}
Discretisation with_twice_the_step(Discretisation d) {
  d.step *= 2;
  return d;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/// Times of the repetitions of one discretisation.
struct Times {
  std::vector<double> build, processor, wall;

  void add(const SpeedRun& run) {
    build.push_back(run.build_seconds);
    processor.push_back(run.seconds);
    wall.push_back(run.wall_seconds);
  }
  void put_medians(SpeedOutcome& outcome) const {
    outcome.repetitions = static_cast<int>(wall.size());
    outcome.run.build_seconds = median(build);
    outcome.run.seconds = median(processor);
    outcome.run.wall_seconds = median(wall);
  }
};

/// The reference, which must come to its end, and how far two coarser ones are from it. Its trajectory and frames are
/// handed out.
SpeedRun compute_reference(const std::string& folder, SpeedMeasurement& out, const std::function<void()>& advance) {
  const Discretisation& d = out.problem.reference;
  const auto complete = [&](const Discretisation& discretisation) {
    SpeedRun run = run_speed(folder, out.problem, discretisation);
    if (run.failure)
      throw std::runtime_error(out.problem.name + ": the reference fails: " + to_string(run.failure->reason));
    advance();
    return run;
  };
  SpeedRun reference = complete(d);
  const Trajectory& trajectory = reference.trajectory;
  out.mesh_error = trajectory_error(complete(with_half_the_elements(d)).trajectory, trajectory);
  out.step_error = trajectory_error(complete(with_twice_the_step(d)).trajectory, trajectory);
  out.largest_displacement = largest_displacement(trajectory);
  out.reference = {d, reference, 1, 0};
  out.reference.run.trajectory.clear();
  out.reference.run.frames.clear();
  return reference;
}

void measure_runs(const std::string& folder, SpeedMeasurement& out, const Trajectory& reference, bool quick,
                  const std::function<void(const Discretisation&)>& advance) {
  const std::vector<Discretisation>& runs = out.problem.runs;
  std::vector<Times> times(runs.size());
  for (int repetition = 0; repetition < (quick ? 1 : kRepetitions); ++repetition)
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (repetition == 0 || times[i].processor.front() < kShort) {
        SpeedRun run = run_speed(folder, out.problem, runs[i]);
        times[i].add(run);
        if (repetition == 0) {
          const double error = run.failure ? 0 : trajectory_error(run.trajectory, reference);
          run.trajectory = {};
          run.frames = {};
          out.outcomes.push_back({runs[i], std::move(run), 1, error});
        }
      }
      advance(runs[i]);
    }
  for (std::size_t i = 0; i < runs.size(); ++i) times[i].put_medians(out.outcomes[i]);
}

/// Runs of the same problem by other programs, where they are built in.
std::vector<PeerOutcome> measure_peers(const SpeedProblem& problem, const SpeedRun& reference, bool quick,
                                       const std::function<void()>& advance) {
  const std::map<std::string, PeerProblem> known = {{"spin_up", PeerProblem::SpinUp},
                                                    {"double_pendulum", PeerProblem::DoublePendulum}};
  const auto found = known.find(problem.name);
  if (found == known.end()) return {};
  std::vector<double> times;
  for (std::size_t i = 0; i < reference.trajectory.size(); ++i)
    times.push_back(static_cast<double>(i) * problem.interval);
  std::vector<PeerOutcome> outcomes;
  for (PeerRun& run : mujoco_runs(found->second, times, quick, advance)) {
    for (std::size_t i = 0; i < reference.frames.size() && i < run.probe.size(); ++i)
      run.probe[i] = in_frame(reference.frames[i], run.probe[i]);
    outcomes.push_back({run.program, run.variant, run.segments, run.step, run.seconds, run.completed,
                        run.completed ? trajectory_error(run.probe, reference.trajectory) : 0});
  }
  return outcomes;
}

std::vector<IterationCost> measure_iterations(const std::string& folder, bool quick) {
  constexpr int kElements = 32;
  std::vector<IterationCost> costs;
  for (const SpeedProblem& problem : speed_problems()) {
    if (problem.name != "right_angle_cantilever") continue;
    SpeedProblem part = problem;
    part.interval = 0.05;
    part.until = quick ? 0.1 : 5;
    for (const char* scheme : {"em", "em0", "em_symmetric", "edmc2", "newmark"})
      for (const int order : {1, 2, 3}) costs.push_back({scheme, order, kElements, 0});
    std::vector<std::vector<double>> times(costs.size());
    for (int repetition = 0; repetition < (quick ? 1 : kRepetitions); ++repetition)
      for (std::size_t i = 0; i < costs.size(); ++i) {
        const SpeedRun run = run_speed(folder, part, {costs[i].scheme, costs[i].order, kElements, 0.05}, false);
        if (run.iterations > 0) times[i].push_back(run.seconds / static_cast<double>(run.iterations * kElements));
      }
    for (std::size_t i = 0; i < costs.size(); ++i)
      if (!times[i].empty()) costs[i].seconds = median(times[i]);
  }
  return costs;
}

SpeedRun measure_demo(const std::string& folder, SpeedProblem problem, bool quick) {
  problem.interval = 0.1;
  const int repetitions = quick ? 1 : kRepetitions;
  std::vector<SpeedRun> runs;
  for (int i = 0; i < repetitions; ++i) runs.push_back(run_speed(folder, problem, {"auto", 0, 0, 1e-3}));
  std::sort(runs.begin(), runs.end(), [](const SpeedRun& a, const SpeedRun& b) { return a.seconds < b.seconds; });
  return runs[runs.size() / 2];
}

}  // namespace

const SpeedOutcome* SpeedMeasurement::next_finer(const SpeedOutcome& outcome) const {
  const Discretisation& d = outcome.discretisation;
  const SpeedOutcome* found = nullptr;
  for (const SpeedOutcome& other : outcomes) {
    const Discretisation& o = other.discretisation;
    const bool is_alike =
        o.scheme == d.scheme && o.order == d.order && o.elements == d.elements && o.tolerance == d.tolerance;
    if (is_alike && o.step < d.step && (!found || o.step > found->discretisation.step)) found = &other;
  }
  return found;
}

const SpeedOutcome* SpeedMeasurement::fastest(double error, const std::string& scheme) const {
  const auto attains = [&](const SpeedOutcome& outcome) {
    return !outcome.run.failure && error_bound(outcome.error) <= error;
  };
  const SpeedOutcome* best = nullptr;
  for (const SpeedOutcome& outcome : outcomes) {
    if (!attains(outcome) || (!scheme.empty() && outcome.discretisation.scheme != scheme)) continue;
    const SpeedOutcome* finer = next_finer(outcome);
    if (finer && !attains(*finer)) continue;
    if (!best || outcome.run.seconds < best->run.seconds) best = &outcome;
  }
  return best;
}

SpeedReport measure_speed(const std::string& folder, const std::vector<SpeedProblem>& problems, bool quick,
                          const std::function<void(double, const std::string&)>& progress) {
  SpeedReport report;
  report.quick = quick;
  std::vector<SpeedProblem> all;
  double whole = 0, done = 0;
  const auto reference_cost = [](const SpeedProblem& p) { return cost_of(p, p.reference); };
  for (const SpeedProblem& problem : problems) {
    all.push_back(quick ? shortened(problem) : problem);
    whole += 3 * reference_cost(all.back());
    for (const Discretisation& d : all.back().runs) whole += (quick ? 1 : kRepetitions) * cost_of(all.back(), d);
  }
  for (const SpeedProblem& problem : all) {
    const auto advance = [&](double cost) { progress((done += cost) / whole, problem.name); };
    SpeedMeasurement measurement;
    measurement.problem = problem;
    const SpeedRun reference = compute_reference(folder, measurement, [&] { advance(reference_cost(problem)); });
    measure_runs(folder, measurement, reference.trajectory, quick,
                 [&](const Discretisation& d) { advance(cost_of(problem, d)); });
    measurement.peers =
        measure_peers(problem, reference, quick, [&] { progress(done / whole, problem.name + ", other programs"); });
    if (problem.name == "right_angle_cantilever") report.iteration_costs = measure_iterations(folder, quick);
    if (problem.name == "demo_arm") report.demo = measure_demo(folder, problem, quick);
    report.measurements.push_back(std::move(measurement));
  }
  return report;
}

}  // namespace flexarm::bench
