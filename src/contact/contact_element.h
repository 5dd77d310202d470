#pragma once
/// The force element of contact between the contact points of a body, or of a beam element, and the shapes of another
/// body.

#include <algorithm>
#include <array>

#include "contact/point_contact.h"
#include "contact/segment.h"
#include "model/force_element.h"

namespace flexarm {

/// Bound of the motion in a step: kMoreWay times the step at the speed of its beginning, plus kNear times the size of
/// the body with the stations.
constexpr double kMoreWay = 2, kNear = 0.02;
/// If the cosine between the normals at both ends of a step is below this, the point has passed through something thin.
constexpr double kOtherSide = -0.5;

/// A contact point of a body or of a beam element: a ball (radius 0 for a corner), the lowest point of a body's rim, or
/// a ball at the nearest point of a body's segment.
/// On a body its middle is fixed to the node. On a beam it is on the line: the sum of the nodes' positions times
/// `weights`.
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
/// Returns the position of a station's middle at the poses `pose_of(node)`, in world axes [m].
template <class PoseOf>
Vector3 middle_of(const ContactStations& side, const ContactStation& station, const PoseOf& pose_of) {
  Vector3 middle = Vector3::Zero();
  for (std::size_t i = 0; i < side.nodes.size(); ++i) {
    const NodePose& node = pose_of(side.nodes[i]);
    middle += station.weights[i] * (node.position + node.rotation * station.arm);
  }
  return middle;
}
/// Returns a point, given in world axes, in the frame of a surface's node [m].
template <class PoseOf>
Vector3 seen_from(const ContactSurface& surface, const Vector3& point, const PoseOf& pose_of) {
  const NodePose& body = pose_of(surface.node);
  return body.rotation.transpose() * (point - body.position);
}

/// Returns the normals of the faces that meet in a station (see ContactPoint), in the frame of a surface's node.
template <class PoseOf>
Matrix3 outwards_of(const ContactStations& side, const ContactStation& station, const ContactSurface& surface,
                    const PoseOf& pose_of) {
  return pose_of(surface.node).rotation.transpose() * pose_of(side.nodes[0]).rotation * station.outwards;
}

/// A station seen from the shapes' node: its middle, and the offset of the point that touches from there.
struct StationPlace {
  Vector3 middle, offset = Vector3::Zero();  ///< in the frame of the shapes' node [m]
  int face = 0;                              ///< see face_of()
  double rise = 0;                           ///< of a segment, see NearestOnSegment [m]

  Vector3 point() const { return middle + offset; }
};
/// Returns a rim in the frame of a surface's node.
template <class PoseOf>
Rim rim_of(const ContactStations& side, const ContactStation& station, const ContactSurface& surface,
           const PoseOf& pose_of) {
  return {seen_from(surface, middle_of(side, station, pose_of), pose_of),
          pose_of(surface.node).rotation.transpose() * pose_of(side.nodes[0]).rotation * station.axis, station.rim};
}
/// Returns a segment in the frame of a surface's node.
template <class PoseOf>
Segment segment_of(const ContactStations& side, const ContactStation& station, const ContactSurface& surface,
                   const PoseOf& pose_of) {
  const Rim rim = rim_of(side, station, surface, pose_of);
  return {rim.middle, rim.axis, station.half, station.curvature};
}
/// Returns the only face by which a station may enter: the one below a rim, or `remembered`, if this is not 0; of other
/// stations 0 (any).
template <class PoseOf>
int face_of(const ContactStations& side, const ContactStation& station, const ContactSurface& surface,
            const ContactShape& shape, int remembered, const PoseOf& pose_of) {
  if (station.rim == 0) return 0;
  return remembered != 0 ? remembered : face_below(shape, rim_of(side, station, surface, pose_of));
}
/// Returns where a station is. `face`: see face_of().
template <class PoseOf>
StationPlace place_of(const ContactStations& side, const ContactStation& station, const ContactSurface& surface,
                      const ContactShape& shape, int face, const PoseOf& pose_of) {
  if (station.half > 0) {
    const Segment segment = segment_of(side, station, surface, pose_of);
    const NearestOnSegment nearest = nearest_on(segment, shape);
    return {segment.middle, nearest.along * segment.axis, 0, nearest.rise};
  }
  if (station.rim == 0) return {seen_from(surface, middle_of(side, station, pose_of), pose_of)};
  const Rim rim = rim_of(side, station, surface, pose_of);
  return {rim.middle, lowest_point(rim, face_normal(shape, face)), face};
}

/// Contact of each station of one side with each shape of the other side.
class ContactElement : public ForceElement {
 public:
  /// `links`: names of the two sides. The first has the stations and the second the shapes, unless `is_reversed`.
  ContactElement(std::vector<std::string> links, ContactStations side, ContactSurface surface, const ContactLaw& law,
                 bool is_reversed = false, const std::string& name = "");

  const char* kind() const override { return "contact"; }
  std::vector<std::string> links() const override { return links_; }
  int find_nodes(const ForceStart& start, int* nodes) const override;
  ForceRoom room(const ForceStart& start) const override;
  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  bool needs_halves(const ForceStep& step, const int* nodes, int count) const override;
  void put_penetrations(const ForceStep& step, const int* nodes, int count,
                        const PenetrationTaker& take) const override;
  bool hits() const override { return true; }
  double energy(const State& state, const double* memory) const override;
  /// The measures of points that touch: the gap; with friction, the slip; with resistance to turning, the rotation.
  ForceMeasures measures(const State& state, const double* memory, const int* nodes) const override;
  DamperTensions dampers(const State& state, const double* memory, const Eigen::VectorXd& rates) const override;
  int memory_size() const override;
  void start(const State& state, const double* functions, double* memory) const override;
  double touch(const ForceMotion& motion, const TouchingPointTaker& take) const override;
  TouchLaw touch_law() const override {
    return {side_.stations.size() * surface_.shapes.size(),
            law_.stiffness,
            law_.restitution.of_slow_hits(),
            law_.friction,
            law_.spinning,
            law_.rolling,
            law_.restitution.of_fast_hits()};
  }
  bool suits_all_schemes() const override { return false; }

 private:
  struct Frames;
  struct Placed;
  /// Returns the number of the stations' nodes; 0 if these are fixed to the world.
  int moving_nodes() const { return side_.nodes[0] < 0 ? 0 : static_cast<int>(side_.nodes.size()); }
  ContactLaw law_of(const ContactStation& station) const;
  /// Returns the number of measures of a point that touches.
  int measures_each() const;
  static PointMemory memory_at(const double* numbers) {
    return {numbers[0],
            Eigen::Map<const Vector3>(numbers + 1),
            static_cast<int>(numbers[4]),
            numbers[5],
            numbers[6],
            Eigen::Map<const Vector3>(numbers + 7),
            numbers[10]};
  }
  static void put(const PointMemory& memory, double* numbers) {
    numbers[0] = memory.speed;
    Eigen::Map<Vector3>(numbers + 1) = memory.stretch;
    numbers[4] = memory.face;
    numbers[5] = memory.within;
    numbers[6] = memory.start;
    Eigen::Map<Vector3>(numbers + 7) = memory.turned;
    numbers[10] = memory.root;
  }
  /// Returns the position of a station's middle in the frame of the shapes, at the poses `pose_of(node)` [m].
  template <class PoseOf>
  Vector3 place(const ContactStation& station, const PoseOf& pose_of) const {
    return seen_from(surface_, middle_of(side_, station, pose_of), pose_of);
  }
  /// Returns where a station is, in the frame of the shapes. `remembered`: the face of its memory.
  template <class PoseOf>
  StationPlace place(const ContactStation& station, const ContactShape& shape, int remembered,
                     const PoseOf& pose_of) const {
    return place_of(side_, station, surface_, shape, face_of(side_, station, surface_, shape, remembered, pose_of),
                    pose_of);
  }
  template <class PoseOf>
  double stored_energy(const ContactStation& station, const ContactShape& shape, const PointMemory& memory,
                       const PoseOf& pose_of) const {
    const StationPlace seen = place(station, shape, memory.face, pose_of);
    return flexarm::stored_energy(shape, law_of(station), station.radius - seen.rise, seen.point(), memory);
  }
  /// Returns the velocity of a station's middle, or of the point at an offset from there, relative to the shapes. Both
  /// vectors are in the shapes' frame [m/s, m].
  template <class PoseOf>
  Vector3 velocity(const ContactStation& station, const PoseOf& pose_of, const std::vector<Vector6>& velocities,
                   const Vector3& offset = Vector3::Zero()) const;
  /// The motion of a pair's points over a step. `remembered`: the face of its memory.
  PointMotion motion_of(const ContactStation& station, const ContactShape& shape, int remembered,
                        const ForceStep& step) const;
  /// What a solved step does to one station and shape.
  struct Passage {
    Vector3 from, to;  ///< points of the station that touch, in the frame of the shapes [m]
    FeltShape felt;
    SignedDistance begin, end;  ///< from the felt shape
    ContactChange change;
    double begin_rate;  ///< of the penetration [m/s]
  };
  /// Calls visit(passage, shape) for all pairs that may touch in a solved step, until it returns false.
  template <class Visit>
  void for_each_passage(const ForceStep& step, const Visit& visit) const;
  Passage passage(const ContactStation& station, const ContactShape& shape, const PointMemory& memory,
                  const ForceStep& step) const;
  /// Whether a step is too long for one station and shape. `acts`: the element acts on nodes in this step.
  bool is_too_long(const Passage& passage, const ContactShape& shape, const ForceStep& step, bool acts) const;
  Frames frames(const ForceStep& step) const;
  double remembered_energy(const ForceStep& step) const;
  Placed placed(const ContactStation& station, const Frames& frames, const ForceStep& step) const;
  /// Returns a lower bound of the distance of a station's surface from a shape [m].
  template <class PoseOf>
  double least_gap(const ContactStation& station, const ContactShape& shape, const PoseOf& pose_of) const;
  /// Whether a station and a shape may touch in a step, by the motion between its ends.
  bool may_touch(const ContactStation& station, const ContactShape& shape, const ForceStep& step) const;
  struct Slide;
  /// Where a segment touches over a step.
  Slide slide(const ContactStation& station, const ContactShape& shape, const ForceStep& step) const;
  double midway(const ContactStation& station, const ContactShape& shape, const ForceStep& step) const;
  struct Tilt;
  /// How a rim is tilted against the face that it may touch.
  Tilt tilt(const ContactStation& station, const ContactShape& shape, const PointMotion& motion, const Frames& frames,
            const ForceStep& step) const;
  void add(const ContactStation& station, const Frames& frames, const Placed& placed, const Tilt& tilt,
           const PointAction& local, ForceAction& action) const;
  template <int kColumns>
  struct Rows;
  template <int kColumns>
  Rows<kColumns> rows_of(const ContactStation& station, const Frames& frames, const Placed& placed) const;
  template <int kColumns>
  void add_slide(const Frames& frames, const Slide& slide, const PointAction& local, Rows<kColumns>& rows) const;
  template <int kColumns>
  void add_tilt(const Frames& frames, const Tilt& tilt, const PointAction& local, Rows<kColumns>& rows) const;
  template <int kColumns>
  void add_tangent(const ContactStation& station, const Frames& frames, const Placed& placed, const Tilt& tilt,
                   const Slide& slide, const PointAction& local, ForceAction& action) const;
  /// A ball that contains all stations.
  struct Bounds {
    Vector3 middle;  // in the frame of the shapes [m]
    double radius;   // [m]
  };
  template <class PoseOf>
  Bounds bounds(const PoseOf& pose_of) const;
  /// Returns a bound of the stations' speeds relative to the shapes, at the beginning of a step [m/s].
  double highest_speed(const ForceStart& start) const;
  /// Returns the rate of rotation of a body with stations relative to the shapes [rad/s].
  double turning_speed(const ForceStart& start) const;
  /// Calls visit(station, shape) for all pairs in the order of the memory, until it returns false.
  template <class Visit>
  void for_each_pair(const Visit& visit) const {
    for (const ContactStation& station : side_.stations)
      for (const ContactShape& shape : surface_.shapes)
        if (!visit(station, shape)) return;
  }
  /// Calls visit(station, its place, signed distance) for all pairs that touch.
  template <class Visit>
  void for_each_touching(const State& state, const double* memory, const Visit& visit) const;

  std::vector<std::string> links_;
  ContactStations side_;
  ContactSurface surface_;
  ContactLaw law_;
  bool is_reversed_;
  double size_ = 0;                       ///< largest distance of a station's surface from its node [m]
  Vector3 middle_arm_ = Vector3::Zero();  ///< mean of the stations' arms, in the frame of the only node [m]
  /// The stations are in a ball of the radius own_radius_ + spread_ * (largest distance of a node from the mean) [m].
  double own_radius_ = 0, spread_ = 1;
};

template <class PoseOf>
double ContactElement::least_gap(const ContactStation& station, const ContactShape& shape,
                                 const PoseOf& pose_of) const {
  if (station.half == 0) return shape.gap(place(station, pose_of)) - station.reach();
  const Segment segment = segment_of(side_, station, surface_, pose_of);
  const Vector3 way = shape.place.position - segment.middle;
  const double along = std::clamp(way.dot(segment.axis), -segment.half, segment.half);
  return (way - along * segment.axis).norm() - bounding_radius(shape) - station.radius;
}

template <class PoseOf>
Vector3 ContactElement::velocity(const ContactStation& station, const PoseOf& pose_of,
                                 const std::vector<Vector6>& velocities, const Vector3& offset) const {
  const auto motion_of = [&](int node) { return node < 0 ? Vector6(Vector6::Zero()) : velocities[node]; };
  const NodePose& base = pose_of(surface_.node);
  const Vector3 beyond = base.rotation * offset;
  Vector3 velocity = Vector3::Zero();
  for (std::size_t i = 0; i < side_.nodes.size(); ++i) {
    const Vector6 motion = motion_of(side_.nodes[i]);
    const Vector3 arm = pose_of(side_.nodes[i]).rotation * station.arm + beyond;
    velocity += station.weights[i] * (motion.head<3>() + motion.tail<3>().cross(arm));
  }
  const Vector6 motion = motion_of(surface_.node);
  velocity -= motion.head<3>() + motion.tail<3>().cross(middle_of(side_, station, pose_of) + beyond - base.position);
  return base.rotation.transpose() * velocity;
}

}  // namespace flexarm
