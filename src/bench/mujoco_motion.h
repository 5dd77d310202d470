#pragma once
/// Code that all runs of MuJoCo share; only used if flexarm is built with MuJoCo.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "accuracy/processor_time.h"
#include "bench/mujoco.h"

namespace flexarm::bench {

struct MujocoDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using MujocoModel = std::unique_ptr<mjModel, MujocoDeleter>;
using MujocoData = std::unique_ptr<mjData, MujocoDeleter>;

/// @throws std::runtime_error if the file, on disk or in memory, is not a model
inline MujocoModel mujoco_model(const std::string& file, const mjVFS* memory = nullptr) {
  char error[1000] = "";
  MujocoModel model(mj_loadXML(file.c_str(), memory, error, sizeof error));
  if (!model) throw std::runtime_error(std::string("MuJoCo: ") + error);
  return model;
}

inline MujocoModel mujoco_model_of_text(const std::string& text) {
  const auto files = std::make_unique<mjVFS>();  // on the heap, since it has megabytes
  mj_defaultVFS(files.get());
  const int place = mj_makeEmptyFileVFS(files.get(), "text.xml", static_cast<int>(text.size()));
  if (place < 0) throw std::runtime_error("MuJoCo: no file in memory");
  std::memcpy(files->filedata[place], text.data(), text.size());
  MujocoModel model = mujoco_model("text.xml", files.get());
  mj_deleteVFS(files.get());
  return model;
}

inline MujocoData mujoco_data(const mjModel* model) {
  MujocoData data(mj_makeData(model));
  if (!data) throw std::runtime_error("MuJoCo: out of memory");
  return data;
}

/// Restores MuJoCo's global callbacks after runs. Meanwhile MuJoCo writes no log file to the working folder.
class MujocoCallbacks {
 public:
  MujocoCallbacks() : control_(mjcb_control), warning_(mju_user_warning) {
    mju_user_warning = [](const char*) {};
  }
  ~MujocoCallbacks() { mjcb_control = control_, mju_user_warning = warning_; }
  MujocoCallbacks(const MujocoCallbacks&) = delete;
  MujocoCallbacks& operator=(const MujocoCallbacks&) = delete;

 private:
  mjfGeneric control_;
  void (*warning_)(const char*);
};

/// Whether a number was not finite. MuJoCo then restarts from the initial state, and counts a warning.
inline bool has_warned(const mjData* data) {
  const auto warned = [&](int kind) { return data->warning[kind].number > 0; };
  return warned(mjWARN_BADQPOS) || warned(mjWARN_BADQVEL) || warned(mjWARN_BADQACC);
}

/// Advances `motion`, which has advance(steps), is_sound() and tip(), and records its tip at the times. The other
/// fields of `run` must already be set.
template <class Motion>
PeerRun recorded(Motion& motion, PeerRun run, const std::vector<double>& times) {
  constexpr double kCheckInterval = 1e-2;  // simulated time between checks of the motion [s]
  const long stride = std::max(1L, std::lround(kCheckInterval / run.step));
  long done = 0;
  for (const double time : times) {
    for (const long goal = std::lround(time / run.step); done < goal;) {
      const long steps = std::min(stride, goal - done);
      const double begin = processor_seconds();
      motion.advance(steps);
      run.seconds += processor_seconds() - begin;
      done += steps;
      if (!motion.is_sound()) return run;
    }
    run.probe.push_back(motion.tip());
  }
  run.completed = true;
  return run;
}

}  // namespace flexarm::bench
