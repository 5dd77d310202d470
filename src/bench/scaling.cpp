#include "bench/scaling.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy/processor_time.h"
#include "bench/urdf.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::bench {
namespace {

/// Least duration of a batch of steps that is timed [s]; the fastest batch counts.
constexpr double kBatchSeconds = 0.01;
constexpr int kBatches = 5;
/// Steps before timing begins, since the first ones have no last increment to extrapolate.
constexpr int kStepsBefore = 2;
/// Number of times that a scene is read and built.
constexpr int kTries = 3;

const Vector3 kDown(0, 0, -9.81);

/// Bytes that malloc() has handed out.
double allocated_bytes() {
#if __GLIBC_PREREQ(2, 33)
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
#else  // counts up to 4 GB only
  const struct mallinfo info = mallinfo();
  return static_cast<double>(static_cast<unsigned>(info.uordblks)) +
         static_cast<double>(static_cast<unsigned>(info.hblkhd));
#endif
}

/// Time to make a value.
struct Making {
  double first = std::numeric_limits<double>::infinity(),
         best = first;  ///< time of the first try; shortest time of all tries [s]
};
template <class Value, class Make>
Making seconds_to_make(std::optional<Value>& value, const Make& make) {
  Making seconds;
  for (int i = 0; i < kTries; ++i) {
    value.reset();
    const double begin = processor_seconds();
    value.emplace(make());
    seconds.best = std::min(seconds.best, processor_seconds() - begin);
    if (i == 0) seconds.first = seconds.best;
  }
  return seconds;
}

/// The sizes 1, 3, 10, ... up to `largest`.
std::vector<int> half_decades(int first, int largest) {
  std::vector<int> sizes;
  for (int decade = 1; decade <= largest; decade *= 10)
    for (const int size : {decade, 3 * decade})
      if (size >= first && size <= largest) sizes.push_back(size);
  return sizes;
}

const std::string kSection =
    "<section ea=\"1e5\" ga2=\"5e4\" ga3=\"5e4\" gj=\"20\" ei2=\"20\" ei3=\"20\" mass=\"1\" j1=\"2e-4\" j2=\"1e-4\" "
    "j3=\"1e-4\"/>";

std::string scene(const std::string& links_and_joints, const std::string& simulation) {
  return urdf::scene(links_and_joints, "<integrator scheme=\"em\" step=\"1e-3\"/>\n" + simulation);
}

/// A cantilever with elements of 0.1 m that falls from the horizontal.
std::string cantilever(int elements, int order) {
  const Vector3 tip(0.1 * elements, 0, 0);
  return scene(urdf::joint("clamp", "fixed", "world", "beam") + urdf::beam("beam", tip, kSection, elements, "", order),
               urdf::gravity(kDown) + urdf::load("beam", tip, {0, 1, 0}));
}

/// A clamped beam of two-node elements, and a tendon over a point at the end of each. The points lie to and fro across
/// the beam, so that the tendon turns at each of them, and slips where there is friction: its rest length swings.
std::string tendon_along_a_beam(int elements, double friction) {
  const auto point = [](int i) { return Vector3(0.1 * i, i == 0 ? 0 : 0.01 * (i % 3), 0.05); };
  double length = 0;
  std::string guides = "<via link=\"world\" at=\"0 0 0.05\"/>";
  for (int i = 1; i <= elements; ++i) {
    length += (point(i) - point(i - 1)).norm();
    const bool rubs = friction > 0 && i < elements;
    guides += fmt::format("<via link=\"beam\" at=\"{}\"{}/>", urdf::triple(point(i)),
                          rubs ? fmt::format(" friction=\"{}\"", friction) : "");
  }
  const std::string tendon =
      fmt::format("<tendon name=\"tendon\" ea=\"2e4\" damping=\"5\" rest_length=\"{:.12g}-{:.12g}*(1-cos(3*t))\">",
                  0.999 * length, 2e-4 * elements);
  return scene(urdf::joint("clamp", "fixed", "world", "beam") +
                   urdf::beam("beam", {0.1 * elements, 0, 0}, kSection, elements, "", 1) + tendon + guides +
                   "</tendon>",
               urdf::gravity(kDown));
}

/// A trunk with an element of 1 m between branches; branches of 1 to 10 elements, every second one on a hinge.
std::string tree(int branches) {
  std::string body = urdf::joint("clamp", "fixed", "world", "trunk") +
                     urdf::beam("trunk", {static_cast<double>(branches), 0, 0}, kSection, branches);
  for (int i = 0; i < branches; ++i) {
    const int elements = 1 + i % 10;
    const std::string name = fmt::format("branch{}", i);
    const Vector3 at(i + 1, 0, 0);
    body += urdf::beam(name, {0, 0.1 * elements, 0}, kSection, elements) +
            (i % 2 == 0 ? urdf::joint("fork" + name, "fixed", "trunk", name, at)
                        : urdf::joint("fork" + name, "continuous", "trunk", name, at,
                                      urdf::axis({1, 0, 0}) + "<dynamics damping=\"0.1\"/>"));
  }
  return scene(body, urdf::gravity(kDown));
}

/// Rods of 0.1 m that begin at the world's origin, with revolute joints about y and x in turn. Each joint has an
/// initial angle and a motor.
std::string rigid_chain(int links) {
  std::string body, simulation, parent = "world";
  for (int i = 0; i < links; ++i) {
    const std::string name = fmt::format("link{}", i), hinge = fmt::format("joint{}", i);
    body += urdf::joint(hinge, "revolute", parent, name, i == 0 ? Vector3(0, 0, 0) : Vector3(0, 0, -0.1),
                        urdf::axis(i % 2 == 0 ? Vector3(0, 1, 0) : Vector3(1, 0, 0)) +
                            "<limit lower=\"-3\" upper=\"3\" effort=\"10\" velocity=\"10\"/>"
                            "<dynamics damping=\"0.01\"/>") +
            urdf::body(name, 0.1, Vector3(1e-4, 1e-4, 1e-5), {0, 0, -0.05});
    simulation += urdf::initial(hinge, i % 4 < 2 ? 0.01 : -0.01, 0) + urdf::effort(hinge, "0.1*sin(30*t)");
    parent = name;
  }
  return scene(body, simulation);
}

}  // namespace

std::vector<ScalingFamily> scaling_families(bool quick) {
  const auto sizes = [&](int largest) { return half_decades(1, quick ? std::min(largest, 10) : largest); };
  return {{"cantilever, order 1", "elements", "One beam under gravity, elements of two nodes and 0.1 m.", sizes(100000),
           [](int n) { return cantilever(n, 1); }},
          {"cantilever, order 2", "elements", "The same, elements of three nodes.", sizes(100000),
           [](int n) { return cantilever(n, 2); }},
          {"tree", "branches",
           "A trunk with an element from branch to branch, and branches of 1 to 10 elements (5.5 in the mean), every "
           "other one on a hinge; three-node elements.",
           sizes(1000), tree},
          {"rigid chain", "links", "Rigid links hanging on revolute joints, each with a damper, stops and a motor.",
           sizes(1000), rigid_chain},
          {"tendon", "points", "A cantilever of two-node elements with an elastic tendon over a point of each.",
           sizes(1000), [](int n) { return tendon_along_a_beam(n, 0); }},
          {"tendon with friction", "points", "The same, with friction at all points but the ends.", sizes(1000),
           [](int n) { return tendon_along_a_beam(n, 0.1); }}};
}

ScalingPoint measure_scaling_point(const ScalingFamily& family, int size) {
  ScalingPoint point;
  point.size = size;
  const std::string text = family.urdf(size);
  std::optional<scene::SceneDescription> scene;
  const auto read = [&] {
    scene::ReadResult result = scene::read_scene_text(text, family.name);
    if (!result.scene) throw std::runtime_error(scene::to_text(result.diagnostics));
    return std::move(*result.scene);
  };
  point.read_seconds = seconds_to_make(scene, read).best;
  const double before = allocated_bytes();
  SimulationOptions options;
  options.reuse_factorisation = false;  // so that all iterations cost the same
  std::optional<Simulation> simulation;
  malloc_trim(0);  // returns free memory to the system, so that the first try must request it
  const Making building = seconds_to_make(simulation, [&] { return Simulation(*scene, options); });
  point.first_build_seconds = building.first;
  point.build_seconds = building.best;
  point.unknowns = simulation->degrees_of_freedom();
  for (int n = 0; n < kStepsBefore; ++n)
    if (!simulation->step().converged) return point;
  int steps = 0;
  point.step_seconds = std::numeric_limits<double>::infinity();
  for (int batch = 0; batch < kBatches; ++batch) {
    const double begin = processor_seconds();
    const int before_batch = steps;
    double seconds = 0;
    while (seconds < kBatchSeconds) {
      const StepResult result = simulation->step();
      if (!result.converged) return point;
      point.iterations += result.iterations;
      ++steps;
      seconds = processor_seconds() - begin;
    }
    point.step_seconds = std::min(point.step_seconds, seconds / (steps - before_batch));
  }
  point.iterations /= steps;
  point.bytes = allocated_bytes() - before;
  point.completed = true;
  return point;
}

ScalingReport measure_scaling(bool quick, const std::function<void(double)>& progress) {
  ScalingReport report;
  report.quick = quick;
  const std::vector<ScalingFamily> families = scaling_families(quick);
  double done = 0, whole = 0;  // in units of the cost of size 1
  for (const ScalingFamily& family : families)
    for (const int size : family.sizes) whole += size;
  for (const ScalingFamily& family : families) {
    ScalingSeries series{family, {}};
    for (const int size : family.sizes) {
      series.points.push_back(measure_scaling_point(family, size));
      progress((done += size) / whole);
    }
    report.series.push_back(std::move(series));
  }
  return report;
}

double log_slope(const std::vector<double>& x, const std::vector<double>& y, double part) {
  const double from = part * *std::max_element(x.begin(), x.end());
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < from * (1 - 1e-12)) continue;
    const double u = std::log(x[i]), v = std::log(y[i]);
    n += 1, sx += u, sy += v, sxx += u * u, sxy += u * v;
  }
  if (n < 2) return std::numeric_limits<double>::quiet_NaN();
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace flexarm::bench
