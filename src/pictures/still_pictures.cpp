#include "pictures/still_pictures.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "math/pi.h"
#include "simulation/inside.h"

namespace flexarm::pictures {
namespace {

constexpr double kPeriod = 2;          ///< of a swing in the page [s]
constexpr int kInstants = 48;          ///< of a period
constexpr double kLargestWay = 0.1;    ///< of a node, per radius of the scene
constexpr double kLargestAngle = 0.3;  ///< of a node [rad]

/// The factor of a mode's shape with which it is seen well and still looks like a small motion.
double amplitude(const Mode& mode, double radius) {
  double way = 0, angle = 0;
  for (const ComplexVector6& motion : mode.node_motion) {
    way = std::max(way, motion.head<3>().norm());
    angle = std::max(angle, motion.tail<3>().norm());
  }
  double out = std::numeric_limits<double>::infinity();
  if (way > 0) out = std::min(out, kLargestWay * radius / way);
  if (angle > 0) out = std::min(out, kLargestAngle / angle);
  return std::isfinite(out) ? out : 0;
}

/// Moves the nodes of a state by a mode. `factor`: complex amplitude.
void move_nodes(const Mode& mode, const std::complex<double>& factor, State& state) {
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    const Vector6 motion = (factor * mode.node_motion[i]).real();
    NodeState& node = state.nodes[i];
    node.position += motion.head<3>();
    const double angle = motion.tail<3>().norm();
    if (angle > 0) node.orientation = Quaternion(Eigen::AngleAxisd(angle, motion.tail<3>() / angle)) * node.orientation;
  }
}

}  // namespace

EncodedRun record_modes(const Simulation& simulation, const std::vector<NamedMode>& modes, const std::string& title) {
  // Results other than positions would be those of a motion with this velocity.
  Recording recording(simulation, {title, 60, {"time"}, false});
  Simulation moved = simulation.copy();
  State rest = state_of(simulation);
  rest.time = 0;
  const auto keep = [&](const State& state) {
    show(state, moved);
    recording.keep(moved, {});
  };
  keep(rest);
  recording.keep_still(0);
  const double radius = recording.picture().extent.radius;
  for (const auto& [name, mode] : modes) {
    const std::size_t first = recording.size();
    for (int k = 0; k <= kInstants; ++k) {
      State state = rest;
      const double part = static_cast<double>(k) / kInstants;
      state.time = kPeriod * (static_cast<double>(first) / (kInstants + 1) + part);
      move_nodes(mode, std::polar(amplitude(mode, radius), 2 * kPi * part), state);
      keep(state);
    }
    recording.end_clip(name, first);
  }
  return recording.encode();
}

EncodedRun record_equilibrium(const Simulation& start, const Simulation& equilibrium) {
  Recording recording(start, {start.scene().name + ": equilibrium"});
  recording.keep(start, {});
  recording.keep_still(0);
  recording.keep(equilibrium, {});
  recording.end_clip("equilibrium", 1);
  return recording.encode();
}

}  // namespace flexarm::pictures
