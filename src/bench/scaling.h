#pragma once
/// How time and memory grow with the size of a mechanism.

#include <functional>
#include <string>
#include <vector>

namespace flexarm::bench {

/// A family of scenes of any size.
struct ScalingFamily {
  std::string name, unit;                ///< "tree", "branches"
  std::string description;               ///< a sentence
  std::vector<int> sizes;                ///< ascending
  std::function<std::string(int)> urdf;  ///< scene of a size
};

struct ScalingPoint {
  int size = 0;
  std::size_t unknowns = 0;
  double read_seconds = 0;         ///< of the processor: from text to scene description
  double first_build_seconds = 0;  ///< from there to a simulation that can step, with memory that the system hands out
  double build_seconds = 0;        ///< with memory that the process has; like reading, the shortest of some tries
  double step_seconds = 0;         ///< per step, by full Newton
  double bytes = 0;                ///< held by the simulation after some steps
  double iterations = 0;           ///< of Newton's method per step
  bool completed = false;          ///< all of its steps converged
};

struct ScalingSeries {
  ScalingFamily family;
  std::vector<ScalingPoint> points;
};

struct ScalingReport {
  std::vector<ScalingSeries> series;
  bool quick = false;
};

/// A cantilever of one beam by elements of the first and of the second order, a tree of short flexible branches, and a
/// chain of rigid links with revolute joints.
std::vector<ScalingFamily> scaling_families(bool quick);

/// @throws std::runtime_error if the scene cannot be read.
ScalingPoint measure_scaling_point(const ScalingFamily& family, int size);

/// `progress(part)` is called with the part done, in [0, 1]. `quick`: small sizes, to see that it works.
ScalingReport measure_scaling(bool quick, const std::function<void(double)>& progress);

/// Slope of log y over log x by least squares, over the points with x >= part * the largest x: fixed costs hide in the
/// small ones. NaN if fewer than two points are left.
double log_slope(const std::vector<double>& x, const std::vector<double>& y, double part = 0);

/// The tables. `picture`: file name of the picture next to them; empty if there is none.
std::string to_markdown(const ScalingReport& report, const std::string& picture);
/// Columns family, unit, size, unknowns, read, first_build, build, step, bytes, iterations.
std::string scaling_to_csv(const ScalingReport& report);

}  // namespace flexarm::bench
