// Runs rigid mechanisms in MuJoCo, which reads the same file.
#include "bench/mujoco.h"

#ifndef FLEXARM_HAS_MUJOCO

namespace flexarm::bench {

std::vector<PeerRun> mujoco_runs_of(const scene::SceneDescription&, const std::vector<double>&, bool) {
  return {};
}

}  // namespace flexarm::bench

#else

#include <utility>

#include "bench/mujoco_motion.h"

namespace flexarm::bench {
namespace {

/// The motion of the first probe, in a scene of rigid links and joints of one coordinate.
class Mechanism {
 public:
  Mechanism(const scene::SceneDescription& scene, mjtIntegrator integrator, double step)
      : model_(mujoco_model(scene.file)), data_(mujoco_data(model_.get())), at_(scene.probes.at(0).at) {
    model_->opt.integrator = integrator;
    model_->opt.timestep = step;
    model_->opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_CONTACT;
    for (int k = 0; k < 3; ++k) model_->opt.gravity[k] = scene.gravity[k];
    for (const scene::InitialJoint& initial : scene.initial_joints) {
      const int joint = index_of(mjOBJ_JOINT, initial.coordinate);
      data_->qpos[model_->jnt_qposadr[joint]] = initial.position;
      data_->qvel[model_->jnt_dofadr[joint]] = initial.velocity;
    }
    link_ = index_of(mjOBJ_BODY, scene.probes[0].link);
  }

  void advance(long steps) {
    for (long i = 0; i < steps; ++i) mj_step(model_.get(), data_.get());
  }

  bool is_sound() const { return !has_warned(data_.get()); }

  Vector3 tip() {
    mj_kinematics(model_.get(),
                  data_.get());  // after a step, coordinates are new, but poses are those of its beginning
    const Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor> > rotation(data_->xmat + 9 * link_);
    return Eigen::Map<const Vector3>(data_->xpos + 3 * link_) + rotation * at_;
  }

 private:
  int index_of(mjtObj kind, const std::string& name) const {
    const int index = mj_name2id(model_.get(), kind, name.c_str());
    if (index < 0) throw std::runtime_error("MuJoCo: expected '" + name + "'");
    return index;
  }

  MujocoModel model_;
  MujocoData data_;
  Vector3 at_;
  int link_ = 0;
};

}  // namespace

std::vector<PeerRun> mujoco_runs_of(const scene::SceneDescription& scene, const std::vector<double>& times,
                                    bool quick) {
  const MujocoCallbacks callbacks;
  const std::pair<mjtIntegrator, const char*> integrators[] = {
      {mjINT_EULER, "Euler"}, {mjINT_IMPLICIT, "implicit"}, {mjINT_RK4, "RK4"}};
  const std::vector<double> steps =
      quick ? std::vector<double>{1e-2, 1e-3}
            : std::vector<double>{2e-2, 1e-2, 5e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 2e-5, 1e-5};
  std::vector<PeerRun> runs;
  for (const auto& [integrator, name] : integrators)
    for (const double step : steps) {
      Mechanism mechanism(scene, integrator, step);
      runs.push_back(
          recorded(mechanism, {std::string("MuJoCo ") + mj_versionString(), name, 0, step, 0, false, {}}, times));
    }
  return runs;
}

}  // namespace flexarm::bench

#endif
