// Writes the thesis report as text.
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "bench/thesis.h"

namespace flexarm::bench {
namespace {

constexpr std::size_t kMostCrossings = 6;

std::string outcome_cell(const ThesisOutcome& out) {
  if (out.arrival) return fmt::format("arrives at {:.4g} s", *out.arrival);
  if (out.failure) return fmt::format("fails at {:.4g} s ({})", out.failure->time, to_string(out.failure->reason));
  return fmt::format("completes {:g} s", out.end);
}

std::string crossings_cell(const std::vector<double>& crossings) {
  std::string text;
  for (std::size_t i = 0; i < std::min(crossings.size(), kMostCrossings); ++i)
    text += fmt::format("{}{:.4g}", i == 0 ? "" : ", ", crossings[i]);
  if (crossings.size() > kMostCrossings) text += fmt::format(" … {:.4g} ({})", crossings.back(), crossings.size());
  return text.empty() ? "–" : text;
}

std::string final_cell(const ThesisExample& example, const ThesisOutcome& out) {
  // From the last row of the history: the first observable and the first probe, or r, z, theta.
  std::string text;
  const std::vector<double>& row = out.history.back();
  for (std::size_t k = 0; k < 4 && k < example.observables.size(); ++k)
    text += fmt::format("{}{:.3f}", k == 0 ? "" : ", ", row[3 + k]);
  return text;
}

std::string example_table(const ThesisExample& example, const std::vector<ThesisOutcome>& outcomes) {
  std::string text = "| run | step [s] | thesis | flexarm | halvings | iterations | borders passed at [s] | ";
  text += fmt::format("last {}, {}, {}, {} | energy defect |", example.observables[0], example.observables[1],
                      example.observables[2], example.observables[3]);
  text += example.conserves_angular_momentum ? " angular momentum defect |\n" : "\n";
  text += "|---|---|---|---|---|---|---|---|---|";
  text += example.conserves_angular_momentum ? "---|\n" : "\n";
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const ThesisRun& run = example.runs[i];
    const ThesisOutcome& out = outcomes[i];
    text += fmt::format("| {} | {:g} | {} | {} | {} | {:.1f} | {} | {} | {:.1e} |", run.label, run.step,
                        run.statement.empty() ? "–" : run.statement, outcome_cell(out), out.halvings, out.iterations,
                        crossings_cell(out.crossings), final_cell(example, out), out.energy_defect);
    text += example.conserves_angular_momentum ? fmt::format(" {:.1e} |\n", out.angular_momentum_defect) : "\n";
  }
  return text;
}

/// Whether a label is the algorithm's name, alone or after ", ": "H2, alg3" ends with "alg3".
bool ends_with(const std::string& label, const std::string& algorithm) {
  return label == algorithm ||
         (label.size() > algorithm.size() + 2 &&
          label.compare(label.size() - algorithm.size() - 2, std::string::npos, ", " + algorithm) == 0);
}

/// Mesh and step of a run; empty if the run has another algorithm.
std::optional<std::string> conditions(const ThesisRun& run, const std::string& algorithm) {
  if (!ends_with(run.label, algorithm)) return std::nullopt;
  return run.label.substr(0, run.label.size() - algorithm.size()) + fmt::format("{:g}", run.step);
}

/// Results of each contact algorithm in those runs that all of them have: at the thesis's steps, and back and forth.
std::string summary_table(const ThesisReport& report) {
  std::string text =
      "| run | runs | completed | halvings | iterations | ms per step | largest energy defect of the completed |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const char* name : {"trapezoidal rule", "alg1", "alg2", "alg3", "alg4", "em, sm_em", "em, sm_em, smooth line"}) {
    int runs = 0, completed = 0, halvings = 0;
    double iterations = 0, defect = 0, seconds = 0, steps = 0;
    for (std::size_t e = 0; e < report.examples.size(); ++e) {
      const std::vector<ThesisRun>& all = report.examples[e].runs;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const std::optional<std::string> mine = conditions(all[i], name);
        const auto has_mine = [&](const ThesisRun& run) { return conditions(run, "alg3") == mine; };
        if (!mine || std::none_of(all.begin(), all.end(), has_mine)) continue;
        const ThesisOutcome& out = report.outcomes[e][i];
        ++runs;
        iterations += out.iterations;
        halvings += out.halvings;
        seconds += out.seconds;
        steps += out.end / all[i].step;
        if (out.failure) continue;
        ++completed;
        defect = std::max(defect, out.energy_defect);
      }
    }
    text += fmt::format("| {} | {} | {} | {} | {:.1f} | {:.2f} | {:.1e} |\n", name, runs, completed, halvings,
                        iterations / std::max(runs, 1), 1e3 * seconds / std::max(steps, 1.0), defect);
  }
  return text;
}

}  // namespace

std::string to_markdown(const ThesisReport& report, const std::function<std::string(const std::string&)>& picture) {
  std::string text =
      "# The five examples of Muñoz 2004, chapter 12\n\n"
      "Written by `flexarm bench thesis`; the scenes are in `config/thesis`. Every run that the text of the thesis "
      "describes, with what it states, then those with flexarm's own contact (`sm_em`), with a smooth line (tangents "
      "continuous over the borders of elements) and with four times the thesis's step. A step that fails is halved, "
      "five times at most, as in the thesis.\n\n"
      "- *iterations*: of Newton's method per step, halved steps and rejected tries included (factors are kept while "
      "they serve).\n"
      "- *energy defect*: largest |change of energy - work + dissipated| over the run, over the largest kinetic, "
      "strain "
      "or potential energy in it.\n"
      "- *borders passed*: times at the end of the step in which the contact passed from one element into another.\n"
      "\n## What decides the default\n\nNode-to-element runs under the same conditions: the thesis's meshes and steps, "
      "and back and forth.\n\n" +
      summary_table(report);
  for (std::size_t e = 0; e < report.examples.size(); ++e) {
    const ThesisExample& example = report.examples[e];
    text += fmt::format("\n## {} {}\n\n", example.number, example.title);
    for (const std::string& note : example.notes) text += "- " + note + "\n";
    text += "\n" + example_table(example, report.outcomes[e]);
    if (const std::string file = picture(example.number); !file.empty())
      text += fmt::format("\n![{}]({})\n", example.title, file);
  }
  return text;
}

}  // namespace flexarm::bench
