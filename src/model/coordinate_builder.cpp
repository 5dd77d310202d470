// Released coordinates, their initial values, and the initial velocity field.
#include <cmath>

#include "flexarm/math/so3.h"
#include "mechanism_builder.h"

namespace flexarm {

double MechanismBuilder::initial_value(const std::string& coordinate, bool velocity) const {
  const auto found = initial_.find(coordinate);
  if (found == initial_.end()) return 0;
  return velocity ? found->second->velocity : found->second->position;
}

Released MechanismBuilder::initial_released(const JointMap& map, const std::vector<std::string>& names) const {
  Released out;
  std::vector<double> values;
  for (const std::string& name : names) {
    double value = initial_value(name, false);
    for (const scene::PrescribedMotion& motion : scene_.motions)
      if (motion.coordinate == name) value = motion.position(0.0);
    values.push_back(value);
  }
  if (map.kind == JointMapKind::Scalar) {
    out.displacement[0] = values[0];
  } else if (map.kind != JointMapKind::Rigid) {
    if (map.kind == JointMapKind::Free) out.displacement = Vector3(values[0], values[1], values[2]);
    const std::size_t n = values.size();
    out.rotation = so3::exp_quaternion(Vector3(values[n - 3], values[n - 2], values[n - 1]));
  }
  return out;
}

void MechanismBuilder::add_coordinates(const scene::JointDescription& joint, const std::vector<std::string>& names) {
  const int map = static_cast<int>(model.joints.size()) - 1;
  const JointMapKind kind = model.joints[map].kind;
  for (std::size_t c = 0; c < names.size(); ++c) {
    Coordinate coordinate;
    coordinate.name = names[c];
    coordinate.joint = map;
    coordinate.component = static_cast<int>(c);
    coordinate.is_angle = kind == JointMapKind::Spherical || (kind == JointMapKind::Free && c >= 3);
    coordinate.damping = joint.damping;
    coordinate.friction = joint.friction;
    coordinate.effort_limit = joint.effort_limit;
    if (joint.limits) coordinate.limit = LimitStop{joint.limits->lower, joint.limits->upper, 0, 0};
    model.coordinates.push_back(coordinate);
  }
}

int MechanismBuilder::coordinate_index(const std::string& name, const std::string& where) const {
  for (std::size_t i = 0; i < model.coordinates.size(); ++i)
    if (model.coordinates[i].name == name) return static_cast<int>(i);
  throw ModelError(where + "there is no joint coordinate '" + name + "'");
}

void MechanismBuilder::connect_coordinates() {
  for (const scene::InitialJoint& initial : scene_.initial_joints)
    coordinate_index(initial.coordinate, at(initial.location, "<initial>"));
  for (const scene::PrescribedMotion& motion : scene_.motions) {
    const std::string where = at(motion.location, "<motion>");
    Coordinate& coordinate = model.coordinates[coordinate_index(motion.coordinate, where)];
    if (coordinate.is_angle)
      throw ModelError(where + "a component of a free rotation cannot be prescribed ('" + motion.coordinate + "')");
    coordinate.motion = add_history(motion.position);
    coordinate.limit.reset();
  }
  for (const scene::JointEffort& effort : scene_.efforts)
    model.coordinates[coordinate_index(effort.coordinate, at(effort.location, "<effort>"))].effort =
        add_history(effort.history);

  // Chains of mimics are followed to the coordinate that none of them mimics.
  for (const JointRecord& record : records_) {
    if (!record.joint->mimic) continue;
    const std::string where = at(record.joint->location, "<mimic> of joint '" + record.joint->name + "'");
    Coordinate& coordinate = model.coordinates[coordinate_index(record.joint->name, where)];
    const scene::Mimic* mimic = &*record.joint->mimic;
    double multiplier = 1, offset = 0;
    std::string master;
    for (std::size_t depth = 0;; ++depth) {
      if (depth > records_.size()) throw ModelError(where + "the mimicked joints form a circle");
      offset += multiplier * mimic->offset;
      multiplier *= mimic->multiplier;
      master = mimic->joint;
      const scene::Mimic* next = nullptr;
      for (const JointRecord& other : records_)
        if (other.joint->name == master && other.joint->mimic) next = &*other.joint->mimic;
      if (!next) break;
      mimic = next;
    }
    coordinate.mimicked = coordinate_index(master, where);
    coordinate.mimic_multiplier = multiplier;
    coordinate.mimic_offset = offset;
    coordinate.limit.reset();
    if (model.joints[model.coordinates[coordinate.mimicked].joint].kind != JointMapKind::Scalar)
      throw ModelError(where + "only a joint with one coordinate can be mimicked");
    const Coordinate& base = model.coordinates[coordinate.mimicked];
    model.initial_released[coordinate.joint].displacement[0] =
        multiplier * model.initial_released[base.joint].displacement[0] + offset;
  }
  update_initial_poses();
}

void MechanismBuilder::update_initial_poses() {
  // Mimicking coordinates got their values after the nodes had been placed.
  std::vector<Pose> before;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) before.push_back(pose_of(static_cast<int>(i)));
  std::vector<int> joint_of(model.nodes.size(), -1);
  for (std::size_t j = 0; j < model.joints.size(); ++j) joint_of[model.joints[j].slave] = static_cast<int>(j);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (joint_of[i] >= 0) {
      const JointMap& joint = model.joints[joint_of[i]];
      const NodePose world;
      model.nodes[i] =
          slave_pose(joint, joint.master < 0 ? world : model.nodes[joint.master], model.initial_released[joint_of[i]]);
    } else {
      const int parent = node_parents[i];
      const Pose pose = pose_of(parent) * (before[parent].inverse() * before[i]);
      model.nodes[i].position = pose.position;
      model.nodes[i].orientation = pose.orientation;
      model.nodes[i].rotation = pose.orientation.toRotationMatrix();
    }
  }
}

// ---------------------------------------------------------------- initial velocities

Vector6 MechanismBuilder::field_velocity(const scene::InitialLink& field, int link, const Vector3& point) const {
  const Attachment& frame = model.links[link].frame;
  const Vector3 origin = (pose_of(frame.node) * frame.offset).position;
  Vector6 velocity;
  velocity << field.linear + field.angular.cross(point - origin), field.angular;
  return velocity;
}

ReleasedVector MechanismBuilder::field_rates(const JointRecord& record, const Vector6& master, const Vector6& target) const {
  const JointMap& last = model.joints[record.first_map + record.map_count - 1];
  const Vector3 point = model.nodes[last.slave].position;
  ReleasedColumns columns(6, 0);
  const NodePose world;
  for (int k = 0; k < record.map_count; ++k) {
    const JointMap& map = model.joints[record.first_map + k];
    FoldMaps maps;
    variational_maps(map, map.master < 0 ? world : model.nodes[map.master],
                     model.initial_released[record.first_map + k], Vector6::Zero(), maps);
    for (int c = 0; c < maps.right.cols(); ++c) {
      Vector6 column = maps.right.col(c);
      column.head<3>() += Vector3(column.tail<3>()).cross(point - model.nodes[map.slave].position);
      columns.conservativeResize(6, columns.cols() + 1);
      columns.col(columns.cols() - 1) = column;
    }
  }
  const JointMap& first = model.joints[record.first_map];
  const Vector3 master_point = first.master < 0 ? Vector3::Zero() : model.nodes[first.master].position;
  Vector6 relative = target - master;
  relative.head<3>() -= Vector3(master.tail<3>()).cross(point - master_point);
  return Eigen::MatrixXd(columns).colPivHouseholderQr().solve(relative);
}

void MechanismBuilder::set_initial_velocities() {
  std::vector<Vector6>& velocity = model.initial_velocity;
  velocity.assign(model.nodes.size(), Vector6::Zero());
  std::map<int, const scene::InitialLink*> fields;
  for (const scene::InitialLink& field : scene_.initial_links) fields[link_index(field.link)] = &field;

  const auto velocity_of = [&](int node) { return node < 0 ? Vector6(Vector6::Zero()) : velocity[node]; };
  const auto follow = [&](int j, const ReleasedVector& rates) {
    const JointMap& map = model.joints[j];
    const NodePose world;
    velocity[map.slave] = slave_velocity(map, map.master < 0 ? world : model.nodes[map.master],
                                         model.initial_released[j], velocity_of(map.master), rates);
  };
  std::vector<int> joint_of(model.nodes.size(), -1);
  for (std::size_t j = 0; j < model.joints.size(); ++j) joint_of[model.joints[j].slave] = static_cast<int>(j);

  const auto set_beam = [&](int link) {
    const LinkMesh& mesh = *meshes[link];
    const int base = mesh.first_node;
    if (joint_of[base] >= 0 && model.joints[joint_of[base]].kind == JointMapKind::Rigid)
      follow(joint_of[base], ReleasedVector(0));
    for (std::size_t i = 1; i < mesh.mesh.nodes.size(); ++i) {
      const int node = base + static_cast<int>(i);
      const Vector3& position = model.nodes[node].position;
      if (joint_of[node] >= 0) {
        follow(joint_of[node], ReleasedVector(0));
      } else if (fields.count(link)) {
        velocity[node] = field_velocity(*fields[link], link, position);
      } else {
        const Vector3 spin = velocity[base].tail<3>();
        velocity[node] << velocity[base].head<3>() + spin.cross(position - model.nodes[base].position), spin;
      }
    }
  };
  std::map<int, double> field_rate;  // by coordinate: what a field gave, for the joints further out that mimic it
  const int root = link_index(scene_.root_link);
  if (meshes[root]) set_beam(root);
  for (const JointRecord& record : records_) {
    const int child = link_index(record.joint->child);
    if (record.map_count > 0) {
      const JointMap& first = model.joints[record.first_map];
      const JointMap& last = model.joints[record.first_map + record.map_count - 1];
      ReleasedVector rates(0);
      bool given = false;
      for (const std::string& suffix : scene::coordinate_suffixes(record.joint->kind)) {
        const std::string name = record.joint->name + suffix;
        const Coordinate& coordinate = model.coordinates[coordinate_index(name, "")];
        rates.conservativeResize(rates.size() + 1);
        double& rate = rates[rates.size() - 1];
        given = given || initial_.count(name);
        rate = initial_value(name, true);
        if (coordinate.motion >= 0) rate = model.histories[coordinate.motion].derivative(0.0), given = true;
        if (coordinate.mimicked >= 0) {
          const Coordinate& base = model.coordinates[coordinate.mimicked];
          const auto from_field = field_rate.find(coordinate.mimicked);
          if (base.motion >= 0)
            rate = model.histories[base.motion].derivative(0.0);
          else
            rate = from_field != field_rate.end() ? from_field->second : initial_value(base.name, true);
          rate *= coordinate.mimic_multiplier;
          given = true;
        }
      }
      if (fields.count(child) && !given) {
        rates = field_rates(record, velocity_of(first.master),
                            field_velocity(*fields[child], child, model.nodes[last.slave].position));
        for (int c = 0; c < rates.size(); ++c) field_rate[model.first_coordinate[record.first_map] + c] = rates[c];
      }
      for (int k = 0, used = 0; k < record.map_count; ++k) {
        const int count = released_count(model.joints[record.first_map + k].kind);
        follow(record.first_map + k, ReleasedVector(rates.segment(used, count)));
        used += count;
      }
    }
    if (meshes[child]) {
      set_beam(child);
    } else if (fields.count(child) && model.links[child].frame.node >= 0) {
      check_field(*fields[child], child);
    }
  }
  for (std::size_t i = 0; i < model.nodes.size(); ++i)  // centres of mass
    if (joint_of[i] >= 0 && model.joints[joint_of[i]].kind == JointMapKind::Rigid) follow(joint_of[i], ReleasedVector(0));
}

void MechanismBuilder::check_field(const scene::InitialLink& field, int link) const {
  const int node = model.links[link].frame.node;
  const Vector6 asked = field_velocity(field, link, model.nodes[node].position);
  const double error = (asked - model.initial_velocity[node]).norm();
  if (error > 1e-9 * (1 + asked.norm()))
    throw ModelError(at(field.location, "<initial>") + "the joints of link '" + field.link +
                     "' do not allow this velocity");
}

}  // namespace flexarm
