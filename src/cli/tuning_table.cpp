#include "cli/tuning_table.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace flexarm::cli {
namespace {

bool is_reference(const TuningResult& result, const TunedRun& run) {
  return result.reference && !(run.settings < *result.reference) && !(*result.reference < run.settings);
}

std::string role_of(const TuningResult& result, std::size_t i) {
  if (result.best == i) return "best";
  if (is_reference(result, result.runs[i])) return "reference";
  return i == 0 ? "scene" : "run";
}

/// Whether run `i` is in the table.
bool is_shown(const TuningResult& result, std::size_t i) {
  const TunedRun& run = result.runs[i];
  if (!run.failure.empty()) return i == 0;
  if (role_of(result, i) != "run") return true;
  return std::none_of(result.runs.begin(), result.runs.end(), [&](const TunedRun& other) {
    return other.failure.empty() && other.seconds < run.seconds && other.error <= run.error;
  });
}

std::string quoted(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  return text.find_first_of(",\n") == std::string::npos ? text : '"' + text + '"';
}

}  // namespace

std::string tuning_table(const TuningResult& result, const JudgedTimes& times) {
  std::vector<std::size_t> shown;
  std::size_t widest = 8;
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    if (is_shown(result, i)) {
      shown.push_back(i);
      widest = std::max(widest, result.runs[i].settings.mesh().size());
    }
  std::sort(shown.begin(), shown.end(),
            [&](std::size_t a, std::size_t b) { return result.runs[a].seconds < result.runs[b].seconds; });
  std::string out = fmt::format("{:10} {:{}} {:>13} {:>10} {:>9} {:>8} {:>10} {:>9} {:>10}\n", "", "elements", widest,
                                "scheme", "step [s]", "tolerance", "unknowns", "time [s]", "real time", "error");
  for (const std::size_t i : shown) {
    const TunedRun& run = result.runs[i];
    const std::string role = role_of(result, i);
    out += fmt::format("{:10} {:{}} {:>13} {:>10.4g} {:>9.0e} {:>8} {:>10.3g} {:>9.3g} {:>10}\n",
                       role == "run" ? "" : role, run.settings.mesh(), widest, run.settings.scheme, run.settings.step,
                       run.settings.tolerance, run.unknowns, run.seconds,
                       run.seconds > 0 ? times.until() / run.seconds : 0.0,
                       !run.failure.empty()  ? "failed"
                       : role == "reference" ? "-"
                                             : fmt::format("{:.2e}", run.error));
  }
  return out;
}

std::string tuning_csv(const TuningResult& result, const JudgedTimes& times) {
  std::string out = "role,mesh,scheme,step,tolerance,unknowns,steps,iterations,seconds,times_real_time,error,failure\n";
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    const TunedRun& run = result.runs[i];
    out += fmt::format("{},{},{},{},{},{},{},{},{:.6g},{:.6g},{},{}\n", role_of(result, i), quoted(run.settings.mesh()),
                       run.settings.scheme, run.settings.step, run.settings.tolerance, run.unknowns, run.steps,
                       run.iterations, run.seconds, run.seconds > 0 ? times.until() / run.seconds : 0.0,
                       run.failure.empty() ? fmt::format("{:.6g}", run.error) : "", quoted(run.failure));
  }
  return out;
}

}  // namespace flexarm::cli
