// Writes the accuracy report as text.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "bench/accuracy.h"
#include "bench/markdown_table.h"
#include "bench/median.h"

namespace flexarm::bench {
namespace {

/// Targets for the share of runs with larger errors, for the largest ratio, and for the cost.
constexpr double kShareAbove = 0.05, kLargestRatio = 3, kLargestCost = 1.5;

/// The group of scripts/outside_references in which bodies hit each other. Its scenes are cornered.
constexpr const char* kContacts = "contacts";

std::string number(double value, const char* format) {
  return std::isfinite(value) ? fmt::vformat(format, fmt::format_args(fmt::make_format_args(value))) : "–";
}

/// Counts of outcomes.
struct Summary {
  int runs = 0, met = 0, judged = 0, above = 0, dear = 0;
  int bound = 0;  // number of expensive ones whose scene names a scheme, although the best choice has another
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

std::string corners_of(const AccuracyMeasurement& measurement) {
  return measurement.is_cornered ? "cornered" : "smooth";
}

/// Summary of the scenes with corners, or of those without.
Summary summary_of(const AccuracyReport& report, bool is_cornered) {
  Summary summary;
  for (const AccuracyMeasurement& measurement : report.measurements)
    if (measurement.is_cornered == is_cornered)
      for (const AccuracyOutcome& outcome : measurement.outcomes) summary.add(outcome);
  return summary;
}

/// Summary of the scenes in which bodies hit each other.
Summary summary_of_contacts(const AccuracyReport& report) {
  Summary summary;
  for (const AccuracyMeasurement& measurement : report.measurements)
    if (measurement.group == kContacts)
      for (const AccuracyOutcome& outcome : measurement.outcomes) summary.add(outcome);
  return summary;
}

std::string target_line(const std::string& name, const Summary& all) {
  if (all.judged == 0) return fmt::format("{}: none of {} runs is judged.\n", name, all.runs);
  const bool is_accurate = all.above <= kShareAbove * all.judged && all.worst <= kLargestRatio;
  const bool is_cheap = !(median(all.costs) > kLargestCost);
  return fmt::format(
      "{}: true error at most the requested one in {:.1f} % of {} judged runs (target: 95 %), at worst {:.3g} times "
      "the requested one (target: 3): {}; "
      "cost over the best fixed choice {} in the median of {} (target: {:g}): {}; {} of {} runs report that they do "
      "not meet it.\n",
      name, 100 - 100.0 * all.above / all.judged, all.judged, all.worst, is_accurate ? "met" : "missed",
      number(median(all.costs), "{:.2f}"), all.costs.size(), kLargestCost, is_cheap ? "met" : "missed",
      all.runs - all.met, all.runs);
}

std::string summary_table(const AccuracyReport& report) {
  std::map<double, Summary, std::greater<>> by_accuracy[2];  // [0]: smooth, [1]: cornered
  std::map<std::string, Summary> by_group;
  for (const AccuracyMeasurement& measurement : report.measurements)
    for (const AccuracyOutcome& outcome : measurement.outcomes) {
      by_accuracy[measurement.is_cornered][outcome.asked].add(outcome);
      by_group[measurement.group + (measurement.is_outside ? "" : ", by finer runs")].add(outcome);
      if (outcome.cost())
        by_group[outcome.is_of_own_scheme ? "best fixed choice: scene's scheme" : "best fixed choice: another scheme"]
            .add(outcome);
    }
  std::string text = head({"", "runs", "met, as reported", "judged", "error above", "worst error over requested",
                           "with a best fixed choice", "cost over it, median", "above 1.5", "with all tries, median"});
  for (const bool is_cornered : {true, false}) {
    const char* name = is_cornered ? "cornered" : "smooth";
    for (const auto& [accuracy, summary] : by_accuracy[is_cornered])
      text += row(summary.cells(fmt::format("{}, {:g}", name, accuracy)));
    text += row(summary_of(report, is_cornered).cells(fmt::format("**{}**", name)));
  }
  for (const auto& [group, summary] : by_group) text += row(summary.cells(group));
  std::string lines = accuracy_summary(report);
  for (std::size_t end = 0; (end = lines.find('\n', end)) != std::string::npos; end += 2) lines.insert(end, "\n");
  return text + "\n" + lines;
}

std::string outcome_row(const AccuracyMeasurement& measurement, const AccuracyOutcome& outcome) {
  const std::string why = !outcome.is_met ? "not met: " + outcome.shortcoming : outcome.error ? "" : "no reference";
  return row({measurement.group + ": " + measurement.name, corners_of(measurement), fmt::format("{:g}", outcome.asked),
              outcome.is_met ? number(outcome.estimate, "{:.2e}") : "–",
              outcome.error ? fmt::format("{:.2e}{}", *outcome.error, *outcome.error > outcome.asked ? " ▲" : "") : "–",
              outcome.error ? fmt::format("{:.2f}", *outcome.error / outcome.asked) : "–",
              fmt::format("{:.3g}", 1e3 * outcome.seconds), fmt::format("{:.3g}", 1e3 * outcome.all_seconds),
              outcome.fixed_seconds ? fmt::format("{:.3g}", 1e3 * *outcome.fixed_seconds) : "–",
              outcome.cost() ? fmt::format("{:.2f}", *outcome.cost()) : "–", std::to_string(outcome.iterations),
              outcome.fixed_seconds ? std::to_string(outcome.fixed_iterations) : "–", outcome.fixed + why});
}

std::string scenes_of(const AccuracyScope& scope) {
  const std::string chosen = scope.only.empty() ? "" : fmt::format("Those with '{}' in their names: ", scope.only);
  if (!scope.random_arms)
    return chosen + "Scenes of small mechanisms, of the speed report, of `config/` and random arms";
  const auto& [first, count] = *scope.random_arms;
  return fmt::format("{}Random arms {} to {}, and no other scenes,", chosen, first, first + count - 1);
}

constexpr const char* kIntroduction =
    R"( are run by `flexarm simulate --accuracy`, which chooses the steps for the accuracy, and the elements
of beams with `elements="auto"`. *Cornered* scenes have jumps, kinks, stops, contact, dry friction, play, motors and servos at
their limits, or sampled servos; *smooth* ones have none of these.

The true error is measured against a reference motion. For rigid mechanisms in a plane, it is not computed by flexarm,
but by scipy's DOP853 from equations written from the documentation, with tolerances of 1e-12 and corners located in time
(`scripts/outside_references`; two runs of each reference agree to 1e-9). For the other groups, *by finer runs*, the
reference is a run of flexarm whose steps are shifted against those of all other runs. With corners, it must agree with
a run of twice its step to a tenth of the requested accuracy. Without corners, it has half the step of a run that is
estimated to be ten times as accurate as requested. Runs without such a reference are not judged. If the scene gives a
number of elements, errors are relative to that mesh.

The best fixed choice is the cheapest run with equal steps whose error is at most the true error of the accurate run:
scheme, step, tolerance, and meshes where they are free ([notes](../notes/tuning.md)). Times are processor times, medians
of three in turns where two are compared; iterations are those of Newton's method.

)";

}  // namespace

std::string accuracy_summary(const AccuracyReport& report) {
  return target_line("Cornered", summary_of(report, true)) +
         target_line("Of these with contact", summary_of_contacts(report)) +
         target_line("Smooth", summary_of(report, false));
}

std::string to_markdown(const AccuracyReport& report, const std::string& picture) {
  std::string text = "# Requested accuracy and true error\n\nWritten by `flexarm bench accuracy`. " +
                     scenes_of(report.scope) + kIntroduction;
  if (report.scope.quick) text += "**Quick run: shows that it works, measures nothing.**\n\n";
  text += summary_table(report);
  if (!picture.empty())
    text += fmt::format("\n![True error over requested error, and cost over the best fixed choice]({})\n", picture);
  text += "\n## All runs\n\n";
  text += head({"scene", "corners", "requested", "estimated", "true error", "true over requested", "run [ms]",
                "with all tries [ms]", "best fixed [ms]", "cost", "iterations of the run", "of the best fixed",
                "best fixed choice, or why not"});
  for (const AccuracyMeasurement& measurement : report.measurements)
    for (const AccuracyOutcome& outcome : measurement.outcomes) text += outcome_row(measurement, outcome);
  return text + fmt::format("\n{:.0f} s of computing.\n", report.seconds);
}

std::string accuracy_to_csv(const AccuracyReport& report) {
  std::string text =
      "group,scene,corners,reference,until,asked,met,estimate,error,reference_error,seconds,all_seconds,iterations,"
      "fixed_seconds,"
      "fixed_iterations,fixed,shortcoming\n";
  const auto quoted = [](std::string cell) {
    std::replace(cell.begin(), cell.end(), '"', '\'');
    return '"' + cell + '"';
  };
  for (const AccuracyMeasurement& measurement : report.measurements)
    for (const AccuracyOutcome& o : measurement.outcomes)
      text += fmt::format("{},{},{},{},{:g},{:g},{},{:.4g},{},{:.4g},{:.4g},{:.4g},{},{},{},{},{}\n", measurement.group,
                          quoted(measurement.name), corners_of(measurement),
                          measurement.is_outside ? "outside" : "finer", measurement.until, o.asked, o.is_met ? 1 : 0,
                          o.estimate, o.error ? fmt::format("{:.4g}", *o.error) : "", o.reference_error, o.seconds,
                          o.all_seconds, o.iterations, o.fixed_seconds ? fmt::format("{:.4g}", *o.fixed_seconds) : "",
                          o.fixed_seconds ? std::to_string(o.fixed_iterations) : "", quoted(o.fixed),
                          quoted(o.shortcoming));
  return text;
}

}  // namespace flexarm::bench
