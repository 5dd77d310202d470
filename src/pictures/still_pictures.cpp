#include "pictures/still_pictures.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "math/pi.h"
#include "simulation/inside.h"

namespace flexarm::pictures {
namespace {

constexpr double kPeriod = 2;          ///< of a swing in the page [s]
constexpr int kInstants = 48;          ///< of a period
constexpr double kLargestWay = 0.1;    ///< of a node, per radius of the scene
constexpr double kLargestAngle = 0.3;  ///< of a node [rad]
constexpr double kLeastWay = 1e-9;     ///< as above; less is round-off
constexpr double kLeastEnlargement = 5;
constexpr double kEachInstant = 1e9;  ///< a rate with which no instant is left out

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

/// The way of a node between two states as a rotation vector.
Vector3 turn_between(const NodeState& from, const NodeState& to) {
  const Eigen::AngleAxisd turn(to.orientation * from.orientation.conjugate());
  return std::remainder(turn.angle(), 2 * kPi) * turn.axis();
}

/// The factor, 1, 2 or 5 times a power of ten, with which the ways between two states are seen well and still look like
/// small motions.
double enlargement(const State& from, const State& to, double radius) {
  double way = 0, angle = 0;
  for (std::size_t i = 0; i < from.nodes.size(); ++i) {
    way = std::max(way, (to.nodes[i].position - from.nodes[i].position).norm());
    angle = std::max(angle, turn_between(from.nodes[i], to.nodes[i]).norm());
  }
  if (!(way > kLeastWay * radius)) return 1;
  const double most = std::min(kLargestWay * radius / way, angle > 0 ? kLargestAngle / angle : kLargestWay / kLeastWay);
  const double power = std::pow(10, std::floor(std::log10(most)));
  return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

/// The second state, with ways from the first one that are so many times as long.
State enlarged(const State& from, const State& to, double factor) {
  State state = to;
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    NodeState& node = state.nodes[i];
    node.position = from.nodes[i].position + factor * (to.nodes[i].position - from.nodes[i].position);
    const Vector3 turn = factor * turn_between(from.nodes[i], to.nodes[i]);
    if (turn.norm() > 0)
      node.orientation = Quaternion(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * from.nodes[i].orientation;
  }
  return state;
}

/// Replaces strains, stress resultants and columns of an instant by those of another one.
void use_strains(const Picture& picture, const std::vector<double>& from, std::vector<double>& values) {
  std::size_t at = 7 * picture.links.size();
  const auto copy = [&](std::size_t begin, std::size_t count) {
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(begin), count,
                values.begin() + static_cast<std::ptrdiff_t>(begin));
  };
  for (const PictureBeam& beam : picture.beams)
    for (std::size_t k = 0; k < beam.sections.size(); ++k, at += 19) copy(at + 7, 12);
  copy(values.size() - picture.columns.size(), picture.columns.size());
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
  const ResultColumns columns(start, ResultColumns::Solver::Without);
  Picture picture = picture_of(start, columns.columns());
  picture.title = start.scene().name + ": equilibrium";
  Recording recording(std::move(picture), kEachInstant);
  Instant instant(recording.picture(), columns);
  const auto keep = [&](const Simulation& simulation, double time, const std::vector<double>* strains) {
    std::vector<double> values;
    instant.append(simulation, {}, values);
    Arrows arrows;
    find_arrows(simulation, arrows);
    if (strains) {
      use_strains(recording.picture(), *strains, values);
      arrows[static_cast<std::size_t>(ArrowKind::Contact)].clear();
    }
    recording.keep(time, values, std::move(arrows));
    return values;
  };
  keep(start, start.time(), nullptr);
  recording.keep_still(0);
  const std::vector<double> at_rest = keep(equilibrium, start.time(), nullptr);
  recording.end_clip("equilibrium", 1);
  const double factor = enlargement(state_of(start), state_of(equilibrium), recording.picture().extent.radius);
  if (factor >= kLeastEnlargement) {
    Simulation moved = equilibrium.copy();
    show(enlarged(state_of(start), state_of(equilibrium), factor), moved);
    keep(moved, start.time() + 1, &at_rest);  // so that times tell the clips apart
    recording.end_clip(fmt::format("deflections \u00d7 {:g}", factor), 2);
  }
  return recording.encode();
}

}  // namespace flexarm::pictures
