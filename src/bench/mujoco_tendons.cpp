#include "bench/mujoco.h"

#ifdef FLEXARM_HAS_MUJOCO

#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "bench/mujoco_motion.h"
#include "math/pi.h"

namespace flexarm::bench {
namespace {

// config/speed/tendon_rod.urdf
constexpr double kLength = 0.3, kBending = 0.01, kMass = 0.05, kPolar = 4e-6, kAcross = 2e-6, kDamping = 2e-3,
                 kDistance = 0.01;
constexpr int kTendons = 3, kPieces = 12;
/// With a larger angle between segments, a motion counts as blown up [rad].
constexpr double kLargestBend = kPi / 2;

double tension(int tendon, double t) {
  return 1.5 * (1 - std::cos(4 * t)) * (1 + std::cos(5 * t - 2 * tendon));
}

struct Variant {
  int segments;  ///< a multiple of kPieces
  const char* integrator;
  double step;
};

/// The sites of all tendons at one of their points, in a body in which the rod's line passes x.
std::string sites(int point, double x) {
  std::string text;
  for (int k = 0; k < kTendons; ++k) {
    const double angle = 2 * kPi * k / kTendons;  // counterclockwise about x, from y
    text += fmt::format("<site name=\"s{}_{}\" pos=\"{:.17g} {:.17g} {:.17g}\"/>", k, point, x,
                        kDistance * std::cos(angle), kDistance * std::sin(angle));
  }
  return text;
}

/// Rigid segments on ball joints in the middles of the rod's parts. The first half of the first part is clamped.
std::string mjcf(const Variant& variant) {
  const double part = kLength / variant.segments, stiffness = kBending / part;
  const int every = variant.segments / kPieces;
  std::string text = fmt::format(
      "<mujoco><compiler angle=\"radian\"/><option timestep=\"{:.17g}\" integrator=\"{}\" gravity=\"0 0 -9.81\">"
      "<flag constraint=\"disable\" contact=\"disable\"/></option><worldbody>{}",
      variant.step, variant.integrator, sites(0, 0));
  for (int i = 1; i <= variant.segments; ++i) {
    const double length = i == variant.segments ? 0.5 * part : part, mass = kMass * length;
    const double across = mass * length * length / 12 + kAcross * length;
    text += fmt::format(
        "<body pos=\"{:.17g} 0 0\"><joint type=\"ball\" stiffness=\"{:.17g}\" damping=\"{:.17g}\"/>"
        "<inertial pos=\"{:.17g} 0 0\" mass=\"{:.17g}\" diaginertia=\"{:.17g} {:.17g} {:.17g}\"/>",
        i == 1 ? 0.5 * part : part, stiffness, kDamping * stiffness, 0.5 * length, mass, kPolar * length, across,
        across);
    if (i % every == 0) text += sites(i / every, 0.5 * part);
  }
  for (int i = 0; i < variant.segments; ++i) text += "</body>";
  text += "</worldbody><tendon>";
  for (int k = 0; k < kTendons; ++k) {
    text += fmt::format("<spatial name=\"t{}\">", k);
    for (int point = 0; point <= kPieces; ++point) text += fmt::format("<site site=\"s{}_{}\"/>", k, point);
    text += "</spatial>";
  }
  text += "</tendon><actuator>";
  for (int k = 0; k < kTendons; ++k) text += fmt::format("<motor tendon=\"t{}\" gear=\"-1\"/>", k);
  return text + "</actuator></mujoco>";
}

class Chain {
 public:
  explicit Chain(const Variant& variant)
      : segments_(variant.segments), model_(mujoco_model_of_text(mjcf(variant))), data_(mujoco_data(model_.get())) {}

  void advance(long steps) {
    for (long i = 0; i < steps; ++i) mj_step(model_.get(), data_.get());
  }
  bool is_sound() const {
    if (has_warned(data_.get())) return false;
    for (int i = 0; i < segments_; ++i)
      if (!(2 * std::acos(std::min(1.0, std::abs(data_->qpos[4 * i]))) < kLargestBend)) return false;
    return true;
  }
  Vector3 tip() {
    mj_kinematics(model_.get(), data_.get());  // after a step, coordinates are new, but poses are not
    const int last = model_->nbody - 1;
    const mjtNum *origin = data_->xpos + 3 * last, *frame = data_->xmat + 9 * last;
    const double length = 0.5 * kLength / segments_;
    return {origin[0] + length * frame[0], origin[1] + length * frame[3], origin[2] + length * frame[6]};
  }

 private:
  int segments_;
  MujocoModel model_;
  MujocoData data_;
};

}  // namespace

std::vector<PeerRun> mujoco_tendon_runs(const std::vector<double>& times, bool quick,
                                        const std::function<void()>& advance_progress) {
  const MujocoCallbacks callbacks;
  mjcb_control = [](const mjModel*, mjData* data) {
    for (int k = 0; k < kTendons; ++k) data->ctrl[k] = tension(k, data->time);
  };
  const std::vector<int> meshes = quick ? std::vector<int>{12} : std::vector<int>{12, 24, 48};
  const std::vector<double> steps = quick ? std::vector<double>{1e-3} : std::vector<double>{4e-3, 2e-3, 1e-3, 5e-4};
  std::vector<PeerRun> runs;
  for (const int segments : meshes)
    for (const char* integrator : {"Euler", "implicit", "RK4"})
      for (const double step : steps) {
        PeerRun run{std::string("MuJoCo ") + mj_versionString(), integrator, segments, step, 0, false, {}};
        Chain chain({segments, integrator, step});
        runs.push_back(recorded(chain, std::move(run), times));
        advance_progress();
      }
  return runs;
}

}  // namespace flexarm::bench

#else

namespace flexarm::bench {

std::vector<PeerRun> mujoco_tendon_runs(const std::vector<double>&, bool, const std::function<void()>&) {
  return {};
}

}  // namespace flexarm::bench

#endif
