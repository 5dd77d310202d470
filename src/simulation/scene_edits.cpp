#include "simulation/scene_edits.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "math/so3.h"

namespace flexarm::scene {
namespace {

template <class Things, class Predicate>
void drop_if(Things& things, const Predicate& goes) {
  things.erase(std::remove_if(things.begin(), things.end(), goes), things.end());
}

std::set<std::string> coordinates_of(const JointDescription& joint) {
  std::set<std::string> names;
  for (const std::string& suffix : coordinate_suffixes(joint)) names.insert(joint.name + suffix);
  return names;
}

template <class Things>
void append(Things& things, const Things& others) {
  things.insert(things.end(), others.begin(), others.end());
}

const std::string& name_of(const std::shared_ptr<const ForceElementDescription>& element) {
  return element->name;
}
template <class Thing>
const std::string& name_of(const Thing& thing) {
  return thing.name;
}

/// @throws std::invalid_argument if a name is in both lists
template <class Things>
void require_other_names(const Things& things, const Things& others, const char* what) {
  std::set<std::string> names;
  for (const auto& thing : things) names.insert(name_of(thing));
  for (const auto& other : others)
    if (const std::string& name = name_of(other); !name.empty() && names.count(name) > 0)
      throw std::invalid_argument(fmt::format(
          "there is a {} '{}' already: give the names of the model a prefix, or take that one away first", what, name));
}

}  // namespace

const JointDescription* joint_above(const SceneDescription& scene, const std::string& link) {
  const auto found = std::find_if(scene.joints.begin(), scene.joints.end(),
                                  [&](const JointDescription& joint) { return joint.child == link; });
  return found == scene.joints.end() ? nullptr : &*found;
}

JointDescription* joint_above(SceneDescription& scene, const std::string& link) {
  return const_cast<JointDescription*>(joint_above(std::as_const(scene), link));
}

std::set<std::string> branch_of(const SceneDescription& scene, const std::string& link) {
  std::set<std::string> branch{link};
  for (std::size_t size = 0; size != branch.size();) {
    size = branch.size();
    for (const JointDescription& joint : scene.joints)
      if (branch.count(joint.parent) > 0) branch.insert(joint.child);
  }
  return branch;
}

std::optional<std::string> what_drives(const SceneDescription& scene, const JointDescription& joint) {
  const std::set<std::string> names = coordinates_of(joint);
  const auto drives = [&](const auto& things) {
    return std::any_of(things.begin(), things.end(),
                       [&](const auto& thing) { return names.count(thing.coordinate) > 0; });
  };
  if (drives(scene.motions)) return "motion";
  if (drives(scene.efforts)) return "effort";
  if (drives(scene.servos)) return "servo";
  if (drives(scene.drives)) return "drive";
  if (drives(scene.springs)) return "spring";
  return std::nullopt;
}

void forget_start(SceneDescription& scene, const JointDescription& joint) {
  const std::set<std::string> names = coordinates_of(joint);
  drop_if(scene.initial_joints, [&](const InitialJoint& initial) { return names.count(initial.coordinate) > 0; });
  drop_if(scene.initial_links, [&](const InitialLink& initial) { return initial.link == joint.child; });
}

void let_float(SceneDescription& scene, JointDescription& joint, const LinkStart& start) {
  joint.kind = JointKind::Floating;
  joint.parent = scene.root_link;
  joint.origin = joint.child_origin = Pose();
  joint.limits.reset();
  forget_start(scene, joint);
  const Vector3 turn = so3::log(start.pose.orientation);
  const std::vector<std::string>& suffixes = coordinate_suffixes(joint);
  for (int k = 0; k < 6; ++k)
    scene.initial_joints.push_back(
        {joint.name + suffixes[k], k < 3 ? start.pose.position[k] : turn[k - 3], 0, joint.location});
  scene.initial_links.push_back({joint.child, start.linear, start.angular, joint.location});
}

void keep_border(SceneDescription& scene, const std::string& link, const Vector3& place) {
  const auto found = std::find_if(scene.links.begin(), scene.links.end(),
                                  [&](const LinkDescription& each) { return each.name == link; });
  if (found == scene.links.end() || !found->beam || found->beam->elements == 0) return;
  PointLoad nothing;  // elements have borders at places of loads
  nothing.link = link;
  nothing.at = place;
  nothing.history = TimeFunction::parse("0");
  nothing.location = found->location;
  const bool is_there = std::any_of(scene.loads.begin(), scene.loads.end(),
                                    [&](const PointLoad& load) { return load.link == link && load.at == place; });
  if (!is_there) scene.loads.push_back(nothing);
}

void take_away(SceneDescription& scene, const std::string& link) {
  std::set<std::string> links = branch_of(scene, link);
  for (const JointDescription& pin : scene.loop_joints)  // a cylinder goes with either of its ends
    if (pin.is_hidden && links.count(pin.child) > 0)
      links.merge(branch_of(scene, joint_above(std::as_const(scene), pin.parent)->parent));
  const auto goes = [&](const std::string& name) { return links.count(name) > 0; };
  const auto is_at_gone = [&](const std::vector<LinkPoint>& points) {
    return std::any_of(points.begin(), points.end(), [&](const LinkPoint& point) { return goes(point.link); });
  };
  for (const auto& element : scene.force_elements) {  // a line takes its winches along
    const std::vector<LinkPoint> points = element->points();
    if (!is_at_gone(points)) continue;
    for (const LinkPoint& point : points)
      if (point.attribute == kReel) links.insert(point.link);
  }
  const auto is_gone = [&](const JointDescription& joint) { return goes(joint.child) || goes(joint.parent); };
  std::set<std::string> joints, coordinates;
  for (const auto* list : {&scene.joints, &scene.loop_joints})
    for (const JointDescription& joint : *list) {
      if (!is_gone(joint)) continue;
      joints.insert(joint.name);
      coordinates.merge(coordinates_of(joint));
    }
  for (const auto* list : {&scene.joints, &scene.loop_joints})
    for (const JointDescription& joint : *list)
      if (!is_gone(joint) && joint.mimic && coordinates.count(joint.mimic->joint) > 0)
        throw std::invalid_argument(
            fmt::format("joint '{}' follows joint '{}', which would go", joint.name, joint.mimic->joint));
  if (const JointDescription* above = joint_above(scene, link)) {
    const std::string parent = above->parent;
    const Vector3 place = above->origin.position;
    keep_border(scene, parent, place);
  }
  drop_if(scene.joints, is_gone);
  drop_if(scene.loop_joints, is_gone);
  drop_if(scene.clearances, [&](const ClearanceDescription& clearance) { return is_gone(clearance.joint); });
  drop_if(scene.links, [&](const LinkDescription& each) { return goes(each.name); });
  const auto of_coordinate = [&](const auto& thing) { return coordinates.count(thing.coordinate) > 0; };
  drop_if(scene.springs, of_coordinate);
  drop_if(scene.drives, of_coordinate);
  drop_if(scene.servos, of_coordinate);
  drop_if(scene.initial_joints, of_coordinate);
  drop_if(scene.motions, of_coordinate);
  drop_if(scene.efforts, of_coordinate);
  const auto of_link = [&](const auto& thing) { return goes(thing.link); };
  drop_if(scene.initial_links, of_link);
  drop_if(scene.loads, of_link);
  drop_if(scene.distributed_loads, of_link);
  drop_if(scene.probes, of_link);
  for (Sensor& sensor : scene.sensors) {
    const bool is_of_group = !sensor.group.empty();
    drop_if(sensor.group, goes);
    if (is_of_group && sensor.group.empty()) sensor.link = link;  // so that the sensor is removed, too
  }
  drop_if(scene.force_elements, [&](const auto& element) { return is_at_gone(element->points()); });
  drop_if(scene.sensors, [&](const Sensor& sensor) {
    const bool is_of_gone_tendon = traits_of(sensor.kind).place == SensedPlace::Tendon &&
                                   find_force_element(scene, "tendon", sensor.tendon) == scene.force_elements.size();
    return is_of_gone_tendon || goes(sensor.link) || joints.count(sensor.joint) > 0;
  });
  const auto of_pair = [&](const ContactPair& pair) { return goes(pair.first) || goes(pair.second); };
  drop_if(scene.contacts, of_pair);
  drop_if(scene.no_contacts, of_pair);
  for (const std::string& name : links) scene.surfaces.erase(name);
}

void rename(SceneDescription& scene, const std::string& prefix) {
  if (prefix.empty()) return;
  std::set<std::string> grounds;
  for (const GroundDescription& ground : scene.grounds) grounds.insert(ground.name);
  const auto put = [&](std::string& name) {
    if (!name.empty() && name != scene.root_link && name != kAllBodies && grounds.count(name) == 0)
      name = prefix + name;
  };
  const auto put_joint = [&](JointDescription& joint) {
    joint.name = prefix + joint.name;
    put(joint.parent), put(joint.child);
    if (joint.mimic) joint.mimic->joint = prefix + joint.mimic->joint;
  };
  for (JointDescription& joint : scene.joints) put_joint(joint);
  for (JointDescription& joint : scene.loop_joints) put_joint(joint);
  for (ClearanceDescription& clearance : scene.clearances) put_joint(clearance.joint);
  for (CylinderDescription& cylinder : scene.cylinders) {
    cylinder.name = prefix + cylinder.name;
    if (!cylinder.pump.empty()) cylinder.pump = prefix + cylinder.pump;
    put(cylinder.from), put(cylinder.to);
  }
  for (auto& element : scene.force_elements) {
    auto renamed = with_link_names(*element, put);
    if (!renamed->name.empty()) renamed->name = prefix + renamed->name;
    element = std::move(renamed);
  }
  const auto put_coordinates = [&](auto& things) {
    for (auto& thing : things) thing.coordinate = prefix + thing.coordinate;
  };
  put_coordinates(scene.springs), put_coordinates(scene.drives), put_coordinates(scene.servos);
  put_coordinates(scene.initial_joints), put_coordinates(scene.motions), put_coordinates(scene.efforts);
  const auto put_links = [&](auto& things) {
    for (auto& thing : things) put(thing.link);
  };
  put_links(scene.initial_links), put_links(scene.loads), put_links(scene.distributed_loads);
  put_links(scene.probes), put_links(scene.sensors);
  for (Probe& probe : scene.probes) probe.name = prefix + probe.name;
  for (Sensor& sensor : scene.sensors) {
    sensor.name = prefix + sensor.name;
    if (!sensor.joint.empty()) sensor.joint = prefix + sensor.joint;
    if (!sensor.tendon.empty()) sensor.tendon = prefix + sensor.tendon;
    for (std::string& member : sensor.group) put(member);
  }
  for (ContactDescription& contact : scene.contacts) put(contact.first), put(contact.second);
  for (ContactPair& pair : scene.no_contacts) put(pair.first), put(pair.second);
  std::map<std::string, SurfaceHints> surfaces;
  for (const auto& [name, hints] : scene.surfaces)
    surfaces.emplace(name == scene.root_link ? name : prefix + name, hints);
  scene.surfaces = std::move(surfaces);
  for (LinkDescription& link : scene.links) put(link.name);
}

void merge(SceneDescription& scene, const SceneDescription& other) {
  std::vector<LinkDescription> links = other.links;
  drop_if(links, [&](const LinkDescription& link) { return link.name == scene.root_link; });
  require_other_names(scene.links, links, "link");
  std::vector<JointDescription> joints = scene.joints;
  append(joints, scene.loop_joints);
  require_other_names(joints, other.joints, "joint");
  require_other_names(joints, other.loop_joints, "joint");
  require_other_names(scene.probes, other.probes, "probe");
  require_other_names(scene.sensors, other.sensors, "sensor");
  require_other_names(scene.grounds, other.grounds, "ground");
  require_other_names(scene.force_elements, other.force_elements, "spring, tendon or hydraulic cylinder");
  append(scene.links, links);
  append(scene.joints, other.joints);
  append(scene.loop_joints, other.loop_joints);
  append(scene.cylinders, other.cylinders);
  append(scene.springs, other.springs);
  append(scene.drives, other.drives);
  append(scene.servos, other.servos);
  append(scene.initial_joints, other.initial_joints);
  append(scene.initial_links, other.initial_links);
  append(scene.loads, other.loads);
  append(scene.distributed_loads, other.distributed_loads);
  append(scene.motions, other.motions);
  append(scene.efforts, other.efforts);
  append(scene.probes, other.probes);
  append(scene.sensors, other.sensors);
  append(scene.force_elements, other.force_elements);
  append(scene.grounds, other.grounds);
  for (const ContactDescription& contact : other.contacts)
    if (contact.first != kAllBodies || contact.second != kAllBodies) scene.contacts.push_back(contact);
  append(scene.no_contacts, other.no_contacts);
  append(scene.clearances, other.clearances);
  scene.surfaces.insert(other.surfaces.begin(), other.surfaces.end());
}

}  // namespace flexarm::scene
