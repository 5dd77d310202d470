#include "pictures/scene_extent.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"

namespace flexarm::pictures {
namespace {

struct Sphere {
  Vector3 center;
  double radius;
};

constexpr double kNear = 2;         ///< of fixed things, in radii of what can move
constexpr double kRoundOff = 1e-6;  ///< what can move and is smaller, relative to everything, has no size of its own

/// Encloses the balls that `counts` accepts.
template <class Counts>
SceneExtent enclose(const std::function<void(const ExtentBallVisitor&)>& visit_balls, const Counts& counts) {
  const auto visit = [&](const auto& use) {
    visit_balls([&](const ExtentBall& ball) {
      if (ball.center.allFinite() && std::isfinite(ball.radius) && counts(ball)) use(ball);
    });
  };
  Eigen::AlignedBox3d box;
  visit([&](const ExtentBall& ball) {
    const Vector3 half = Vector3::Constant(ball.radius);
    box.extend(Eigen::AlignedBox3d(ball.center - half, ball.center + half));
  });
  if (box.isEmpty()) return {Vector3::Zero(), 0, Vector3::Zero()};
  SceneExtent out{box.center(), 0, 0.5 * box.sizes()};
  visit([&](const ExtentBall& ball) {
    out.radius = std::max(out.radius, (ball.center - out.center).norm() + ball.radius);
  });
  return out;
}

/// Follows the chains of joints from the root.
class ReachFinder {
 public:
  ReachFinder(const Simulation& simulation, const std::vector<std::vector<Vector3>>& more_points)
      : simulation_(simulation), more_points_(more_points) {
    const scene::SceneDescription& scene = simulation.scene();
    for (std::size_t link = 0; link < scene.links.size(); ++link) links_[scene.links[link].name] = link;
    for (const scene::JointDescription& joint : scene.joints) carriers_[links_.at(joint.child)] = &joint;
    for (std::size_t link = 0; link < scene.links.size(); ++link) add_link(link);
  }

  const std::vector<ExtentBall>& balls() const { return balls_; }

 private:
  /// The places that a link's frame may reach: a sphere or, if no joint moves the link, its present place.
  struct Reach {
    bool moves;
    Sphere frame;
  };

  Vector3 place(std::size_t link) const { return simulation_.link_pose(link).position; }

  std::vector<Vector3> points(std::size_t link) const {
    const scene::LinkDescription& description = simulation_.scene().links[link];
    std::vector<Vector3> out;
    std::vector<BeamPoint> beam;
    if (description.beam) simulation_.beam_points(link, 0, beam);
    for (const BeamPoint& point : beam) out.push_back(point.pose.position);
    if (!description.beam && description.inertial)
      out.push_back(simulation_.link_pose(link) * description.inertial->center_of_mass);
    if (link < more_points_.size())
      for (const Vector3& point : more_points_[link]) out.push_back(simulation_.link_pose(link) * point);
    return out;
  }

  double farthest_point(std::size_t link, const Vector3& from) const {
    double distance = 0;
    for (const Vector3& point : points(link)) distance = std::max(distance, (point - from).norm());
    return distance;
  }

  void add_link(std::size_t link) {
    const Reach reach = reach_of(link);
    const bool stands = is_fixed(simulation_, link);
    if (reach.moves) {
      balls_.push_back({reach.frame.center, reach.frame.radius + farthest_point(link, place(link)), stands});
      return;
    }
    balls_.push_back({reach.frame.center, reach.frame.radius, stands});
    for (const Vector3& point : points(link)) balls_.push_back({point, 0, stands});
  }

  const Reach& reach_of(std::size_t link) {
    const auto known = reaches_.find(link);
    return known != reaches_.end() ? known->second : reaches_.emplace(link, found_reach(link)).first->second;
  }

  Reach found_reach(std::size_t link) {
    using scene::JointKind;
    const Reach stands{false, {place(link), 0}};
    const auto carrier = carriers_.find(link);
    if (carrier == carriers_.end()) return stands;
    const scene::JointDescription& joint = *carrier->second;
    if (joint.kind == JointKind::Floating || joint.kind == JointKind::Planar) return stands;
    const std::size_t parent = links_.at(joint.parent);
    const Reach before = reach_of(parent);
    if (joint.kind == JointKind::Fixed && !before.moves) return stands;
    Reach out{true, {place(link), 0}};
    if (turns_in_place(parent)) {
      const Vector3 axis = simulation_.link_pose(parent).orientation * carriers_.at(parent)->axis;
      out.frame.center = place(parent) + axis.dot(place(link) - place(parent)) * axis;
      out.frame.radius = (place(link) - out.frame.center).norm();
    } else if (before.moves) {
      out.frame = {before.frame.center, before.frame.radius + (place(link) - place(parent)).norm()};
    }
    out.frame.radius += travel(joint, link, parent);
    return out;
  }

  /// Whether the link turns about an axis at rest, so that links on it move on circles.
  bool turns_in_place(std::size_t link) {
    const auto carrier = carriers_.find(link);
    if (carrier == carriers_.end() || reach_of(links_.at(carrier->second->parent)).moves) return false;
    return carrier->second->kind == scene::JointKind::Revolute || carrier->second->kind == scene::JointKind::Continuous;
  }

  /// How far a joint can shift its link from its present place.
  double travel(const scene::JointDescription& joint, std::size_t link, std::size_t parent) const {
    if (joint.kind == scene::JointKind::Slide) return farthest_point(parent, place(link));
    if (joint.kind != scene::JointKind::Prismatic || !joint.limits) return 0;
    const auto coordinate = simulation_.find_coordinate(joint.name);
    const double position = coordinate ? simulation_.position(*coordinate) : 0;
    return std::max({joint.limits->upper - position, position - joint.limits->lower, 0.0});
  }

  const Simulation& simulation_;
  const std::vector<std::vector<Vector3>>& more_points_;
  std::map<std::string, std::size_t> links_;
  std::map<std::size_t, const scene::JointDescription*> carriers_;
  std::map<std::size_t, Reach> reaches_;
  std::vector<ExtentBall> balls_;
};

}  // namespace

SceneExtent extent_around(const std::function<void(const ExtentBallVisitor&)>& visit_balls) {
  const SceneExtent all = enclose(visit_balls, [](const ExtentBall&) { return true; });
  const SceneExtent moving = enclose(visit_balls, [](const ExtentBall& ball) { return !ball.is_fixed; });
  SceneExtent out = all;
  if (moving.radius > kRoundOff * all.radius)
    out = enclose(visit_balls, [&](const ExtentBall& ball) {
      return !ball.is_fixed || (ball.center - moving.center).norm() + ball.radius <= kNear * moving.radius;
    });
  if (!(out.radius > 0)) out = {out.center, 1, Vector3::Ones()};
  return out;
}

bool is_fixed(const Simulation& simulation, std::size_t link) {
  return simulation.is_fixed_to_world(link) && !simulation.is_flexible(link);
}

SceneExtent scene_extent(const Simulation& simulation, const std::vector<std::vector<Vector3>>& more_points) {
  const ReachFinder finder(simulation, more_points);
  std::vector<ExtentBall> balls = finder.balls();
  std::vector<Vector3> line;
  for (std::size_t i = 0; i < simulation.scene().force_elements.size(); ++i) {
    simulation.line_points(i, line);
    for (const Vector3& point : line) balls.push_back({point, 0, false});
  }
  return extent_around([&](const ExtentBallVisitor& visit) {
    for (const ExtentBall& ball : balls) visit(ball);
  });
}

}  // namespace flexarm::pictures
