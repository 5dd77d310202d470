// Writes the scaling report as text.
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "bench/markdown_table.h"
#include "bench/scaling.h"

namespace flexarm::bench {
namespace {

/// Sizes below this fraction of the largest one are left out, since fixed costs dominate there.
constexpr double kUpperPart = 0.01;
/// Largest slope that counts as linear, since caches may raise it slightly.
constexpr double kLinear = 1.05;

struct Quantity {
  const char* name;
  double ScalingPoint::*value;
  double scale;  ///< from the table's unit to SI
};
constexpr Quantity kRead = {"read [ms]", &ScalingPoint::read_seconds, 1e3},
                   kFirstBuild = {"first build [ms]", &ScalingPoint::first_build_seconds, 1e3},
                   kBuild = {"build [ms]", &ScalingPoint::build_seconds, 1e3},
                   kStep = {"step [ms]", &ScalingPoint::step_seconds, 1e3},
                   kMemory = {"memory [MB]", &ScalingPoint::bytes, 1e-6};
constexpr Quantity kQuantities[] = {kRead, kFirstBuild, kBuild, kStep, kMemory};

/// Slope over the sizes of at least `part` times the largest one.
double slope_of(const ScalingSeries& series, double ScalingPoint::*value, double part) {
  std::vector<double> sizes, values;
  for (const ScalingPoint& point : series.points) {
    if (!point.completed) continue;
    sizes.push_back(point.size);
    values.push_back(point.*value);
  }
  return log_slope(sizes, values, part);
}

std::string slope_cell(double slope) {
  if (!std::isfinite(slope)) return "–";
  return fmt::format(slope <= kLinear ? "{:.2f}" : "**{:.2f}**", slope);
}

std::string slope_table(const ScalingReport& report) {
  std::string text = "| scenes | up to | read | first build | build | step | memory |\n|---|---|---|---|---|---|---|\n";
  for (const ScalingSeries& series : report.series) {
    text += fmt::format("| {} | {} {} |", series.family.name, series.points.back().size, series.family.unit);
    for (const Quantity& quantity : kQuantities)
      text += fmt::format(" {}, {} |", slope_cell(slope_of(series, quantity.value, 0)),
                          slope_cell(slope_of(series, quantity.value, kUpperPart)));
    text += "\n";
  }
  return text;
}

/// The steepest slopes over the two upper decades, compared with the target.
std::string target_table(const ScalingReport& report) {
  std::string text = head({"slope over the two upper decades", "target", "steepest", "verdict"});
  for (const Quantity& quantity : {kFirstBuild, kBuild, kStep}) {
    double steepest = -std::numeric_limits<double>::infinity();
    std::string name = "–";
    for (const ScalingSeries& series : report.series) {
      const double slope = slope_of(series, quantity.value, kUpperPart);
      if (slope > steepest) steepest = slope, name = series.family.name;
    }
    if (std::isfinite(steepest))
      text += row({quantity.name, fmt::format("{:g}", kLinear), fmt::format("{:.2f}: {}", steepest, name),
                   steepest <= kLinear ? "met" : "missed"});
  }
  return text;
}

std::string point_table(const ScalingSeries& series) {
  std::string text = fmt::format("| {} | unknowns |", series.family.unit);
  for (const Quantity& quantity : kQuantities) text += fmt::format(" {} |", quantity.name);
  text += " Newton iterations per step | us per iteration and unknown |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const ScalingPoint& point : series.points) {
    text += fmt::format("| {} | {} |", point.size, point.unknowns);
    if (!point.completed) {
      text += " – | – | – | fails | – | – | – |\n";
      continue;
    }
    for (const Quantity& quantity : kQuantities)
      text += fmt::format(" {:.3g} |", quantity.scale * (point.*quantity.value));
    const double work = point.iterations * static_cast<double>(point.unknowns);
    text += fmt::format(" {:.1f} | {:.2f} |\n", point.iterations, 1e6 * point.step_seconds / work);
  }
  return text;
}

}  // namespace

std::string to_markdown(const ScalingReport& report, const std::string& picture) {
  std::string text =
      "# How time and memory grow with the size of a mechanism\n\n"
      "Written by `flexarm bench scaling`. Scheme `em`, steps of 1 ms, full Newton; times are processor times of one "
      "thread.\n\n"
      "- *read*: from URDF text to a scene description, the shortest of three tries; *first build*: from there to a "
      "simulation, the first time, with new memory from the system; *build*: the shortest of three further tries, with "
      "memory that the process already has, since `flexarm` keeps it; *step*: the fastest of five batches.\n"
      "- *memory*: allocated by malloc for the simulation after these steps.\n"
      "- *slopes*: of the logarithms, by least squares: over all sizes, where the fixed cost of small ones flattens "
      "them, and "
      "over the two upper decades; 1 is linear. Bold: above 1.05. A table of two points only, or of times below a "
      "millisecond, says little.\n"
      "- When memory outgrows the processor's caches, the same work takes longer, which bends the curves upwards in "
      "the middle. The first build depends on the system: with `GLIBC_TUNABLES=glibc.malloc.hugetlb=1` in the "
      "environment glibc requests huge pages, which the system provides much faster.\n\n" +
      target_table(report) + "\n" + slope_table(report);
  if (!picture.empty()) text += fmt::format("\n![Time per step, time to build and memory over size]({})\n", picture);
  for (const ScalingSeries& series : report.series)
    text += fmt::format("\n## {}\n\n{}\n\n{}", series.family.name, series.family.description, point_table(series));
  return text;
}

std::string scaling_to_csv(const ScalingReport& report) {
  std::string text = "family,unit,size,unknowns,read,first_build,build,step,bytes,iterations\n";
  for (const ScalingSeries& series : report.series)
    for (const ScalingPoint& point : series.points)
      if (point.completed)
        text +=
            fmt::format("\"{}\",{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.0f},{:g}\n", series.family.name,
                        series.family.unit, point.size, point.unknowns, point.read_seconds, point.first_build_seconds,
                        point.build_seconds, point.step_seconds, point.bytes, point.iterations);
  return text;
}

}  // namespace flexarm::bench
