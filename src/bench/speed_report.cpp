// Writes the speed report as text.
#include <algorithm>

#include <fmt/format.h>

#include "bench/markdown_table.h"
#include "bench/speed.h"

namespace flexarm::bench {
namespace {

const double kDefaultTolerance = IntegratorDescription().tolerance;

std::string milliseconds(double seconds) {
  return fmt::format("{:.3g}", 1e3 * seconds);
}

std::string tolerance_text(double tolerance) {
  return tolerance == kDefaultTolerance ? "" : fmt::format(", tolerance {:g}", tolerance);
}

std::string discretisation_text(const Discretisation& d) {
  return fmt::format("{}, {}, {:g} s{}", d.scheme, d.mesh(), d.step, tolerance_text(d.tolerance));
}

/// Errors for which the fastest runs are listed, from the largest.
std::vector<double> error_levels(const SpeedProblem& problem) {
  std::vector<double> levels = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5};
  for (const SpeedTarget& target : speed_targets())
    if (target.problem == problem.name) levels.push_back(target.error);
  std::sort(levels.begin(), levels.end(), std::greater<>());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

std::vector<std::string> schemes_of(const SpeedProblem& problem) {
  std::vector<std::string> names;
  for (const Discretisation& d : problem.runs)
    if (std::find(names.begin(), names.end(), d.scheme) == names.end()) names.push_back(d.scheme);
  return names;
}

std::string error_text(const SpeedMeasurement& m, double error) {
  return fmt::format("{:.2e}{}", error, m.resolves(error) ? "" : " †");
}

std::string front_table(const SpeedMeasurement& m) {
  std::string text = head({"error at most", "scheme", "elements x order", "step [s]", "tolerance", "error", "time [ms]",
                           "wall time [ms]", "µs per step", "iterations per step", "factorisations per step",
                           "halvings", "building [ms]"});
  for (const double level : error_levels(m.problem)) {
    const SpeedOutcome* best = m.fastest(level);
    if (!best) {
      text += row({fmt::format("{:g}", level), "–", "–", "–", "–", "–", "–", "–", "–", "–", "–", "–", "–"});
      continue;
    }
    const Discretisation& d = best->discretisation;
    const SpeedRun& run = best->run;
    const double steps = static_cast<double>(run.steps);
    text += row({fmt::format("{:g}", level), d.scheme, d.mesh(), fmt::format("{:g}", d.step),
                 fmt::format("{:g}", d.tolerance), error_text(m, best->error), milliseconds(run.seconds),
                 milliseconds(run.wall_seconds), fmt::format("{:.3g}", 1e6 * run.seconds / steps),
                 fmt::format("{:.2f}", static_cast<double>(run.iterations) / steps),
                 fmt::format("{:.2f}", static_cast<double>(run.factorisations) / steps),
                 fmt::format("{}", run.halvings), milliseconds(run.build_seconds)});
  }
  return text;
}

std::string scheme_table(const SpeedMeasurement& m) {
  const std::vector<double> levels = error_levels(m.problem);
  std::vector<std::string> columns = {"scheme"};
  for (const double level : levels) columns.push_back(fmt::format("{:g}", level));
  std::string text = head(columns);
  for (const std::string& scheme : schemes_of(m.problem)) {
    std::vector<std::string> cells = {scheme};
    for (const double level : levels) {
      const SpeedOutcome* best = m.fastest(level, scheme);
      if (!best) {
        cells.push_back("–");
        continue;
      }
      const Discretisation& d = best->discretisation;
      cells.push_back(fmt::format("**{}** ({}, {:g} s{})", milliseconds(best->run.seconds), d.mesh(), d.step,
                                  tolerance_text(d.tolerance)));
    }
    text += row(cells);
  }
  return text;
}

/// The Pareto front of each other program: runs to which none of the same program is faster and more accurate; by
/// error.
std::vector<PeerOutcome> peer_front(const SpeedMeasurement& m) {
  std::vector<PeerOutcome> front;
  for (const PeerOutcome& peer : m.peers) {
    const auto is_better = [&](const PeerOutcome& other) {
      return other.completed && other.program == peer.program && other.error < peer.error &&
             other.seconds < peer.seconds;
    };
    if (peer.completed && std::none_of(m.peers.begin(), m.peers.end(), is_better)) front.push_back(peer);
  }
  std::sort(front.begin(), front.end(), [](const PeerOutcome& a, const PeerOutcome& b) { return a.error > b.error; });
  return front;
}

std::string peer_table(const SpeedMeasurement& m) {
  const long failed =
      std::count_if(m.peers.begin(), m.peers.end(), [](const PeerOutcome& peer) { return !peer.completed; });
  std::string text = "Other programs (`src/bench/mujoco.h`): ";
  text += m.problem.has_beams() ? "chains of rigid segments with hinges, which have neither stretch nor shear, so that "
                                  "their error tends to that of this model. "
                                : "the same mechanism. ";
  text += fmt::format(
      "Of {} runs, {} of which were not completed, those for which no other run is both faster and more accurate:\n\n",
      m.peers.size(), failed);
  text += head({"program", "variant", "segments per beam", "step [s]", "error", "time [ms]",
                "flexarm at that error [ms]", "how many times faster"});
  for (const PeerOutcome& peer : peer_front(m)) {
    const SpeedOutcome* best = m.fastest(peer.error);
    text += row({peer.program, peer.variant, peer.segments > 0 ? fmt::format("{}", peer.segments) : "–",
                 fmt::format("{:g}", peer.step), error_text(m, peer.error), milliseconds(peer.seconds),
                 best ? milliseconds(best->run.seconds) : "–",
                 best ? fmt::format("{:.2g}", peer.seconds / best->run.seconds) : "–"});
  }
  return text;
}

std::string section(const SpeedMeasurement& m) {
  const SpeedProblem& p = m.problem;
  const long failed = std::count_if(m.outcomes.begin(), m.outcomes.end(),
                                    [](const SpeedOutcome& outcome) { return outcome.run.failure.has_value(); });
  std::string text = fmt::format(
      "\n## {}\n\n`{}`: `config/{}`, {:g} s, the probe `{}` compared every {:g} s{}. It moves by at most {:.3g} m, "
      "which is an error of 1.\n\n",
      p.title, p.name, p.scene, p.until, p.probe, p.interval,
      p.frame.empty() ? "" : fmt::format(" in the frame of link `{}`", p.frame), m.largest_displacement);
  text += fmt::format(
      "Reference: {}; {:.3g} s of computing. Its error is estimated as {:.1e}: {:.1e} (half its elements) + {:.1e} "
      "(twice its step).\n{} runs, {} of which were not completed.\n\n",
      discretisation_text(p.reference), m.reference.run.seconds, m.reference_error(), m.mesh_error, m.step_error,
      m.outcomes.size(), failed);
  if (!p.note.empty()) text += p.note + "\n\n";
  text += front_table(m) + "\nThe fastest of each scheme, by error [ms]:\n\n" + scheme_table(m);
  if (!m.peers.empty()) text += "\n" + peer_table(m);
  return text;
}

std::string verdict(double measured_over_target) {
  return measured_over_target <= 1 ? "met" : fmt::format("missed by a factor of {:.2g}", measured_over_target);
}

std::string target_row(const SpeedMeasurement& m, const SpeedTarget& target) {
  const SpeedOutcome* best = m.fastest(target.error);
  std::vector<std::string> cells = {fmt::format("{}, {:g} s [s]", target.problem, m.problem.until),
                                    fmt::format("{:g}", target.error), fmt::format("{:g}", target.target_seconds)};
  if (!best) {
    cells.insert(cells.end(), {"–", "–", "missed: no run is so accurate"});
    return row(cells);
  }
  const double ratio = best->run.seconds / target.target_seconds;
  cells.insert(cells.end(), {fmt::format("{:.3g}", best->run.seconds), fmt::format("{:.2g}", ratio),
                             verdict(ratio) + ": " + discretisation_text(best->discretisation)});
  return row(cells);
}

std::string real_time_row(const RealTimeOutcome& outcome) {
  using Unit = RealTimeScene::Unit;
  const RealTimeScene& scene = outcome.scene;
  const bool more_is_better = scene.unit == Unit::TimesRealTime;
  const char* unit = more_is_better                            ? "times real time"
                     : scene.unit == Unit::MicrosecondsPerStep ? "µs per step"
                                                               : "µs per two iterations";
  const double measured = outcome.measured(), ratio = measured / scene.target;
  const double steps = static_cast<double>(outcome.run.steps);
  return row({fmt::format("{} [{}]", scene.title, unit), "–", fmt::format("{:g}", scene.target),
              fmt::format("{:.3g}", measured), fmt::format("{:.2g}", ratio),
              fmt::format("{}: {:.2f} iterations per step", verdict(more_is_better ? 1 / ratio : ratio),
                          static_cast<double>(outcome.run.iterations) / steps)});
}

std::string peer_target_row(const SpeedMeasurement& m, const PeerTarget& target) {
  const SpeedOutcome* best = m.fastest(target.error);
  const PeerOutcome* peer = m.fastest_peer(target.error, target.variant);
  std::vector<std::string> cells = {
      fmt::format("{}, {:g} s [time over MuJoCo {}'s]", target.problem, m.problem.until, target.variant),
      fmt::format("{:g}", target.error), fmt::format("{:g}", target.ratio)};
  if (!best || !peer) {
    cells.insert(cells.end(), {"–", "–", peer ? "missed: no run is so accurate" : "no run of MuJoCo to compare with"});
    return row(cells);
  }
  const double measured = best->run.seconds / peer->seconds, ratio = measured / target.ratio;
  cells.insert(cells.end(),
               {fmt::format("{:.3g}", measured), fmt::format("{:.2g}", ratio),
                fmt::format("{}: {} ms, {}; {} ms, {:g} s", verdict(ratio), milliseconds(best->run.seconds),
                            discretisation_text(best->discretisation), milliseconds(peer->seconds), peer->step)});
  return row(cells);
}

std::string target_table(const SpeedReport& report) {
  std::string text = head({"what", "error", "target", "measured", "measured / target", "verdict"});
  for (const SpeedTarget& target : speed_targets())
    for (const SpeedMeasurement& m : report.measurements)
      if (m.problem.name == target.problem) text += target_row(m, target);
  for (const IterationCost& cost : report.iteration_costs) {
    if (cost.scheme != "em" || cost.order > 2) continue;
    const double target = cost.order == 1 ? 0.65e-6 : 1.5e-6, ratio = cost.seconds / target;
    text += row({fmt::format("element and full Newton iteration, order {} [µs]", cost.order), "–",
                 fmt::format("{:g}", 1e6 * target), fmt::format("{:.3g}", 1e6 * cost.seconds),
                 fmt::format("{:.2g}", ratio), verdict(ratio)});
  }
  for (const RealTimeOutcome& outcome : report.real_time) text += real_time_row(outcome);
  for (const PeerTarget& target : peer_targets())
    for (const SpeedMeasurement& m : report.measurements)
      if (m.problem.name == target.problem) text += peer_target_row(m, target);
  return text;
}

/// A table of recorded figures, since public programs do not run with the report.
std::string public_table(const SpeedReport& report) {
  std::string text = head({"what", "error", "best public program [s]", "its model", "flexarm beside it [s]", "ratio"});
  for (const SpeedTarget& target : speed_targets())
    for (const SpeedMeasurement& m : report.measurements)
      if (m.problem.name == target.problem)
        text += row({target.problem, fmt::format("{:g}", target.error), fmt::format("{:g}", target.public_seconds),
                     target.public_model, fmt::format("{:g}", target.beside_seconds),
                     fmt::format("{:.2g}", target.public_seconds / target.beside_seconds)});
  return text;
}

std::string iteration_table(const SpeedReport& report) {
  std::string text = head({"scheme", "order", "µs per element and iteration"});
  for (const IterationCost& cost : report.iteration_costs)
    text += row({cost.scheme, fmt::format("{}", cost.order), fmt::format("{:.3g}", 1e6 * cost.seconds)});
  return text;
}

/// Ratio of wall time to processor time.
double load(const SpeedReport& report) {
  double wall = 0, processor = 0;
  for (const SpeedMeasurement& m : report.measurements)
    for (const SpeedOutcome& outcome : m.outcomes) {
      wall += outcome.run.wall_seconds;
      processor += outcome.run.seconds;
    }
  return processor > 0 ? wall / processor : 1;
}

const char* const kLegend = R"(
- **error**: root mean square over time of the probe's distance from the reference, relative to the largest distance of
  the reference from its start. The reference is computed by flexarm itself, finer than every run; its own error is
  estimated by a run with half its elements and one with twice its step. A run counts for an error if its own error plus
  that of the reference is at most so large, and the same holds for the run with the next smaller step: otherwise the
  errors of mesh and step may have cancelled by chance. †: less than twice the reference's error, so not resolved.
- **time**: processor time of all steps, without building the model from the scene. One thread, median of three runs (a
  single run if it takes half a second or more), all runs of a problem in turns. On a machine that has nothing else to
  do, it equals the wall time.
- **elements**: of all beams together. **tolerance**: of Newton's method. If factors may be kept, which is the default,
  the iteration continues until the remainder is at most the *square* of the tolerance: round-off for the default, 1e-8.
- **iterations** of Newton's method, **factorisations** of its tangent, **halvings** of steps that did not converge.
)";

}  // namespace

std::string to_markdown(const SpeedReport& report, const std::string& picture) {
  std::string text = "# Speed against error\n\n";
  text += report.quick ? "Written by `flexarm bench speed --quick`: a test of the command, not a measurement.\n"
                       : "Written by `flexarm bench speed`; all runs are in `speed.csv`, which it writes, too.\n";
  text += kLegend;
  text += fmt::format("\nThe wall time was {:.2f} times the processor time, in total.\n", load(report));
  text += "\n## Targets\n\n" + target_table(report);
  text +=
      "\nThe best of the public programs, tuned for each error, and flexarm as it was then, in one run on one machine "
      "(not the machine of this report):\n\n" +
      public_table(report);
  if (!picture.empty())
    text += fmt::format(
        "\n![Time over error, problem by problem]({})\n\nEvery completed run, and lines through the Pareto fronts: "
        "runs for which no run of the same scheme is both faster and more accurate, even by chance.\n",
        picture);
  for (const SpeedMeasurement& m : report.measurements) text += section(m);
  if (!report.planar.empty())
    text +=
        "\n## In the plane and in three dimensions\n\nThe fastest runs of scenes that move in a plane, in turns with "
        "the "
        "same with `dimension=\"3\"`.\n\n" +
        planar_table(report.planar);
  if (!report.contacts.empty())
    text +=
        "\n## Bodies in contact\n\nSteps of 1 ms; MuJoCo with its defaults (its soft contacts creep, and their energy "
        "gain is the one that MuJoCo reports).\n\n" +
        contact_table(report.contacts);
  if (!report.batches.empty())
    text +=
        "\n## Many at once\n\nCopies of an arm with different starts, in steps of 1 ms, one after the other in one "
        "thread and together in a `Batch`, in turns; medians of wall times.\n\n" +
        batch_table(report.batches);
  if (!report.iteration_costs.empty())
    text +=
        "\n## Cost of an iteration\n\nRight-angle cantilever, 32 elements, steps of 0.05 s, a factorisation in every "
        "iteration; time of all steps, divided by elements and iterations.\n\n" +
        iteration_table(report);
  return text;
}

std::string runs_to_csv(const SpeedReport& report) {
  std::string text =
      "problem,program,scheme,order,elements,step,tolerance,completed,error,seconds,wall_seconds,build_seconds,steps,"
      "iterations,factorisations,halvings,repetitions\n";
  const auto add = [&](const SpeedMeasurement& m, const char* program, const SpeedOutcome& outcome,
                       const std::string& error) {
    const Discretisation& d = outcome.discretisation;
    const SpeedRun& run = outcome.run;
    text += fmt::format("{},{},{},{},{},{:g},{:g},{:d},{},{:.6g},{:.6g},{:.6g},{},{},{},{},{}\n", m.problem.name,
                        program, d.scheme, d.order, d.elements, d.step, d.tolerance, !run.failure, error, run.seconds,
                        run.wall_seconds, run.build_seconds, run.steps, run.iterations, run.factorisations,
                        run.halvings, outcome.repetitions);
  };
  for (const SpeedMeasurement& m : report.measurements) {
    for (const SpeedOutcome& outcome : m.outcomes)
      add(m, "flexarm", outcome, outcome.run.failure ? "" : fmt::format("{:.6g}", outcome.error));
    add(m, "reference", m.reference, fmt::format("{:.6g}", m.reference_error()));
    for (const PeerOutcome& peer : m.peers)
      text += fmt::format("{},{},\"{}\",,{},{:g},,{:d},{},{:.6g},,,,,,,\n", m.problem.name, peer.program, peer.variant,
                          peer.segments, peer.step, peer.completed,
                          peer.completed ? fmt::format("{:.6g}", peer.error) : "", peer.seconds);
    for (const SpeedTarget& target : speed_targets()) {
      if (target.problem != m.problem.name) continue;
      text += fmt::format("{},target,,,,,,1,{:g},{:g},,,,,,,\n", m.problem.name, target.error, target.target_seconds);
      text += fmt::format("{},public,,,,,,1,{:g},{:g},,,,,,,\n", m.problem.name, target.error, target.public_seconds);
    }
  }
  return text;
}

}  // namespace flexarm::bench
