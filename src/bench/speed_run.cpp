// Makes one run of a problem.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy/processor_time.h"
#include "bench/speed.h"
#include "cli/effort_schedule.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/schemes/integrator_description.h"

namespace flexarm::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// The integer whole / part.
int quotient(double whole, double part, const char* what) {
  const double ratio = whole / part;
  const int rounded = static_cast<int>(std::lround(ratio));
  if (rounded < 1 || std::abs(ratio - rounded) > 1e-9 * ratio)
    throw std::invalid_argument(fmt::format("{}: {:g} s is no multiple of {:g} s", what, whole, part));
  return rounded;
}

/// Distributes `elements` over all beams; each beam's number is multiplied by the same factor.
void refine(scene::SceneDescription& scene, int elements, int order) {
  int total = 0;
  for (const scene::LinkDescription& link : scene.links)
    if (link.beam) total += link.beam->elements.value_or(0);
  for (scene::LinkDescription& link : scene.links) {
    if (!link.beam) continue;
    if (order > 0) link.beam->order = order;
    if (elements == 0) continue;
    const int share = link.beam->elements.value_or(0) * elements;
    if (total == 0 || share == 0 || share % total != 0)
      throw std::invalid_argument(
          fmt::format("{}: {} elements cannot be shared among the beams as in the scene", scene.file, elements));
    link.beam->elements = share / total;
  }
}

scene::SceneDescription scene_of(const std::string& folder, const SpeedProblem& problem,
                                 const Discretisation& discretisation) {
  const std::string path = folder + "/" + problem.scene;
  scene::ReadResult read = scene::read_scene_file(path);
  if (!read.scene)
    throw std::runtime_error(read.diagnostics.empty() ? "cannot read '" + path + "'" : read.diagnostics[0].text());
  scene::SceneDescription scene = std::move(*read.scene);
  refine(scene, discretisation.elements, discretisation.order);
  scene.integrator = with_scheme(scene.integrator, discretisation.scheme);
  scene.integrator.step = discretisation.step;
  scene.integrator.tolerance = discretisation.tolerance;
  scene.integrator.may_be_planar = discretisation.may_be_planar;
  return scene;
}

std::size_t probe_of(const scene::SceneDescription& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.probes.size(); ++i)
    if (scene.probes[i].name == name) return i;
  throw std::runtime_error(fmt::format("{}: expected a probe '{}'", scene.file, name));
}

/// The index of the link with that name; empty name: the world.
std::optional<std::size_t> frame_of(const Simulation& simulation, const std::string& name) {
  if (name.empty()) return std::nullopt;
  const std::vector<std::string>& links = simulation.link_names();
  const auto found = std::find(links.begin(), links.end(), name);
  if (found == links.end()) throw std::runtime_error(fmt::format("expected a link '{}'", name));
  return found - links.begin();
}

}  // namespace

Vector3 in_frame(const Pose& frame, const Vector3& point) {
  return frame.orientation.conjugate() * (point - frame.position);
}

std::string Discretisation::mesh() const {
  return elements > 0 ? fmt::format("{} x {}", elements, order) : "–";
}

SpeedRun run_speed(const std::string& folder, const SpeedProblem& problem, const Discretisation& discretisation,
                   bool reuse_factorisation) {
  scene::SceneDescription scene = scene_of(folder, problem, discretisation);
  const std::size_t probe = probe_of(scene, problem.probe);
  const int stride = quotient(problem.interval, discretisation.step, "interval");
  const int intervals = quotient(problem.until, problem.interval, "end");
  const std::vector<cli::EffortPulse> pulses = problem.commands.empty()
                                                   ? std::vector<cli::EffortPulse>()
                                                   : cli::read_effort_schedule(folder + "/" + problem.commands).pulses;
  SimulationOptions options;
  options.reuse_factorisation = reuse_factorisation;
  SpeedRun out;
  const double building = processor_seconds();
  Simulation simulation(std::move(scene), options);
  out.build_seconds = processor_seconds() - building;
  const cli::EffortPlayer player(pulses, simulation);
  out.trajectory.reserve(intervals + 1);
  const std::optional<std::size_t> frame = frame_of(simulation, problem.frame);
  const auto record = [&] {
    const Vector3 position = simulation.probe(probe).pose.position;
    if (frame) out.frames.push_back(simulation.link_pose(*frame));
    out.trajectory.push_back(frame ? in_frame(out.frames.back(), position) : position);
  };
  record();

  const double processor = processor_seconds();
  const Clock::time_point start = Clock::now();
  for (int n = 1; n <= intervals * stride && !out.failure; ++n) {
    player.command(simulation);
    const StepResult result = simulation.step();
    ++out.steps;
    out.iterations += result.iterations;
    out.factorisations += result.factorisations;
    out.halvings += result.halvings;
    if (!result.converged) out.failure = Failure{simulation.time(), result.reason};
    if (n % stride == 0) record();
  }
  out.seconds = processor_seconds() - processor;
  out.wall_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return out;
}

}  // namespace flexarm::bench
