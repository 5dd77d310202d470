#include "building/passes.h"

#include <limits>
#include <unordered_set>

#include "joints/kinematics.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// Round-off of the angle between an axis and a body along it.
constexpr double kRoundOff = 64 * std::numeric_limits<double>::epsilon();
/// If a composite inertia is less than this part of that of the largest motion about the joint, it has too few digits.
/// An example is a long thin rod about its own axis.
constexpr double kDoubtful = 1e-9;

/// Mass, first moment and inertia of everything outboard of a node, world axes, initial configuration. They are about
/// the node, so that round-off does not grow with the distance to the world's origin.
struct Composite {
  double mass = 0;
  Vector3 moment = Vector3::Zero();
  Matrix3 inertia = Matrix3::Zero();

  void operator+=(const Composite& other) {
    mass += other.mass;
    moment += other.moment;
    inertia += other.inertia;
  }
  /// The same about another point. `here`: from that point to the present one.
  Composite seen_from(const Vector3& here) const {
    const Matrix3 p = so3::hat(here), s = so3::hat(moment);
    return {mass, moment + mass * here, inertia - s * p - p * s - mass * p * p};
  }
};

/// The innermost node that carries a loop's slave, but not its master.
int start_of_loop(const std::vector<int>& parents, const JointMap& joint) {
  std::unordered_set<int> carriers;  // of the master
  for (int node = joint.master; node >= 0; node = parents[node]) carriers.insert(node);
  int start = joint.slave;
  while (parents[start] >= 0 && carriers.count(parents[start]) == 0) start = parents[start];
  return start;
}

std::vector<Composite> composites(const std::vector<int>& parents, const Model& model) {
  std::vector<Composite> out(model.nodes.size());
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    const Matrix3& rotation = model.nodes[i].rotation;
    out[i].mass = inertia.total_mass;
    out[i].inertia = rotation * (inertia.rotary + inertia.beam_rotary) * rotation.transpose();
  }
  const auto seen_from = [&](int from, int node) {
    return out[node].seen_from(model.nodes[node].position - model.nodes[from].position);
  };
  for (int i = static_cast<int>(out.size()) - 1; i >= 0; --i)
    if (parents[i] >= 0) out[parents[i]] += seen_from(parents[i], i);  // parents come before their children
  // A massless node of a chain gets the properties of what its joint moves. If the joint closes a loop, that is the
  // branch from the loop's start to the slave.
  for (std::size_t j = model.joints.size(); j-- > 0;) {
    const JointMap& joint = model.joints[j];
    if (joint.master < 0 || out[joint.master].mass != 0) continue;
    const bool closes = parents[joint.slave] != joint.master && joint.kind != JointMapKind::Slide;
    out[joint.master] = seen_from(joint.master, closes ? start_of_loop(parents, joint) : joint.slave);
  }
  return out;
}

/// The inertia that a coordinate moves, at the start.
struct MovedInertia {
  double inertia = 0;        ///< m |t|^2 + J |r|^2 [kg or kg m^2]
  bool is_anything = false;  ///< the inertia is more than round-off
};

/// Inertia of all that hangs on the node `root`, in a motion {translation, spin} (world axes) about an axis through
/// `origin`. It is a sum of squares of distances to the axis, in which nothing cancels.
double inertia_about(const std::vector<int>& parents, const Model& model, int root, const Vector3& origin,
                     const Vector6& axis) {
  std::vector<bool> hangs(parents.size(), false);
  double inertia = 0;
  for (std::size_t i = root; i < parents.size(); ++i) {  // parents come before their children
    hangs[i] = static_cast<int>(i) == root || (parents[i] >= 0 && hangs[parents[i]]);
    if (!hangs[i]) continue;
    const NodalInertia& own = model.inertias[i];
    const Vector3 spin = model.nodes[i].rotation.transpose() * axis.tail<3>();
    const Vector3 motion = axis.head<3>() + axis.tail<3>().cross(model.nodes[i].position - origin);
    inertia += own.total_mass * motion.squaredNorm() + spin.dot((own.rotary + own.beam_rotary) * spin);
  }
  return inertia;
}

MovedInertia moved_inertia(const std::vector<int>& parents, const Model& model, const Coordinate& coordinate,
                           const std::vector<Composite>& outboard) {
  const JointMap& joint = model.joints[coordinate.joint];
  const NodePose world;
  const NodePose& master = joint.master < 0 ? world : model.nodes[joint.master];
  const Matrix3 frame = master.rotation * joint.origin.orientation.toRotationMatrix();
  Vector3 translation = joint.translation, rotation = joint.rotation;
  if (joint.profile) translation *= joint.profile->derivative(model.initial_released[coordinate.joint].displacement[0]);
  if (joint.kind != JointMapKind::Scalar) {
    const Vector3 unit = Vector3::Unit(coordinate.component % 3);
    translation = coordinate.is_angle ? Vector3::Zero() : unit;
    rotation = coordinate.is_angle ? unit : Vector3::Zero();
  }
  const NodePose& slave = model.nodes[joint.slave];
  const Composite body = outboard[joint.slave].seen_from(slave.position - moved_origin(joint, slave));
  // Screw-like couplings have no cross term of travel and turn about their axis.
  const Vector3 about_axis = frame * rotation;
  const double inertia = body.mass * translation.squaredNorm() + about_axis.dot(body.inertia * about_axis);
  // An inertia of the size of round-off counts as none.
  const double terms = body.mass * translation.squaredNorm() + body.inertia.trace() * rotation.squaredNorm();
  if (inertia > kDoubtful * terms || terms == 0) return {inertia, inertia > 0};
  Vector6 axis;
  axis << frame * translation, about_axis;
  const double summed = inertia_about(parents, model, joint.slave, moved_origin(joint, slave), axis);
  return {summed, summed > kRoundOff * kRoundOff * terms};
}

/// If a coordinate moves nothing itself, adds what the coordinates that follow it move.
void add_followers(const Model& model, std::vector<MovedInertia>& moved) {
  const std::vector<MovedInertia> own = moved;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Coordinate& follower = model.coordinates[i];
    if (follower.mimicked < 0 || !own[i].is_anything || own[follower.mimicked].is_anything) continue;
    MovedInertia& leader = moved[follower.mimicked];
    const double ratio = follower_ratio(model, follower, model.initial_released);
    leader.inertia = (leader.is_anything ? leader.inertia : 0) + ratio * ratio * own[i].inertia;
    leader.is_anything = leader.inertia > 0;
  }
}

}  // namespace

std::vector<int> finish_mass_properties(const std::vector<int>& parents, Model& model) {
  const std::vector<Composite> outboard = composites(parents, model);
  std::vector<MovedInertia> moved;
  for (const Coordinate& coordinate : model.coordinates) {
    moved.push_back(is_held(model, coordinate) ? MovedInertia() : moved_inertia(parents, model, coordinate, outboard));
    const double rotor = armature(model, coordinate);
    if (rotor > 0) moved.back() = {(moved.back().is_anything ? moved.back().inertia : 0) + rotor, true};
  }
  add_followers(model, moved);
  const auto count = moved.size();
  // A prescribed or following coordinate needs no inertia.
  const auto is_massless = [&](std::size_t i) {
    return !moved[i].is_anything && model.coordinates[i].motion < 0 && model.coordinates[i].mimicked < 0;
  };
  std::vector<bool> is_asked(count);
  for (std::size_t i = 0; i < count; ++i) is_asked[i] = is_massless(i) || model.coordinates[i].limit;
  const std::vector<InLoops> in_loops = loop_inertias(parents, model, is_asked);
  std::vector<int> massless;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_massless(i) && !in_loops[i].is_determined) massless.push_back(static_cast<int>(i));
    if (std::optional<LimitStop>& limit = model.coordinates[i].limit)
      limit->carry(in_loops[i].inertia > 0 ? in_loops[i].inertia : moved[i].inertia);
  }
  return massless;
}

}  // namespace flexarm
