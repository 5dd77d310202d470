// Makes all runs of a problem in turns, and computes their errors.
#include "bench/speed.h"

#include <algorithm>
#include <map>

#include "bench/median.h"
#include "bench/mujoco.h"
#include "flexarm/scene/urdf_reader.h"

namespace flexarm::bench {
namespace {

/// Number of runs whose median counts, for runs up to kShort [s]; longer runs are made once.
constexpr int kRepetitions = 3;
constexpr double kShort = 0.5;

/// Relative cost of a run, for the progress bar.
double cost_of(const SpeedProblem& problem, const Discretisation& d) {
  constexpr double kSubSteps = 5;  // number of em4's sub-steps
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

/// Computes the reference, which must be completed, and its differences from two coarser runs. Returns the reference's
/// run with trajectory and frames.
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
  if (out.problem.has_beams())
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

/// Runs of the same problem in other programs, if these are built in.
std::vector<PeerRun> peer_runs(const std::string& folder, const SpeedProblem& problem, const std::vector<double>& times,
                               bool quick, const std::function<void()>& advance) {
  if (!problem.has_beams()) {
    const scene::ReadResult read = scene::read_scene_file(folder + "/" + problem.scene);
    std::vector<PeerRun> runs = mujoco_runs_of(read.scene.value(), times, quick);
    advance();
    return runs;
  }
  if (problem.name == "tendon_rod") return mujoco_tendon_runs(times, quick, advance);
  const std::map<std::string, PeerProblem> known = {{"spin_up", PeerProblem::SpinUp},
                                                    {"double_pendulum", PeerProblem::DoublePendulum}};
  const auto found = known.find(problem.name);
  if (found == known.end()) return {};
  return mujoco_runs(found->second, times, quick, advance);
}

/// As peer_runs(). Times of rigid mechanisms, which are milliseconds, are medians of several runs.
std::vector<PeerRun> timed_peer_runs(const std::string& folder, const SpeedProblem& problem,
                                     const std::vector<double>& times, bool quick,
                                     const std::function<void()>& advance) {
  std::vector<PeerRun> runs = peer_runs(folder, problem, times, quick, advance);
  if (problem.has_beams() || quick) return runs;
  std::vector<std::vector<double>> seconds(runs.size());
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    if (repetition > 0) runs = peer_runs(folder, problem, times, quick, advance);
    for (std::size_t i = 0; i < runs.size(); ++i) seconds[i].push_back(runs[i].seconds);
  }
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].seconds = median(seconds[i]);
  return runs;
}

std::vector<PeerOutcome> measure_peers(const std::string& folder, const SpeedProblem& problem,
                                       const SpeedRun& reference, bool quick, const std::function<void()>& advance) {
  std::vector<double> times;
  for (std::size_t i = 0; i < reference.trajectory.size(); ++i)
    times.push_back(static_cast<double>(i) * problem.interval);
  std::vector<PeerOutcome> outcomes;
  for (PeerRun& run : timed_peer_runs(folder, problem, times, quick, advance)) {
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

SpeedRun run_real_time(const std::string& folder, const RealTimeScene& scene) {
  SpeedProblem problem{scene.title, scene.title, scene.scene, scene.commands, scene.probe, scene.until,
                       scene.until, {},          {}};
  SpeedRun run = run_speed(folder, problem, {scene.scheme, 0, 0, 1e-3});
  if (run.failure) throw std::runtime_error(scene.title + ": " + to_string(run.failure->reason));
  return run;
}

std::vector<RealTimeOutcome> measure_real_time(const std::string& folder, bool quick) {
  std::vector<RealTimeScene> scenes = real_time_scenes();
  std::vector<std::vector<SpeedRun>> runs(scenes.size());
  for (int repetition = 0; repetition < (quick ? 1 : kRepetitions); ++repetition)
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      if (quick) scenes[i] = shortened(scenes[i]);
      runs[i].push_back(run_real_time(folder, scenes[i]));
    }
  std::vector<RealTimeOutcome> outcomes;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const auto middle = runs[i].begin() + static_cast<long>(runs[i].size()) / 2;
    std::nth_element(runs[i].begin(), middle, runs[i].end(),
                     [](const SpeedRun& a, const SpeedRun& b) { return a.seconds < b.seconds; });
    outcomes.push_back({scenes[i], std::move(*middle)});
  }
  return outcomes;
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

const PeerOutcome* SpeedMeasurement::fastest_peer(double error, const std::string& variant) const {
  const PeerOutcome* best = nullptr;
  for (const PeerOutcome& peer : peers)
    if (peer.completed && peer.variant == variant && error_bound(peer.error) <= error &&
        (!best || peer.seconds < best->seconds))
      best = &peer;
  return best;
}

double RealTimeOutcome::measured() const {
  const double steps = static_cast<double>(run.steps), microseconds = 1e6 * run.seconds;
  switch (scene.unit) {
    case RealTimeScene::Unit::TimesRealTime:
      return scene.until / run.seconds;
    case RealTimeScene::Unit::MicrosecondsPerStep:
      return microseconds / steps;
    case RealTimeScene::Unit::MicrosecondsPerTwoIterations:
      return 2 * microseconds / static_cast<double>(run.iterations);
  }
  return 0;
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
    whole += (problem.has_beams() ? 3 : 2) * reference_cost(all.back());
    for (const Discretisation& d : all.back().runs) whole += (quick ? 1 : kRepetitions) * cost_of(all.back(), d);
  }
  for (const SpeedProblem& problem : all) {
    const auto advance = [&](double cost) { progress((done += cost) / whole, problem.name); };
    SpeedMeasurement measurement;
    measurement.problem = problem;
    const SpeedRun reference = compute_reference(folder, measurement, [&] { advance(reference_cost(problem)); });
    measure_runs(folder, measurement, reference.trajectory, quick,
                 [&](const Discretisation& d) { advance(cost_of(problem, d)); });
    measurement.peers = measure_peers(folder, problem, reference, quick,
                                      [&] { progress(done / whole, problem.name + ", other programs"); });
    if (problem.name == "right_angle_cantilever") report.iteration_costs = measure_iterations(folder, quick);
    report.measurements.push_back(std::move(measurement));
  }
  report.real_time = measure_real_time(folder, quick);
  report.planar = compare_planar(folder, report);
  report.contacts = compare_contacts(quick);
  report.batches = compare_batches(folder, quick);
  return report;
}

}  // namespace flexarm::bench
