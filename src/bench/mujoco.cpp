#include "bench/mujoco.h"

#ifndef FLEXARM_HAS_MUJOCO

namespace flexarm::bench {

std::vector<PeerRun> mujoco_runs(PeerProblem, const std::vector<double>&, bool, const std::function<void()>&) {
  return {};
}

}  // namespace flexarm::bench

#else

#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "bench/mujoco_motion.h"
#include "math/pi.h"

namespace flexarm::bench {
namespace {

/// Inertia of the hub, relative to the beam's inertia about it.
constexpr double kHubRatio = 1e6;
/// With a larger angle between segments, a motion counts as blown up [rad].
constexpr double kLargestBend = kPi / 2;

struct PlaneProblem {
  int beams;
  double length;                          ///< [m]
  double mass;                            ///< [kg/m]
  double polar_inertia, bending_inertia;  ///< [kg m]
  double bending;                         ///< EI [N m^2]
  const char *axis, *gravity;             ///< of all hinges, and of the world; MJCF
  bool is_driven;                         ///< the first hinge is the hub
};

PlaneProblem plane_problem(PeerProblem problem) {
  if (problem == PeerProblem::SpinUp) return {1, 10, 1.2, 1.2e-3, 6e-4, 1.4e4, "0 0 1", "0 0 0", true};
  return {2, 1, 1, 2e-4, 1e-4, 20, "0 1 0", "0 0 -9.81", false};
}

/// Inertia of the hub about its axis [kg m^2].
double hub_inertia(const PlaneProblem& problem) {
  return kHubRatio * problem.mass * std::pow(problem.length, 3) / 3;
}

double hub_angle(double t) {
  if (t >= 15) return 6 * t - 45;
  const double w = 2 * kPi / 15;
  return 0.4 * (0.5 * t * t + (std::cos(w * t) - 1) / (w * w));
}
double hub_speed(double t) {
  const double w = 2 * kPi / 15;
  return t >= 15 ? 6 : 0.4 * (t - std::sin(w * t) / w);
}
double hub_acceleration(double t) {
  return t >= 15 ? 0 : 0.4 * (1 - std::cos(2 * kPi * t / 15));
}

struct Variant {
  int segments;
  const char* integrator;
  double step;
  double damping;  ///< damping divided by stiffness [s]
};

/// MJCF of a rigid segment that begins at a hinge, without the end tag.
std::string body(const PlaneProblem& problem, double at, double length, const std::string& hinge) {
  const double mass = problem.mass * length;
  const double across = mass * length * length / 12 + problem.bending_inertia * length;
  return fmt::format(
      "<body pos=\"{:.17g} 0 0\"><joint type=\"hinge\" axis=\"{}\" {}/>"
      "<inertial pos=\"{:.17g} 0 0\" mass=\"{:.17g}\" diaginertia=\"{:.17g} {:.17g} {:.17g}\"/>",
      at, problem.axis, hinge, 0.5 * length, mass, problem.polar_inertia * length, across, across);
}

std::string mjcf(const PlaneProblem& problem, const Variant& variant) {
  const double part = problem.length / variant.segments, stiffness = problem.bending / part;
  std::string text = fmt::format(
      "<mujoco><compiler angle=\"radian\"/><option timestep=\"{:.17g}\" integrator=\"{}\" gravity=\"{}\">"
      "<flag constraint=\"disable\" contact=\"disable\"/></option><worldbody>",
      variant.step, variant.integrator, problem.gravity);
  const std::string spring =
      fmt::format("stiffness=\"{:.17g}\" damping=\"{:.17g}\"", stiffness, variant.damping * stiffness);
  const std::string root = problem.is_driven ? fmt::format("armature=\"{:.17g}\"", hub_inertia(problem)) : "";
  double at = 0;
  for (int beam = 0; beam < problem.beams; ++beam)
    for (int i = 0; i <= variant.segments; ++i) {
      const double length = i == 0 || i == variant.segments ? 0.5 * part : part;
      text += body(problem, at, length, i == 0 ? root : spring);
      at = length;
    }
  for (int i = 0; i < problem.beams * (variant.segments + 1); ++i) text += "</body>";
  return text + "</worldbody></mujoco>";
}

void drive_hub() {
  mjcb_control = [](const mjModel* model, mjData* data) {
    data->qfrc_applied[0] = model->dof_armature[0] * hub_acceleration(data->time);
  };
}

class Chain {
 public:
  Chain(const PlaneProblem& problem, const Variant& variant)
      : problem_(problem),
        segments_(variant.segments),
        model_(mujoco_model_of_text(mjcf(problem, variant))),
        data_(mujoco_data(model_.get())) {}

  void advance(long steps) {
    for (long i = 0; i < steps; ++i) {
      if (problem_.is_driven) {
        data_->qpos[0] = hub_angle(data_->time);
        data_->qvel[0] = hub_speed(data_->time);
      }
      mj_step(model_.get(), data_.get());
    }
  }

  bool is_sound() const {
    if (has_warned(data_.get())) return false;
    for (int i = 0; i < model_->nq; ++i)
      if (i % (segments_ + 1) != 0 && !(std::abs(data_->qpos[i]) < kLargestBend)) return false;
    return true;
  }

  Vector3 tip() {
    if (problem_.is_driven) data_->qpos[0] = hub_angle(data_->time);
    mj_kinematics(model_.get(),
                  data_.get());  // after a step, coordinates are new, but poses are those of its beginning
    const int last = model_->nbody - 1;
    const mjtNum *origin = data_->xpos + 3 * last, *frame = data_->xmat + 9 * last;
    const double length = 0.5 * problem_.length / segments_;
    return {origin[0] + length * frame[0], origin[1] + length * frame[3], origin[2] + length * frame[6]};
  }

 private:
  const PlaneProblem& problem_;
  int segments_;
  MujocoModel model_;
  MujocoData data_;
};

PeerRun run(const PlaneProblem& problem, const Variant& variant, const std::vector<double>& times) {
  PeerRun out{
      std::string("MuJoCo ") + mj_versionString(), variant.integrator, variant.segments, variant.step, 0, false, {}};
  if (variant.damping > 0) out.variant += ", damping h/2 EI/l";
  Chain chain(problem, variant);
  return recorded(chain, std::move(out), times);
}

}  // namespace

std::vector<PeerRun> mujoco_runs(PeerProblem problem, const std::vector<double>& times, bool quick,
                                 const std::function<void()>& advance_progress) {
  const PlaneProblem plane = plane_problem(problem);
  const MujocoCallbacks callbacks;
  if (plane.is_driven) drive_hub();
  const std::vector<int> meshes = quick ? std::vector<int>{4} : std::vector<int>{4, 8, 16, 32};
  const std::vector<double> steps =
      quick ? std::vector<double>{1e-2, 1e-3} : std::vector<double>{1e-2, 2e-3, 5e-4, 1e-4};
  std::vector<PeerRun> runs;
  for (const int segments : meshes)
    for (const char* integrator : {"Euler", "implicit", "RK4"})
      for (const double step : steps) {
        runs.push_back(run(plane, {segments, integrator, step, 0}, times));
        if (!runs.back().completed && std::strcmp(integrator, "RK4") != 0)
          runs.push_back(run(plane, {segments, integrator, step, 0.5 * step}, times));
        advance_progress();
      }
  return runs;
}

}  // namespace flexarm::bench

#endif
