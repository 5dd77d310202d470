// The accuracy report as text.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "bench/accuracy.h"
#include "bench/markdown_table.h"
#include "bench/median.h"

namespace flexarm::bench {
namespace {

/// What is aimed at.
constexpr double kShareAbove = 0.05, kLargestRatio = 3, kLargestCost = 1.5;

std::string number(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "–";
}

/// Counts of outcomes.
struct Summary {
  int runs = 0, met = 0, judged = 0, above = 0, dear = 0;
  int bound = 0;  // of the dear ones, those whose scene names a scheme, and another one is the best choice
  double worst = 0;
  std::vector<double> costs, all_costs;

  void add(const AccuracyOutcome& outcome) {
    ++runs;
    met += outcome.is_met;
    if (!outcome.is_judged()) return;
    ++judged;
    const double ratio = *outcome.error / outcome.asked;
    above += ratio > 1;
    worst = std::max(worst, ratio);
    if (!outcome.cost()) return;
    costs.push_back(*outcome.cost());
    all_costs.push_back(outcome.all_seconds / *outcome.fixed_seconds);
    const bool is_dear = *outcome.cost() > kLargestCost;
    dear += is_dear;
    bound += is_dear && !outcome.may_change_scheme && !outcome.is_of_own_scheme;
  }
  std::vector<std::string> cells(const std::string& name) const {
    return {name,
            std::to_string(runs),
            std::to_string(met),
            std::to_string(judged),
            std::to_string(above),
            judged > 0 ? fmt::format("{:.2f}", worst) : "–",
            std::to_string(costs.size()),
            number(median(costs), "{:.2f}"),
            std::to_string(dear),
            number(median(all_costs), "{:.2f}")};
  }
};

std::string summary_table(const AccuracyReport& report) {
  std::map<double, Summary, std::greater<>> by_accuracy;
  std::map<std::string, Summary> by_group;
  Summary all;
  for (const AccuracyMeasurement& measurement : report.measurements)
    for (const AccuracyOutcome& outcome : measurement.outcomes) {
      by_accuracy[outcome.asked].add(outcome);
      by_group[measurement.group].add(outcome);
      if (outcome.cost())
        by_group[outcome.is_of_own_scheme ? "best fixed choice: scene's scheme" : "best fixed choice: another scheme"]
            .add(outcome);
      all.add(outcome);
    }
  std::string text = head({"", "runs", "met, as they say", "judged", "error above", "worst error over asked",
                           "with a best fixed choice", "cost over it, median", "above 1.5", "with all tries, median"});
  for (const auto& [accuracy, summary] : by_accuracy) text += row(summary.cells(fmt::format("{:g}", accuracy)));
  for (const auto& [group, summary] : by_group) text += row(summary.cells(group));
  text += row(all.cells("all"));
  const bool is_accurate = all.above <= kShareAbove * all.judged && all.worst <= kLargestRatio;
  text += fmt::format(
      "\nTrue error at most the asked-for in {:.1f} % of {} judged runs (target: 95 %), at most {:.2f} times it "
      "(target: 3): {}.\n",
      all.judged > 0 ? 100 - 100.0 * all.above / all.judged : 0.0, all.judged, all.worst,
      is_accurate ? "met" : "missed");
  text += fmt::format("Cost of the run above 1.5 times that of the best fixed choice: {} of {} (target: none): {}.",
                      all.dear, all.costs.size(), all.dear == 0 ? "met" : "missed");
  if (all.bound > 0)
    text += fmt::format(" In {} of them the scene names its scheme, and the best choice has another one.", all.bound);
  text += "\n";
  return text;
}

std::string outcome_row(const AccuracyMeasurement& measurement, const AccuracyOutcome& outcome) {
  const std::string why = !outcome.is_met ? "not met: " + outcome.shortcoming : outcome.error ? "" : "no reference";
  return row({measurement.group + ": " + measurement.name, fmt::format("{:g}", outcome.asked),
              outcome.is_met ? number(outcome.estimate, "{:.2e}") : "–",
              outcome.error ? fmt::format("{:.2e}{}", *outcome.error, *outcome.error > outcome.asked ? " ▲" : "") : "–",
              fmt::format("{:.3g}", 1e3 * outcome.seconds), fmt::format("{:.3g}", 1e3 * outcome.all_seconds),
              outcome.fixed_seconds ? fmt::format("{:.3g}", 1e3 * *outcome.fixed_seconds) : "–",
              outcome.cost() ? fmt::format("{:.2f}", *outcome.cost()) : "–", std::to_string(outcome.iterations),
              outcome.fixed_seconds ? std::to_string(outcome.fixed_iterations) : "–", outcome.fixed + why});
}

std::string scenes_of(const AccuracyScope& scope) {
  if (!scope.random_arms) return "Scenes of the speed report, of `config/` and random arms";
  const auto& [first, count] = *scope.random_arms;
  return fmt::format("Random arms {} to {}, and no other scenes,", first, first + count - 1);
}

}  // namespace

std::string to_markdown(const AccuracyReport& report, const std::string& picture) {
  std::string text =
      "# Accuracy asked for, error got\n\n"
      "Written by `flexarm bench accuracy`. " +
      scenes_of(report.scope) +
      " are run as `flexarm simulate\n"
      "--accuracy` runs them: steps, and elements of beams with `elements=\"auto\"`, are chosen for the accuracy. The "
      "true error is that against a\n"
      "run which is estimated to be at least five times as accurate; where none is found in the time that a scene has, "
      "nothing is judged. Where the\n"
      "scene gives a number of elements, that mesh is the truth. The best fixed choice is what the search of `flexarm "
      "tune` finds for the error\n"
      "that the run really has: scheme, step, tolerance, and meshes where they are free ([notes](../notes/tuning.md)). "
      "Times are the\nprocessor's, medians of three in turns where two are compared; iterations are those of Newton's "
      "method.\n\n";
  if (report.scope.quick) text += "**Quick run: shows that it works, measures nothing.**\n\n";
  text += summary_table(report);
  if (!picture.empty())
    text += fmt::format("\n![True error over asked-for error, and cost over the best fixed choice]({})\n", picture);
  text += "\n## All runs\n\n";
  text += head({"scene", "asked", "estimate", "error", "run [ms]", "with all tries [ms]", "best fixed [ms]", "cost",
                "iterations of the run", "of the best fixed", "best fixed choice, or why not"});
  for (const AccuracyMeasurement& measurement : report.measurements)
    for (const AccuracyOutcome& outcome : measurement.outcomes) text += outcome_row(measurement, outcome);
  return text + fmt::format("\n{:.0f} s of computing.\n", report.seconds);
}

std::string accuracy_to_csv(const AccuracyReport& report) {
  std::string text =
      "group,scene,until,asked,met,estimate,error,reference_error,seconds,all_seconds,iterations,fixed_seconds,"
      "fixed_iterations,fixed,shortcoming\n";
  const auto quoted = [](std::string cell) {
    std::replace(cell.begin(), cell.end(), '"', '\'');
    return '"' + cell + '"';
  };
  for (const AccuracyMeasurement& measurement : report.measurements)
    for (const AccuracyOutcome& o : measurement.outcomes)
      text += fmt::format("{},{},{:g},{:g},{},{:.4g},{},{:.4g},{:.4g},{:.4g},{},{},{},{},{}\n", measurement.group,
                          quoted(measurement.name), measurement.until, o.asked, o.is_met ? 1 : 0, o.estimate,
                          o.error ? fmt::format("{:.4g}", *o.error) : "", o.reference_error, o.seconds, o.all_seconds,
                          o.iterations, o.fixed_seconds ? fmt::format("{:.4g}", *o.fixed_seconds) : "",
                          o.fixed_seconds ? std::to_string(o.fixed_iterations) : "", quoted(o.fixed),
                          quoted(o.shortcoming));
  return text;
}

}  // namespace flexarm::bench
