#pragma once
/// Measures how time and memory grow with the size of a mechanism.

#include <functional>
#include <string>
#include <vector>

namespace flexarm::bench {

/// A family of scenes that can have any size.
struct ScalingFamily {
  std::string name, unit;                ///< "tree", "branches"
  std::string description;               ///< one sentence
  std::vector<int> sizes;                ///< ascending
  std::function<std::string(int)> urdf;  ///< makes the scene of a given size
};

struct ScalingPoint {
  int size = 0;
  std::size_t unknowns = 0;
  double read_seconds = 0;  ///< processor time from text to scene description
  double first_build_seconds =
      0;  ///< from there to a simulation that can step, with memory that must first be requested from the system
  double build_seconds =
      0;  ///< the same with memory that the process already has; like read_seconds, the shortest of several tries
  double step_seconds = 0;  ///< per step, with full Newton iterations
  double bytes = 0;         ///< memory of the simulation after some steps
  double iterations = 0;    ///< of Newton's method per step
  bool completed = false;   ///< whether all steps converged
};

struct ScalingSeries {
  ScalingFamily family;
  std::vector<ScalingPoint> points;
};

struct ScalingReport {
  std::vector<ScalingSeries> series;
  bool quick = false;
};

/// Six families: a cantilever of elements of first and of second order, a tree of short flexible branches, a chain of
/// rigid links with revolute joints, and a cantilever with a tendon along it, without and with friction.
std::vector<ScalingFamily> scaling_families(bool quick);

/// @throws std::runtime_error if the scene cannot be read.
ScalingPoint measure_scaling_point(const ScalingFamily& family, int size);

/// `progress(part)` is called with the completed fraction, in [0, 1]. `quick`: small sizes, as a test of the command.
ScalingReport measure_scaling(bool quick, const std::function<void(double)>& progress);

/// Least-squares slope of log y over log x, for points with x >= part * (largest x). Small sizes are left out since
/// fixed costs dominate there. NaN if fewer than two points remain.
double log_slope(const std::vector<double>& x, const std::vector<double>& y, double part = 0);

/// The tables. `picture`: file name of the plot in the same folder; empty: none.
std::string to_markdown(const ScalingReport& report, const std::string& picture);
/// A CSV table with the columns family, unit, size, unknowns, read, first_build, build, step, bytes, iterations.
std::string scaling_to_csv(const ScalingReport& report);

}  // namespace flexarm::bench
