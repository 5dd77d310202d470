#pragma once
/// The force element of contact between the contact points of a body, or of a beam element, and the shapes of another
/// body.

#include "contact/contact_stations.h"
#include "contact/point_contact.h"
#include "model/force_element.h"

namespace flexarm {

/// Bound of the motion in a step: kMoreWay times the step at the speed of its beginning, plus kNear times the size of
/// the body with the stations.
constexpr double kMoreWay = 2, kNear = 0.02;
/// If the cosine between the normals at both ends of a step is below this, the point has passed through something thin.
constexpr double kOtherSide = -0.5;

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
  template <class PoseOf>
  SeenStations seen(const PoseOf& pose_of) const {
    return {side_, surface_, pose_of};
  }
  double stored_energy(const ContactStation& station, const ContactShape& shape, const PointMemory& memory,
                       const SeenStations& seen) const {
    const StationPlace place = seen.place(station, shape, seen.face(station, shape, memory.face));
    return flexarm::stored_energy(shape, law_of(station), station.radius - place.rise, place.point(), memory);
  }
  /// The stations at both ends of a step, and their velocities at its beginning.
  struct Seen {
    SeenStations begin, end;
    StationVelocities velocities;
  };
  Seen seen(const ForceStep& step) const {
    static const std::vector<Vector6> still;
    const auto begin_of = poses_in(step.begin);
    return {seen(begin_of),
            seen(poses_in(step.end)),
            {side_, surface_, begin_of, step.duration != 0 ? step.velocities : still}};
  }
  /// The motion of a pair's points over a step. `remembered`: the face of its memory.
  PointMotion motion_of(const ContactStation& station, const ContactShape& shape, int remembered,
                        const Seen& seen) const;
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
                  const ForceStep& step, const Seen& seen) const;
  /// Whether a step is too long for one station and shape. `acts`: the element acts on nodes in this step.
  bool is_too_long(const Passage& passage, const ContactShape& shape, const ForceStep& step, bool acts) const;
  Frames frames(const ForceStep& step) const;
  double remembered_energy(const ForceStep& step) const;
  Placed placed(const ContactStation& station, const Frames& frames, const ForceStep& step, const Seen& seen) const;
  /// Whether a station and a shape may touch in a step, by the motion between its ends.
  static bool may_touch(const ContactStation& station, const ContactShape& shape, const Seen& seen);
  struct Slide;
  /// Where a segment touches over a step.
  Slide slide(const ContactStation& station, const ContactShape& shape, const ForceStep& step, const Seen& seen) const;
  static double midway(const ContactStation& station, const ContactShape& shape, double duration, const Seen& seen);
  struct Tilt;
  /// How a rim is tilted against the face that it may touch.
  Tilt tilt(const ContactStation& station, const ContactShape& shape, const PointMotion& motion, const Frames& frames,
            const ForceStep& step) const;
  struct Moving;
  void add(const ContactStation& station, const Frames& frames, const Placed& placed, const Moving& moving,
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
  void add_tangent(const ContactStation& station, const Frames& frames, const Placed& placed, const Moving& moving,
                   const PointAction& local, ForceAction& action) const;
  /// A ball that contains all stations.
  struct Bounds {
    Vector3 middle;  // in the frame of the shapes [m]
    double radius;   // [m]
  };
  template <class PoseOf>
  Bounds bounds(const PoseOf& pose_of) const;
  /// Returns a bound of the stations' speeds relative to the shapes, at the beginning of a step [m/s].
  double highest_speed(const ForceStart& start) const;

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

}  // namespace flexarm
