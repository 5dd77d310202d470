#include "pictures/recorded_arrows.h"

#include <algorithm>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "model/carried_origin.h"
#include "simulation/inside.h"
#include "simulation/observables.h"
#include "simulation/wrenches.h"

namespace flexarm::pictures {
namespace {

std::optional<std::size_t> index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - names.begin()));
}

}  // namespace

RecordedArrows::RecordedArrows(const Simulation& simulation, const RecordedColumns& columns) : columns_(columns) {
  add_efforts(simulation);
  add_reactions(simulation);
  add_contacts(simulation);
}

void RecordedArrows::add_efforts(const Simulation& simulation) {
  bool has_all = true;
  const scene::SceneDescription& scene = simulation.scene();
  for (const auto* joints : {&scene.joints, &scene.loop_joints})
    for (const scene::JointDescription& joint : *joints)
      for (const std::string& suffix : scene::coordinate_suffixes(joint)) {
        const auto coordinate = simulation.find_coordinate(joint.name + suffix);
        if (!coordinate) continue;
        const auto column = columns_.find("joint/" + joint.name + suffix + "/effort");
        has_all = has_all && column;
        if (column) efforts_.push_back({*coordinate, *index_of(simulation.link_names(), joint.child), *column});
      }
  if (!has_all) lacks_.push_back("efforts are not drawn of joints for which the run has no column joint/NAME/effort");
}

void RecordedArrows::add_reactions(const Simulation& simulation) {
  const std::vector<scene::Sensor>& sensors = simulation.scene().sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (!measures_reaction(sensors[i])) continue;
    const std::string prefix = "sensor/" + sensors[i].name + "/";
    if (const auto places = columns_.find_all<6>(prefix, {"fx", "fy", "fz", "mx", "my", "mz"}))
      reactions_.push_back({i, *index_of(simulation.link_names(), sensors[i].link), *places});
    else
      lacks_.push_back(
          fmt::format("the reaction at sensor '{}' is not drawn: the run has no columns {}*", sensors[i].name, prefix));
  }
}

void RecordedArrows::add_contacts(const Simulation& simulation) {
  bool has_all = true;
  for (const TouchingPair& pair : model_of(simulation).touching_pairs) {
    const auto places = columns_.find_all<3>("contact/" + pair.first + "/" + pair.second + "/", {"fx", "fy", "fz"});
    has_all = has_all && places;
    if (!places) continue;
    auto link = index_of(simulation.link_names(), pair.first);
    if (!link) link = index_of(simulation.link_names(), pair.second);
    contacts_.push_back({pair.first, pair.second, link, *places});
  }
  if (!has_all)
    lacks_.push_back(
        "contacts are not drawn of bodies for which the run has no columns contact/FIRST/SECOND/*; it has those of "
        "each <contact> that names both");
}

std::vector<std::string> RecordedArrows::notes() const {
  return lacks_;
}

void RecordedArrows::find(std::size_t row, const RecordedMotion& motion, Arrows& arrows) {
  auto& [efforts, loads, reactions, pushes] = arrows;
  find_efforts(row, motion.moved(), motion.shown(), efforts);
  motion.shown().outside_wrenches(loads);
  find_reactions(row, motion.shown(), reactions);
  find_contacts(row, motion, pushes);
}

/// In the axes of the link that a joint carries, the direction of an effort depends on the joint's own position alone.
void RecordedArrows::find_efforts(std::size_t row, const Simulation& moved, const Simulation& shown,
                                  std::vector<ActingWrench>& out) {
  out.clear();
  if (efforts_.empty()) return;
  effort_wrenches(model_of(moved), state_of(moved), unit_);
  const Vector3 origin = world_origin(model_of(moved), state_of(moved));
  for (const auto& [coordinate, link, column] : efforts_) {
    const double effort = columns_.value(row, column);
    const Pose change = shown.link_pose(link) * moved.link_pose(link).inverse();
    const auto& [position, wrench] = unit_[coordinate];
    out.push_back({change * Vector3(position + origin),
                   {change.orientation * (effort * wrench.force), change.orientation * (effort * wrench.moment)}});
  }
}

void RecordedArrows::find_reactions(std::size_t row, const Simulation& shown, std::vector<ActingWrench>& out) const {
  out.clear();
  for (const auto& [index, link, columns] : reactions_) {
    const scene::Sensor& sensor = shown.scene().sensors[index];
    const bool in_world = scene::traits_of(sensor.kind).in_world;
    const Quaternion axes = in_world ? Quaternion(Quaternion::Identity()) : shown.link_pose(link).orientation;
    const auto vector = [&, &own = columns](std::size_t k) {
      return Vector3(columns_.value(row, own[k]), columns_.value(row, own[k + 1]), columns_.value(row, own[k + 2]));
    };
    const Vector3 place =
        pose_in_world(model_of(shown), state_of(shown), model_of(shown).sensors[index].point).position;
    out.push_back({place, {axes * vector(0), axes * vector(3)}});
  }
}

void RecordedArrows::find_contacts(std::size_t row, const RecordedMotion& motion, std::vector<ActingWrench>& out) {
  out.clear();
  if (contacts_.empty()) return;
  motion.shown().contacts(touching_);
  for (const Contact& contact : contacts_) {
    Vector3 force;
    for (std::size_t k = 0; k < 3; ++k) force[static_cast<Eigen::Index>(k)] = columns_.value(row, contact.columns[k]);
    if (force.allFinite() && !force.isZero(0)) share_out(contact, force, motion, out);
  }
}

/// Where bodies touch follows from their positions and, if these are exact, about how strongly at each point. The sum
/// is that of the row.
void RecordedArrows::share_out(const Contact& contact, const Vector3& force, const RecordedMotion& motion,
                               std::vector<ActingWrench>& out) {
  constexpr double kLargestRest = 0.5;  // of all forces; if more is missing, the forces are not those of the run
  const auto is_of_contact = [&](const ActingContact& point) {
    return point.first == contact.first && point.second == contact.second && point.force.allFinite();
  };
  Vector3 rest = force;
  double strength = 0, depth = 0;
  for (const ActingContact& point : touching_)
    if (is_of_contact(point)) {
      rest -= point.force;
      strength += point.force.norm();
      depth += point.penetration;
    }
  const bool are_known = motion.is_exact() && rest.norm() <= kLargestRest * strength;
  if (depth > 0 && strength > 0) {
    for (const ActingContact& point : touching_) {
      if (!is_of_contact(point) || !(point.penetration > 0)) continue;
      const Vector3 share = are_known ? Vector3(point.force + point.force.norm() / strength * rest)
                                      : Vector3(point.penetration / depth * force);
      out.push_back({point.position, {share, Vector3::Zero()}});
    }
  } else if (contact.link) {
    out.push_back({motion.shown().link_pose(*contact.link).position, {force, Vector3::Zero()}});
  }
}

}  // namespace flexarm::pictures
