#pragma once
/// Runs of MuJoCo, for comparison: rigid mechanisms, and beams that are replaced, as usual in robotics, by chains of
/// rigid segments with springs in their joints.

#include <functional>
#include <string>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::bench {

/// Two plane motions:
///
/// SpinUp: a beam of 10 m, clamped in a hub that turns about z by a prescribed angle; EA = 2.8e7 N, EI = GJ = 1.4e4
/// N m^2, 1.2 kg/m, rotary inertia 6e-4 kg m. The angle is 6/15 (t^2/2 + (15/2pi)^2 (cos(2 pi t/15) - 1)) until 15 s,
/// then 6 t - 45.
///
/// DoublePendulum: two beams of 1 m, 1 kg/m, EI = GJ = 20 N m^2, rotary inertias 2e-4, 1e-4, 1e-4 kg m, hinged about y.
/// They are released at rest along x under gravity, 9.81 m/s^2 along -z.
enum class PeerProblem { SpinUp, DoublePendulum };

/// A run of another program.
struct PeerRun {
  std::string program, variant;  ///< "MuJoCo 2.2.2"; its integrator, and damping if it needs some
  int segments;                  ///< per beam; 0: everything is rigid
  double step;                   ///< [s]
  double seconds;                ///< processor time of the steps, in one thread [s]
  bool completed;                ///< false if the motion has blown up
  std::vector<Vector3> probe;    ///< position of the tip at the given times, as far as the run came [m]
};

/// Runs MuJoCo with all its integrators, 4 to 32 segments per beam, and steps from 1e-2 s to 1e-4 s. Returns nothing if
/// flexarm was built without MuJoCo. `times`: when the probe is recorded, ascending multiples of 1e-2 s. Calls
/// advance_progress() after each run. Not thread-safe, since MuJoCo's callbacks are global.
///
/// A beam with n segments has n hinges of stiffness EI / l in the middles of its n parts of length l, and rigid bodies
/// between the hinges. This is of second order in l. The joints are hinges rather than ball joints, since the motions
/// are plane; so there are three times fewer unknowns. This model has no shear and no stretch. The hub's angle is
/// prescribed by an exact feed-forward torque on a hub a million times heavier than the beam, and is also set in each
/// step. There is no damping unless the motion blows up without it. In that case MuJoCo's own implicit joint damping is
/// tried, h/2 times the stiffness. This is the smallest damping with which a semi-implicit Euler step of length h is
/// stable at any frequency. RK4 treats damping explicitly, so damping does not help it.
std::vector<PeerRun> mujoco_runs(PeerProblem problem, const std::vector<double>& times, bool quick,
                                 const std::function<void()>& advance_progress);

/// The same for the rod with three tendons of config/speed/tendon_rod.urdf: 12 to 48 rigid segments on ball joints,
/// with spatial tendons through sites, and steps from 4e-3 s to 5e-4 s.
std::vector<PeerRun> mujoco_tendon_runs(const std::vector<double>& times, bool quick,
                                        const std::function<void()>& advance_progress);

/// Runs MuJoCo with all its integrators, and steps from 2e-2 s to 1e-5 s. The scene must come from a file with rigid
/// links, joints of one coordinate, and gravity as the only load. The first probe is recorded. `times`: multiples of
/// 2e-2 s. The rest is as above.
/// @throws std::runtime_error if MuJoCo cannot read the file
std::vector<PeerRun> mujoco_runs_of(const scene::SceneDescription& scene, const std::vector<double>& times, bool quick);

}  // namespace flexarm::bench
