#include "flexarm/simulation/driven_ends.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

/// A driven end is reported if its inertia is less than this part of the inertia of all that the joint moves.
constexpr double kSmallPart = 1e-2;
/// Steps of models of this size are quick enough.
constexpr std::size_t kMostUnknowns = 500;
/// About how far an effort turns a joint to show its inertia, if all that the joint moves is rigid [rad].
constexpr double kSmallTurn = 1e-6;
/// Of Newton's method in this step.
constexpr double kTolerance = 1e-10;

/// Nodes that a joint moves: its slave, and all nodes connected to it by elements and further joints.
std::vector<bool> moved_nodes(const Model& model, const JointMap& joint) {
  std::vector<bool> moves(model.nodes.size(), false);
  moves[joint.slave] = true;
  for (bool grows = true; grows;) {
    grows = false;
    const auto add = [&](int node) {
      grows = grows || !moves[node];
      moves[node] = true;
    };
    for_each_element(model.beams, [&](const auto& element) {
      if (std::any_of(element.nodes.begin(), element.nodes.end(), [&](int node) { return moves[node]; }))
        std::for_each(element.nodes.begin(), element.nodes.end(), add);
    });
    for (const JointMap& other : model.joints)
      if (other.master >= 0 && moves[other.master]) add(other.slave);
  }
  return moves;
}

/// Inertia of all that the joint moves, about `axis` through the joint [kg m^2].
double moved_inertia(const Model& model, const JointMap& joint, const Vector3& axis) {
  const Vector3 origin = moved_origin(joint, model.nodes[joint.slave]);
  const std::vector<bool> moves = moved_nodes(model, joint);
  double sum = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (!moves[i]) continue;
    const NodalInertia& inertia = model.inertias[i];
    const Vector3 own = model.nodes[i].rotation.transpose() * axis;
    sum += inertia.total_mass * axis.cross(model.nodes[i].position - origin).squaredNorm() +
           own.dot((inertia.rotary + inertia.beam_rotary) * own);
  }
  return sum;
}

bool turns(const JointMap& joint) {
  return joint.kind == JointMapKind::Scalar && !joint.rotation.isZero(0);
}

/// Per node: whether it belongs to a beam that bends, or fixed joints connect it to such a node.
std::vector<bool> nodes_at_beams(const Model& model) {
  std::vector<bool> out(model.nodes.size(), false);
  for_each_element(model.beams, [&](const auto& element) {
    for (const int node : element.nodes) out[node] = true;
  });
  for (bool grows = true; grows;) {
    grows = false;
    for (const JointMap& joint : model.joints) {
      if (joint.kind != JointMapKind::Rigid || joint.master < 0 || out[joint.master] == out[joint.slave]) continue;
      out[joint.master] = out[joint.slave] = grows = true;
    }
  }
  return out;
}

/// Whether the scene drives the coordinate, or limits its effort, as scenes do whose joints are driven by commands.
/// Rigid robots have such limits, too: there only joints at a beam count.
bool is_driven(const Model& model, const Coordinate& coordinate, const std::vector<bool>& at_beam) {
  if (coordinate.motion >= 0 || coordinate.mimicked >= 0) return false;
  if (coordinate.effort >= 0) return true;
  if (coordinate.actuator >= 0) {
    const Actuator& actuator = model.actuators[coordinate.actuator];
    if (actuator.servo || actuator.drive.inertia > 0 || actuator.drive.gear) return true;
  }
  const JointMap& joint = model.joints[coordinate.joint];
  return coordinate.effort_limit > 0 && (at_beam[joint.slave] || (joint.master >= 0 && at_beam[joint.master]));
}

/// Inertia of all that a rotary joint moves, rotor included [kg m^2].
double whole_inertia(const Model& model, const Coordinate& coordinate) {
  const JointMap& joint = model.joints[coordinate.joint];
  Vector3 axis = joint.rotation.normalized();
  if (joint.master >= 0) axis = model.nodes[joint.master].rotation * axis;
  return moved_inertia(model, joint, axis) + armature(model, coordinate);
}

/// The scene at rest and without loads. A load that accelerates the bare end of a beam would bend it at once, so that
/// the end would seem softer.
scene::SceneDescription at_rest(scene::SceneDescription scene) {
  scene.servos.clear();
  scene.starts_in_equilibrium = false;
  scene.gravity.setZero();
  scene.efforts.clear();
  scene.loads.clear();
  scene.distributed_loads.clear();
  for (scene::InitialJoint& joint : scene.initial_joints) joint.velocity = 0;
  for (scene::JointDescription& joint : scene.joints) joint.friction = 0;
  return scene;
}

/// The effective inertia that an effort on a coordinate feels for `time`, by one step of that length [kg m^2]. NaN if
/// there is no such step.
double resistance(Simulation& simulation, std::size_t coordinate, double time) {
  simulation.reset();
  const double whole = whole_inertia(model_of(simulation), model_of(simulation).coordinates[coordinate]);
  const double effort = kSmallTurn * whole / (time * time);
  simulation.command_effort(coordinate, effort);
  if (!simulation.step().converged) return std::numeric_limits<double>::quiet_NaN();
  return time * effort / simulation.velocity(coordinate);
}

/// For each driven joint that rotates, the effective inertia that its drive feels for `time`, without servos [kg m^2].
/// Empty if the model is too large, or cannot make a step.
std::map<std::string, double> resistances(const Simulation& simulation, double time) {
  std::map<std::string, double> out;
  if (simulation.degrees_of_freedom() > kMostUnknowns) return out;
  const Model& model = model_of(simulation);
  const std::vector<bool> at_beam = nodes_at_beams(model);
  std::vector<std::size_t> driven;
  for (std::size_t i = 0; i < model.coordinates.size(); ++i)
    if (is_driven(model, model.coordinates[i], at_beam) && turns(model.joints[model.coordinates[i].joint]))
      driven.push_back(i);
  if (driven.empty()) return out;
  SimulationOptions options;
  options.scheme = "em";
  options.step = time;
  options.tolerance = kTolerance;
  try {
    Simulation resting(at_rest(simulation.scene()), options);
    for (const std::size_t i : driven) {
      const double found = resistance(resting, i, time);
      if (std::isfinite(found)) out[model.coordinates[i].name] = found;
    }
  } catch (const std::exception&) {  // a mechanism that cannot start at rest
  }
  return out;
}

}  // namespace

std::vector<DrivenEnd> driven_ends(const Simulation& simulation) {
  const Model& model = model_of(simulation);
  const std::map<std::string, double> within_step = resistances(simulation, simulation.step_size());
  std::vector<DrivenEnd> ends;
  for (const Coordinate& coordinate : model.coordinates) {
    const auto found = within_step.find(coordinate.name);
    if (found == within_step.end()) continue;
    const double whole = whole_inertia(model, coordinate);
    if (found->second < kSmallPart * whole)
      ends.push_back({coordinate.name, found->second, whole, 2 * found->second / simulation.step_size()});
  }
  return ends;
}

std::string warning_of_shaking_servos(const Simulation& simulation) {
  std::string told;
  for (const scene::ServoDescription& servo : simulation.scene().servos) {
    const double damping = servo.mode == ServoMode::Position   ? servo.kd
                           : servo.mode == ServoMode::Velocity ? servo.kp
                                                               : 0;  // N m s/rad
    if (damping == 0 || (servo.sample_time == 0 && servo.delay == 0)) continue;
    const auto& drives = simulation.scene().drives;
    const auto drive =
        std::find_if(drives.begin(), drives.end(), [&](const auto& one) { return one.coordinate == servo.coordinate; });
    if (drive != drives.end() && drive->stiffness) continue;  // the servo acts on the rotor, not on the beam's end
    const double held = std::max(servo.sample_time, simulation.step_size());
    const std::map<std::string, double> resists = resistances(simulation, held);
    const auto found = resists.find(servo.coordinate);
    // An inertia J alone shakes if damping * held > 2 J. The end of a beam without damping may shake even with a larger
    // inertia, since the samples miss the beam's own motion. A rotor with three times `needed` calmed all cases that
    // were tried.
    const double needed = damping * (held + 2 * servo.delay);
    if (found == resists.end() || found->second > needed) continue;
    const double gear = drive != drives.end() ? drive->gear.value_or(1) : 1,
                 rotor = (drive != drives.end() ? drive->rotor_inertia : 0) + 3 * needed / (gear * gear);
    told += fmt::format(
        "{} '{}' damps by {:.3g} N m s/rad, and acts for {:.3g} s on {:.2g} kg m^2 only: "
        "<drive joint=\"{}\" rotor_inertia=\"{:.2g}\"{}/>",
        told.empty() ? "" : ";", servo.coordinate, damping, held + servo.delay, found->second, servo.coordinate, rotor,
        drive != drives.end() ? " ..." : "");
  }
  return told.empty()
             ? ""
             : "sampled servos may shake the ends of beams that they act on, since these have too little inertia; "
               "sufficient would be:" +
                   told;
}

}  // namespace flexarm
