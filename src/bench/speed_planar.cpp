// Measures how much time steps in a plane save.
#include <algorithm>

#include <fmt/format.h>

#include "bench/markdown_table.h"
#include "bench/median.h"
#include "bench/speed.h"

namespace flexarm::bench {
namespace {

constexpr int kTurns = 15;

}  // namespace

std::vector<PlanarComparison> compare_planar(const std::string& folder, const SpeedReport& report) {
  std::vector<PlanarComparison> comparisons;
  for (const SpeedMeasurement& m : report.measurements) {
    if (m.problem.name != "spin_up" && m.problem.name != "double_pendulum") continue;
    for (const double error : {1e-2, 1e-3, 1e-4}) {
      const SpeedOutcome* fastest = m.fastest(error);
      if (!fastest) continue;
      Discretisation plane = fastest->discretisation, space = plane;
      space.may_be_planar = false;
      std::vector<double> in_plane, in_space;
      double difference = 0;
      for (int turn = 0; turn < (report.quick ? 1 : kTurns); ++turn) {
        const SpeedRun a = run_speed(folder, m.problem, plane), b = run_speed(folder, m.problem, space);
        in_plane.push_back(a.seconds);
        in_space.push_back(b.seconds);
        difference = trajectory_error(a.trajectory, b.trajectory);
      }
      comparisons.push_back(
          {m.problem.name, error, plane, median(in_plane), median(in_space), fastest->run.steps, difference});
    }
  }
  return comparisons;
}

std::string planar_table(const std::vector<PlanarComparison>& comparisons) {
  std::string text = head({"problem", "error at most", "scheme", "elements x order", "step [s]", "in the plane [ms]",
                           "µs per step", "three-dimensional [ms]", "ratio", "difference"});
  for (const PlanarComparison& c : comparisons)
    text += row({c.problem, fmt::format("{:g}", c.error), c.discretisation.scheme, c.discretisation.mesh(),
                 fmt::format("{:g}", c.discretisation.step), fmt::format("{:.3g}", 1e3 * c.plane_seconds),
                 fmt::format("{:.3g}", 1e6 * c.plane_seconds / static_cast<double>(c.steps)),
                 fmt::format("{:.3g}", 1e3 * c.space_seconds), fmt::format("{:.2g}", c.space_seconds / c.plane_seconds),
                 fmt::format("{:.1e}", c.difference)});
  return text;
}

}  // namespace flexarm::bench
