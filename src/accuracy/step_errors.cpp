#include "accuracy/step_errors.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "schemes/scheme.h"

namespace flexarm {
namespace {

constexpr int kMostParts = 1 << 14;
/// If differences fall by less than this ratio from step to step, runs do not converge yet. A scheme of first order has
/// 0.5.
constexpr double kLargestRatio = 0.7;
/// Relative to the displacement: round-off of positions far from the origin, and what Newton's method leaves of these.
constexpr double kRoundOff = 1e-10;
/// The search ends after this many runs in a row that are no better than the ones before.
constexpr int kIdleRuns = 3;

/// The smallest ratio of successive differences, when the step is halved.
double ratio_of(const RunSettings& settings) {
  int order = 8;
  for (const Scheme* scheme : meanings(settings.scheme)) order = std::min(order, scheme->order);
  return std::pow(0.5, order);
}

}  // namespace

double StepErrors::finest() const {
  return has_errors() ? size(errors.back()) : std::numeric_limits<double>::infinity();
}

MotionDifference StepErrors::at(int wanted) const {
  std::size_t first = 0;
  while (first < errors.size() && errors[first].size() == 0) ++first;
  if (first == errors.size() || wanted < parts[first]) return {};
  std::size_t i = first;
  while (i + 1 < errors.size() && parts[i + 1] <= wanted) ++i;
  const std::size_t a = i + 1 < errors.size() || i == first ? i : i - 1, b = std::min(a + 1, errors.size() - 1);
  double slope = ratio_of(settings) > 0.3 ? 1 : 2;
  const double coarse = size(errors[a]), fine = size(errors[b]);
  if (b > a && fine > 0 && coarse > fine) slope = std::log2(coarse / fine);
  return errors[i] * std::pow(static_cast<double>(parts[i]) / wanted, slope);
}

double StepErrors::iterations_per_step(int wanted) const {
  double found = 0;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i]->is_complete() && (found == 0 || parts[i] <= wanted))
      found = static_cast<double>(runs[i]->iterations) / static_cast<double>(runs[i]->steps);
  return found;
}

double StepErrors::seconds_per_iteration() const {
  double seconds = 0, iterations = 0;
  for (const TrialRun* run : runs)
    if (run->is_complete()) seconds += run->seconds, iterations += static_cast<double>(run->iterations);
  return seconds / iterations;
}

namespace {

/// Computes all errors relative to the extrapolated limit of the finest runs. Returns the ratio of the last two
/// differences, or 0 if the last difference is at most `floor`.
double extrapolate(StepErrors& series, double floor) {
  const std::size_t count = series.runs.size();
  const auto is_complete = [&](std::size_t i) { return series.runs[i]->is_complete(); };
  series.errors.assign(count, {});
  if (count < 2 || !is_complete(count - 2) || !is_complete(count - 1)) return 1;
  const MotionDifference last = difference(series.runs[count - 2]->motion, series.runs[count - 1]->motion);
  double ratio = 1;
  if (count > 2 && is_complete(count - 3)) {
    const double before = size(difference(series.runs[count - 3]->motion, series.runs[count - 2]->motion));
    ratio = before > 0 ? size(last) / before : 1;
  }
  const double used = std::clamp(ratio, ratio_of(series.settings), kLargestRatio);
  const MotionDifference finest = last * (used / (1 - used));
  for (std::size_t i = 0; i < count; ++i)
    if (is_complete(i)) series.errors[i] = difference(series.runs[i]->motion, series.runs[count - 1]->motion) + finest;
  return size(last) <= floor ? 0 : ratio;
}

}  // namespace

StepErrors measure_steps(TrialRuns& trials, RunSettings settings, double wanted, double most_seconds) {
  StepErrors series;
  int idle = 0;
  for (int parts = 1; parts <= kMostParts && idle < kIdleRuns; parts *= 2) {
    settings.step = trials.times().interval / parts;
    const TrialRun& run = trials.run(settings, most_seconds);
    if (run.is_given_up) {
      series.shortcoming = run.failure;
      return series;
    }
    const double before = series.finest();
    series.settings = settings;
    series.parts.push_back(parts);
    series.runs.push_back(&run);
    series.shortcoming = run.failure;
    const double scale = run.is_complete() ? run.length_of_errors() : 0;
    const double ratio = extrapolate(series, kRoundOff * scale);
    if (!series.has_errors()) continue;
    const double error = series.finest();
    series.is_met = error <= wanted * scale && ratio <= kLargestRatio;
    if (series.is_met) return series;
    series.shortcoming = fmt::format("steps of {:.3g} s have errors of {:.2g}", settings.step, error / scale);
    if (ratio == 0) break;
    idle = error > 0.9 * before ? idle + 1 : 0;
  }
  if (series.has_errors()) series.shortcoming += ", and smaller steps do not help";
  return series;
}

}  // namespace flexarm
