#pragma once
/// The points with which a body, or a beam element, touches shapes of another body, and where these are at an instant.

#include <algorithm>
#include <array>
#include <vector>

#include "contact/segment.h"
#include "contact/shape.h"
#include "model/state.h"

namespace flexarm {

/// A contact point of a body or of a beam element: a ball (radius 0 for a corner), the lowest point of a body's rim, or
/// a ball at the nearest point of a body's segment. On a body its middle is fixed to the node. On a beam it is on the
/// line: the sum of the nodes' positions times `weights`.
struct ContactStation {
  static constexpr int kMostNodes = 5;
  std::array<double, kMostNodes> weights = {1};
  Vector3 arm = Vector3::Zero();       ///< middle of the ball in the frame of the only node; zero for a beam [m]
  double radius = 0;                   ///< of the ball [m]
  double share = 1;                    ///< factor of the law's stiffnesses
  double rim = 0;                      ///< > 0: radius of a rim, which touches flat shapes only [m]
  double half = 0, curvature = 0;      ///< > 0: half the length of a segment [m], and its curvature [1/m]
  Vector3 axis = Vector3::UnitZ();     ///< of the rim or segment, in the frame of the only node
  Matrix3 outwards = Matrix3::Zero();  ///< for a corner, see ContactPoint, in the frame of the only node

  /// Returns the largest distance of a point that may touch from the middle [m].
  double reach() const { return radius + rim + half; }
};

/// The stations of a body, or of a beam element.
struct ContactStations {
  std::vector<int> nodes;  ///< of a body one node, -1: the world; of a beam element all its nodes
  std::vector<ContactStation> stations;
  int at_a_time = 1;  ///< how many stations touch if the body lies on a plane
};
/// The shapes of one body.
struct ContactSurface {
  int node = -1;  ///< -1: the world
  std::vector<ContactShape> shapes;
};

inline const NodePose kWorldPose;  ///< at the origin, with the world's axes

/// Returns a function that returns the pose of a node, or the world's pose for -1.
inline auto poses_in(const std::vector<NodePose>& nodes) {
  return [&nodes](int node) -> const NodePose& { return node < 0 ? kWorldPose : nodes[node]; };
}
inline auto poses_in(const State& state) {
  return [&state](int node) { return node < 0 ? NodePose() : node_pose(state.nodes[node]); };
}

/// Where a station touches, in the frame of the shapes' node.
struct StationPlace {
  Vector3 middle, offset = Vector3::Zero();  ///< of the station, and of the point that touches from there [m]
  int face = 0;                              ///< see SeenStations::face()
  double rise = 0;                           ///< of a segment, see NearestOnSegment [m]

  Vector3 point() const { return middle + offset; }
};

/// Stations at an instant, seen from the node of the shapes, in its frame.
class SeenStations {
 public:
  /// `pose_of(node)`: the pose of a node, or of the world for -1.
  template <class PoseOf>
  SeenStations(const ContactStations& side, const ContactSurface& surface, const PoseOf& pose_of);

  Vector3 middle(const ContactStation& station) const;
  Rim rim(const ContactStation& station) const { return {middle(station), turn_ * station.axis, station.rim}; }
  Segment segment(const ContactStation& station) const {
    return {middle(station), turn_ * station.axis, station.half, station.curvature};
  }
  /// Returns the normals of the faces that meet in a station, see ContactPoint.
  Matrix3 outwards(const ContactStation& station) const { return turn_ * station.outwards; }
  /// Returns the only face by which a station may enter: the one below a rim, or `remembered`, if this is not 0; of
  /// other stations 0 (any).
  int face(const ContactStation& station, const ContactShape& shape, int remembered) const {
    if (station.rim == 0) return 0;
    return remembered != 0 ? remembered : face_below(shape, rim(station));
  }
  /// Returns where a station touches. `face`: see face().
  StationPlace place(const ContactStation& station, const ContactShape& shape, int face) const;
  /// Returns a lower bound of the distance of a station's surface from a shape [m].
  double least_gap(const ContactStation& station, const ContactShape& shape) const;

 private:
  std::array<Vector3, ContactStation::kMostNodes> nodes_;  // [m]
  int count_;
  Matrix3 turn_;  // of the only node
};

/// Velocities of stations relative to the shapes, in their frame.
class StationVelocities {
 public:
  /// `velocities`: {v, w} of all nodes, world axes; empty: all are zero.
  template <class PoseOf>
  StationVelocities(const ContactStations& side, const ContactSurface& surface, const PoseOf& pose_of,
                    const std::vector<Vector6>& velocities);

  /// Returns the velocity of a point that is fixed to a station [m/s]. `place`: where the station is.
  Vector3 at(const ContactStation& station, const StationPlace& place) const;
  /// Returns the rate of rotation of a body [rad/s].
  Vector3 rotation() const { return rates_[0] - base_rate_; }

 private:
  std::array<Vector3, ContactStation::kMostNodes> origins_, linear_, rates_;  // of nodes: places, velocities
  int count_;
  Vector3 base_, base_rate_;
};

template <class PoseOf>
SeenStations::SeenStations(const ContactStations& side, const ContactSurface& surface, const PoseOf& pose_of)
    : count_(static_cast<int>(side.nodes.size())) {
  const NodePose& base = pose_of(surface.node);
  for (int i = 0; i < count_; ++i)
    nodes_[i] = base.rotation.transpose() * (pose_of(side.nodes[i]).position - base.position);
  turn_ = base.rotation.transpose() * pose_of(side.nodes[0]).rotation;
}

inline Vector3 SeenStations::middle(const ContactStation& station) const {
  if (count_ == 1) return nodes_[0] + turn_ * station.arm;
  Vector3 out = station.weights[0] * nodes_[0];
  for (int i = 1; i < count_; ++i) out += station.weights[i] * nodes_[i];
  return out;
}

inline StationPlace SeenStations::place(const ContactStation& station, const ContactShape& shape, int face) const {
  if (station.half > 0) {
    const Segment seen = segment(station);
    const NearestOnSegment nearest = nearest_on(seen, shape);
    return {seen.middle, nearest.along * seen.axis, 0, nearest.rise};
  }
  if (station.rim == 0) return {middle(station)};
  const Rim seen = rim(station);
  return {seen.middle, lowest_point(seen, face_normal(shape, face)), face};
}

inline double SeenStations::least_gap(const ContactStation& station, const ContactShape& shape) const {
  if (station.half == 0) return shape.gap(middle(station)) - station.reach();
  const Segment seen = segment(station);
  const Vector3 way = shape.place.position - seen.middle;
  const double along = std::clamp(way.dot(seen.axis), -seen.half, seen.half);
  return (way - along * seen.axis).norm() - bounding_radius(shape) - station.radius;
}

template <class PoseOf>
StationVelocities::StationVelocities(const ContactStations& side, const ContactSurface& surface, const PoseOf& pose_of,
                                     const std::vector<Vector6>& velocities)
    : count_(static_cast<int>(side.nodes.size())) {
  const NodePose& base = pose_of(surface.node);
  const auto motion_of = [&](int node) {
    return node < 0 || velocities.empty() ? Vector6(Vector6::Zero()) : velocities[node];
  };
  const Vector6 moving = motion_of(surface.node);
  base_ = base.rotation.transpose() * moving.head<3>();
  base_rate_ = base.rotation.transpose() * moving.tail<3>();
  for (int i = 0; i < count_; ++i) {
    const Vector6 motion = motion_of(side.nodes[i]);
    origins_[i] = base.rotation.transpose() * (pose_of(side.nodes[i]).position - base.position);
    linear_[i] = base.rotation.transpose() * motion.head<3>();
    rates_[i] = base.rotation.transpose() * motion.tail<3>();
  }
}

inline Vector3 StationVelocities::at(const ContactStation& station, const StationPlace& place) const {
  const Vector3 point = place.point();
  Vector3 out = -base_ - base_rate_.cross(point);
  if (count_ == 1) return out + linear_[0] + rates_[0].cross(point - origins_[0]);
  for (int i = 0; i < count_; ++i) out += station.weights[i] * (linear_[i] + rates_[i].cross(place.offset));
  return out;
}

}  // namespace flexarm
