#include "building/cylinder_places.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "building/passes.h"
#include "building/rigid_lines.h"
#include "flexarm/model/model_error.h"

namespace flexarm {
namespace {

/// Largest difference between a cylinder's length and the start of its motion, relative to the extent of the mechanism.
/// Scenes have rounded numbers.
constexpr double kLargestMismatch = 1e-6;
/// Shorter cylinders, relative to the extent, have no direction.
constexpr double kShortest = 1e-9;

// Looks, where the scene gives none:
constexpr double kPartLength = 0.6;     // of the length at the start
constexpr double kBarrelRadius = 0.03;  // of the length at the start
constexpr double kRodRadius = 0.5;      // of the barrel's radius
constexpr scene::Color kBarrelColor{0.35, 0.37, 0.4, 1}, kRodColor{0.8, 0.82, 0.85, 1};

template <class Named>
Named& find_named(std::vector<Named>& things, const std::string& name) {
  return *std::find_if(things.begin(), things.end(), [&](const Named& thing) { return thing.name == name; });
}

class CylinderPlacer {
 public:
  explicit CylinderPlacer(const scene::SceneDescription& scene)
      : rigid_(scene), plan_(rigid_.scene), tree_(follow_mimics(plan_, add_inertia(plan_, place_tree(plan_)))) {}

  void place(const scene::CylinderDescription& cylinder, PlacedScene& placed) const {
    const std::string where = at(cylinder.location, "<cylinder> '" + cylinder.name + "'");
    const Pose from = link_pose(cylinder.from, cylinder.from_at), to = link_pose(cylinder.to, cylinder.to_at);
    const Vector3 way = to * cylinder.to_at - from * cylinder.from_at;
    const double length = way.norm();
    if (length <= kShortest * tree_.extent())
      throw ModelError(where + "its points coincide at the start, so that it has no direction");
    const Vector3 x = way / length, z = normal_to(x, cylinder);
    Matrix3 axes;
    axes << x, z.cross(x), z;
    scene::SceneDescription& scene = placed.scene;
    find_named(scene.joints, cylinder.name + "_hinge").origin.orientation =
        from.orientation.conjugate() * Quaternion(axes).normalized();
    set_length(cylinder.name, length, where + "its length at the start", scene);
    if (!cylinder.pump.empty())
      set_length(cylinder.pump, length, where + "the length that its pump has filled at the start", scene);
    warn_of_limits(find_named(scene.joints, cylinder.name), length, placed.warnings);
    const double radius = cylinder.barrel.radius.value_or(kBarrelRadius * length);
    add_shape(cylinder.barrel, 1, length, radius, kBarrelColor, find_named(scene.links, cylinder.name + "_barrel"));
    add_shape(cylinder.rod, -1, length, kRodRadius * radius, kRodColor,
              find_named(scene.links, cylinder.name + "_rod"));
  }

 private:
  /// Pose of a link's frame at the start, as the section at `point` carries it.
  Pose link_pose(const std::string& link, const Vector3& point) const {
    const Attachment frame = attachment(plan_, tree_.model, link, point);
    return tree_.pose_of(frame.node) * frame.offset;
  }

  /// Joints of the tree between two links.
  std::set<const scene::JointDescription*> joints_between(const std::string& one, const std::string& other) const {
    std::set<const scene::JointDescription*> between;
    for (const std::string& link : {one, other})
      for (const scene::JointDescription* joint = plan_.tree.above[plan_.links[link]]; joint;
           joint = plan_.tree.above[plan_.links[joint->parent]])
        if (!between.insert(joint).second) between.erase(joint);  // both links hang on it
    return between;
  }

  /// A unit vector normal to `x`: as nearly as possible an axis of the joints between both links.
  Vector3 normal_to(const Vector3& x, const scene::CylinderDescription& cylinder) const {
    constexpr double kBetter = 1 + 1e-9;  // so that of equally good axes the first one is taken
    const std::set<const scene::JointDescription*> between = joints_between(cylinder.from, cylinder.to);
    Vector3 best = Vector3::Zero();
    for (const JointChain& chain : tree_.tree_joints) {
      if (between.count(chain.joint) == 0) continue;
      for (int j = chain.first_map; j < chain.first_map + chain.map_count; ++j) {
        const JointMap& map = tree_.model.joints[j];
        if (map.kind != JointMapKind::Scalar || map.rotation.isZero(0)) continue;
        const Vector3 axis = tree_.pose_of(map.master).orientation * map.rotation.normalized();
        const Vector3 across = axis - axis.dot(x) * x;
        if (across.norm() > kBetter * best.norm()) best = across;
      }
    }
    return best.norm() > 1e-6 ? Vector3(best.normalized()) : Vector3(x.unitOrthogonal());
  }

  /// Makes the length the initial position of a coordinate. `what`: it is, for messages.
  void set_length(const std::string& coordinate, double length, const std::string& what,
                  scene::SceneDescription& scene) const {
    for (const scene::PrescribedMotion& motion : scene.motions)
      if (motion.coordinate == coordinate &&
          !(std::abs(motion.position(0.0) - length) <= kLargestMismatch * tree_.extent()))
        throw ModelError(
            fmt::format("{} is {:.10g} m, but its motion begins at {:.10g}", what, length, motion.position(0.0)));
    for (scene::InitialJoint& initial : scene.initial_joints)
      if (initial.coordinate == coordinate) {
        initial.position = length;
        return;
      }
    const auto& joint = find_named(scene.joints, coordinate);
    scene.initial_joints.push_back({coordinate, length, 0, joint.location});
  }

  static void warn_of_limits(const scene::JointDescription& joint, double length, scene::Diagnostics& warnings) {
    if (!joint.limits || (length >= joint.limits->lower && length <= joint.limits->upper)) return;
    warnings.push_back({scene::Diagnostic::Severity::Warning, joint.location.file, joint.location.line,
                        "<cylinder> '" + joint.name + "'", fmt::format("'{:.10g}' m", length),
                        fmt::format("starts outside its limits, {:g} to {:g}, and its stop will push it back",
                                    joint.limits->lower, joint.limits->upper)});
  }

  /// `side`: 1 if the part extends along its link's x axis, -1 if against it. `start`: the length at the start.
  static void add_shape(const scene::CylinderDescription::Part& part, double side, double start, double radius,
                        const scene::Color& color, scene::LinkDescription& link) {
    scene::CylinderShape shape;
    shape.length = part.length.value_or(kPartLength * start);
    shape.radius = part.radius.value_or(radius);
    scene::VisualDescription visual;
    visual.origin.position = side * 0.5 * shape.length * Vector3::UnitX();
    visual.origin.orientation = Quaternion::FromTwoVectors(Vector3::UnitZ(), Vector3::UnitX());
    visual.shape = shape;
    visual.color = color;
    link.visuals = {visual};
  }

  const RigidLines rigid_;
  const ScenePlan plan_;
  const TreeAtStart tree_;
};

}  // namespace

PlacedScene place_cylinders(const scene::SceneDescription& scene) {
  PlacedScene placed{scene, {}};
  if (scene.cylinders.empty()) return placed;
  const CylinderPlacer placer(scene);
  for (const scene::CylinderDescription& cylinder : scene.cylinders) placer.place(cylinder, placed);
  placed.scene.cylinders.clear();
  return placed;
}

}  // namespace flexarm
