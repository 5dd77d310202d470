#pragma once
/// Contact of what one body has to touch with, or an element of a beam, and what another body is: a force element.

#include <array>

#include "contact/point_contact.h"
#include "model/force_element.h"

namespace flexarm {

/// Ways that a step may come to beyond those at the speed of its beginning: times that, and of the size of what
/// touches.
constexpr double kMoreWay = 2, kNear = 0.02;
/// Cosine of normals at both ends of a step that goes to the other side of something thin.
constexpr double kOtherSide = -0.5;

/// Where a body or an element of a beam touches others: a ball around a point of its nodes' frames. Of a beam it is on
/// its line, the sum of its nodes' positions with these weights.
struct ContactStation {
  static constexpr int kMostNodes = 5;
  std::array<double, kMostNodes> weights = {1};
  Vector3 arm = Vector3::Zero();       ///< in the frame of the only node; zero of a beam [m]
  double radius = 0;                   ///< [m]
  double share = 1;                    ///< of the law's stiffnesses
  Matrix3 outwards = Matrix3::Zero();  ///< of a corner, see ContactPoint, in the frame of the only node
};

/// Of a body, or of an element of a beam.
struct ContactStations {
  std::vector<int> nodes;  ///< one of a body, all of an element; -1: the world
  std::vector<ContactStation> stations;
  int at_a_time = 1;  ///< so many touch where the side lies on something flat
};
/// The shapes of one body.
struct ContactSurface {
  int node = -1;  ///< -1: the world
  std::vector<ContactShape> shapes;
};

inline const NodePose kWorldPose;  ///< at the origin, not turned

/// Of all nodes; the world is where it is.
inline auto poses_in(const std::vector<NodePose>& nodes) {
  return [&nodes](int node) -> const NodePose& { return node < 0 ? kWorldPose : nodes[node]; };
}
/// Middle of a station at poses `pose_of(node)`, world axes [m].
template <class PoseOf>
Vector3 middle_of(const ContactStations& side, const ContactStation& station, const PoseOf& pose_of) {
  Vector3 middle = Vector3::Zero();
  for (std::size_t i = 0; i < side.nodes.size(); ++i) {
    const NodePose& node = pose_of(side.nodes[i]);
    middle += station.weights[i] * (node.position + node.rotation * station.arm);
  }
  return middle;
}
/// Such a point in the frame of a surface [m].
template <class PoseOf>
Vector3 seen_from(const ContactSurface& surface, const Vector3& point, const PoseOf& pose_of) {
  const NodePose& body = pose_of(surface.node);
  return body.rotation.transpose() * (point - body.position);
}

/// Normals of the faces that meet in a station, see ContactPoint, in the frame of a surface.
template <class PoseOf>
Matrix3 outwards_of(const ContactStations& side, const ContactStation& station, const ContactSurface& surface,
                    const PoseOf& pose_of) {
  return pose_of(surface.node).rotation.transpose() * pose_of(side.nodes[0]).rotation * station.outwards;
}

/// Each station of one side with each shape of the other one.
class ContactElement : public ForceElement {
 public:
  /// `links`: names of the link with the stations, and of the link or ground with the shapes; `is_reversed`: the other
  /// way round.
  ContactElement(std::vector<std::string> links, ContactStations side, ContactSurface surface, const ContactLaw& law,
                 bool is_reversed = false, const std::string& name = "");

  const char* kind() const override { return "contact"; }
  std::vector<std::string> links() const override { return links_; }
  int find_nodes(const ForceStart& start, int* nodes) const override;
  ForceRoom room(const ForceStart& start) const override;
  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  bool needs_halves(const ForceStep& step, const int* nodes, int count) const override;
  bool hits() const override { return true; }
  double energy(const State& state, const double* memory) const override;
  /// Of points that touch: their gaps, and where they stick how far they slip.
  ForceMeasures measures(const State& state, const int* nodes) const override;
  DamperTensions dampers(const State& state, const Eigen::VectorXd& rates) const override;
  int memory_size() const override;
  void start(const State& state, double* memory) const override;
  double touch(const ForceMotion& motion, const TouchingPointTaker& take) const override;
  TouchLaw touch_law() const override {
    return {side_.stations.size() * surface_.shapes.size(),
            law_.stiffness,
            law_.restitution,
            law_.friction,
            law_.spinning,
            law_.rolling};
  }
  bool suits_all_schemes() const override { return false; }

 private:
  struct Frames;
  struct Placed;
  /// Of the stations' nodes those that move.
  int moving_nodes() const { return side_.nodes[0] < 0 ? 0 : static_cast<int>(side_.nodes.size()); }
  ContactLaw law_of(const ContactStation& station) const;
  /// Numbers of a point's measures: its gap, and what sticks.
  int measures_each() const;
  static PointMemory memory_at(const double* numbers) {
    return {numbers[0], Eigen::Map<const Vector3>(numbers + 1), static_cast<int>(numbers[4]), numbers[5],
            numbers[6], Eigen::Map<const Vector3>(numbers + 7)};
  }
  static void put(const PointMemory& memory, double* numbers) {
    numbers[0] = memory.speed;
    Eigen::Map<Vector3>(numbers + 1) = memory.stretch;
    numbers[4] = memory.face;
    numbers[5] = memory.within;
    numbers[6] = memory.start;
    Eigen::Map<Vector3>(numbers + 7) = memory.turned;
  }
  /// Of a station's middle in the frame of the shapes, at poses `pose_of(node)`.
  template <class PoseOf>
  Vector3 place(const ContactStation& station, const PoseOf& pose_of) const {
    return seen_from(surface_, middle_of(side_, station, pose_of), pose_of);
  }
  /// By how much it moves there [m/s].
  template <class PoseOf>
  Vector3 velocity(const ContactStation& station, const PoseOf& pose_of, const std::vector<Vector6>& velocities) const;
  /// Whether a step is too long for one of them; `acts`: see needs_halves().
  bool is_too_long(const ContactStation& station, const ContactShape& shape, const PointMemory& memory,
                   const ForceStep& step, bool acts) const;
  Frames frames(const ForceStep& step) const;
  double remembered_energy(const ForceStep& step) const;
  Placed placed(const ContactStation& station, const Frames& frames, const ForceStep& step) const;
  void add(const ContactStation& station, const Frames& frames, const Placed& placed, const PointAction& local,
           ForceAction& action) const;
  /// `kColumns`: six for each node that moves, or Eigen::Dynamic.
  template <int kColumns>
  void add_tangent(const ContactStation& station, const Frames& frames, const Placed& placed, const PointAction& local,
                   ForceAction& action) const;
  /// A ball that holds all stations.
  struct Bounds {
    Vector3 middle;  // in the frame of the shapes [m]
    double radius;   // [m]
  };
  template <class PoseOf>
  Bounds bounds(const PoseOf& pose_of) const;
  /// No station is faster there at the beginning of a step [m/s].
  double highest_speed(const ForceStart& start) const;
  /// Calls visit(station, shape) of all, in the order of the memory, until it returns false.
  template <class Visit>
  void for_each_pair(const Visit& visit) const;
  /// Calls visit(station, signed distance) of those that touch.
  template <class Visit>
  void for_each_touching(const State& state, const Visit& visit) const;

  std::vector<std::string> links_;
  ContactStations side_;
  ContactSurface surface_;
  ContactLaw law_;
  bool is_reversed_;
  double size_ = 0;                       ///< of the stations' side, about its first node [m]
  Vector3 middle_arm_ = Vector3::Zero();  ///< of the stations' middle, in the frame of the only node [m]
  double own_radius_ = 0, spread_ = 1;    ///< of stations: about their nodes [m], and of what these are apart
};

template <class PoseOf>
Vector3 ContactElement::velocity(const ContactStation& station, const PoseOf& pose_of,
                                 const std::vector<Vector6>& velocities) const {
  const auto motion_of = [&](int node) { return node < 0 ? Vector6(Vector6::Zero()) : velocities[node]; };
  Vector3 velocity = Vector3::Zero();
  for (std::size_t i = 0; i < side_.nodes.size(); ++i) {
    const Vector6 motion = motion_of(side_.nodes[i]);
    const Vector3 arm = pose_of(side_.nodes[i]).rotation * station.arm;
    velocity += station.weights[i] * (motion.head<3>() + motion.tail<3>().cross(arm));
  }
  const NodePose& base = pose_of(surface_.node);
  const Vector6 motion = motion_of(surface_.node);
  velocity -= motion.head<3>() + motion.tail<3>().cross(middle_of(side_, station, pose_of) - base.position);
  return base.rotation.transpose() * velocity;
}

}  // namespace flexarm
