#pragma once
/// Runs of MuJoCo: rigid mechanisms, and beams as they are usually replaced in robotics, by chains of rigid segments
/// with springs in their joints.

#include <functional>
#include <string>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::bench {

/// Both are plane motions.
///
/// SpinUp: a beam of 10 m, clamped in a hub that turns about z by a prescribed angle; EA = 2.8e7 N, EI = GJ = 1.4e4
/// N m^2, 1.2 kg/m, 6e-4 kg m. The angle is 6/15 (t^2/2 + (15/2pi)^2 (cos(2 pi t/15) - 1)) until 15 s, 6 t - 45 after.
///
/// DoublePendulum: two beams of 1 m, 1 kg/m, EI = GJ = 20 N m^2, rotary inertias 2e-4, 1e-4, 1e-4 kg m, hinged about
/// y, released at rest along x under gravity, 9.81 m/s^2 along -z.
enum class PeerProblem { SpinUp, DoublePendulum };

/// A run of another program.
struct PeerRun {
  std::string program, variant;  ///< "MuJoCo 2.2.2"; its integrator, and damping where it needs some
  int segments;                  ///< per beam; 0: all is rigid
  double step;                   ///< [s]
  double seconds;                ///< of the processor for its steps, in one thread [s]
  bool completed;                ///< false where the motion has blown up
  std::vector<Vector3> probe;    ///< the tip at the given times, as many as it came to [m]
};

/// Runs of MuJoCo with all its integrators, from 4 to 32 segments per beam and steps from 1e-2 s to 1e-4 s; empty where
/// flexarm was built without it. `times`: of the probe, ascending multiples of 1e-2 s. Calls advance_progress() after
/// each mesh, integrator and step. Not to be called by two threads at once: MuJoCo's callbacks are global.
///
/// A beam of n segments has n hinges of stiffness EI / l in the middles of its n parts of length l, and rigid bodies
/// between them: second order in l. Hinges rather than ball joints, since the motions are plane: three times fewer
/// unknowns. MuJoCo has no shear and no stretch here. The hub's angle is prescribed by an exact feed-forward torque on
/// a hub a million times heavier than the beam, and set anew in each step. There is no damping, unless a motion blows
/// up without: then MuJoCo's own, implicit joint damping is tried, h/2 of the stiffness, which is the least with which
/// a semi-implicit Euler step of length h is stable for whatever frequency. RK4 treats damping explicitly, which helps
/// nothing.
std::vector<PeerRun> mujoco_runs(PeerProblem problem, const std::vector<double>& times, bool quick,
                                 const std::function<void()>& advance_progress);

/// Runs of MuJoCo with all its integrators and steps from 2e-2 s to 1e-5 s of a scene that was read from a file of
/// rigid links, joints of one coordinate and nothing but gravity; of the first probe. All else as above; `times`:
/// multiples of 2e-2 s.
/// @throws std::runtime_error if MuJoCo does not understand the file.
std::vector<PeerRun> mujoco_runs_of(const scene::SceneDescription& scene, const std::vector<double>& times, bool quick);

}  // namespace flexarm::bench
