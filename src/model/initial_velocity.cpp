#include "initial_velocity.h"

#include "closure_builder.h"

namespace flexarm {
namespace {

/// Initial velocities of a loop's joints agree if what is left is this part of the largest.
constexpr double kAgrees = 1e-9;

}  // namespace

InitialVelocity::InitialVelocity(const scene::SceneDescription& scene, MechanismBuilder& mechanism)
    : scene_(scene), mechanism_(mechanism), model_(mechanism.model), joint_of_(model_.nodes.size(), -1) {
  for (const scene::InitialLink& field : scene.initial_links) fields_[mechanism.link_index(field.link)] = &field;
  for (const scene::InitialJoint& initial : scene.initial_joints)
    if (initial.gives_velocity || initial.velocity != 0) initial_rates_[initial.coordinate] = initial.velocity;
  for (std::size_t j = 0; j < model_.joints.size(); ++j) joint_of_[model_.joints[j].slave] = static_cast<int>(j);
  for (const JointRecord& record : mechanism.records())
    if (record.closed_node >= 0) joint_of_[record.closed_node] = -1;
  for (const JointMap& joint : model_.joints) rates_.push_back(ReleasedVector::Zero(released_count(joint.kind)));
  model_.initial_velocity.assign(model_.nodes.size(), Vector6::Zero());
}

void InitialVelocity::set() {
  const int root = mechanism_.link_index(scene_.root_link);
  if (mechanism_.meshes[root]) set_beam(root);
  for (const JointRecord& record : mechanism_.records()) {
    if (record.closed_node >= 0) break;  // they come last
    const int child = mechanism_.link_index(record.joint->child);
    set_joint(record);
    if (mechanism_.meshes[child])
      set_beam(child);
    else if (fields_.count(child) && model_.links[child].frame.node >= 0)
      check_field(*fields_[child], child);
  }
  for (const int j : joint_of_)  // centres of mass
    if (j >= 0 && model_.joints[j].kind == JointMapKind::Rigid) follow(j, ReleasedVector(0));
  close_loops();
  if (!model_.closures.empty()) satisfy_closures();
}

bool InitialVelocity::is_given(const Coordinate& coordinate) const {
  return coordinate.motion >= 0 || initial_rates_.count(coordinate.name) > 0;
}

void InitialVelocity::satisfy_closures() {
  const DegreesOfFreedom dof(model_);
  const Eigen::VectorXd scales = scalar_scales(model_, dof);
  const ConstraintRows jacobian =
      constraint_scales(model_).cwiseInverse().asDiagonal() * closure_jacobian(model_, dof) * scales.asDiagonal();
  Eigen::VectorXd velocity = Eigen::VectorXd::Zero(dof.scalar_count);
  for (int i = 0; i < dof.node_count; ++i) velocity.segment<6>(dof.first[i]) = model_.initial_velocity[i];
  for (std::size_t j = 0; j < rates_.size(); ++j)
    velocity.segment(dof.first[dof.variable_of_joint(static_cast<int>(j))], rates_[j].size()) = rates_[j];
  velocity.array() /= scales.array();
  std::vector<bool> given(static_cast<std::size_t>(dof.scalar_count), false);
  for (const Coordinate& coordinate : model_.coordinates)
    if (is_given(coordinate)) given[dof.first[dof.variable_of_joint(coordinate.joint)] + coordinate.component] = true;
  ConstraintRows adjustable = jacobian;
  adjustable.prune([&](Eigen::Index, Eigen::Index column, double) { return !given[column]; });
  const Eigen::VectorXd opening = jacobian * velocity;
  const double speed = velocity.lpNorm<Eigen::Infinity>();
  if (opening.lpNorm<Eigen::Infinity>() <= kAgrees * speed) return;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(dof.scalar_count);
  for (const ConstraintGroup& group : independent_groups(adjustable)) {
    if (group.columns.empty()) continue;
    const auto size = static_cast<Eigen::Index>(group.rows.size());
    Eigen::VectorXd closing(size);
    for (Eigen::Index i = 0; i < size; ++i) closing[i] = -opening[group.rows[i]];
    const Eigen::VectorXd part = group.block.completeOrthogonalDecomposition().solve(closing);
    for (Eigen::Index k = 0; k < part.size(); ++k) change[group.columns[k]] = part[k];
  }
  if ((adjustable * change + opening).lpNorm<Eigen::Infinity>() > kAgrees * speed)
    throw ModelError(scene_.file + ": the initial velocities of the joints do not agree with the loop that '" +
                     model_.closures.front().name + "' closes: give fewer of them");
  velocity = scales.cwiseProduct(velocity + change);
  for (int i = 0; i < dof.node_count; ++i)
    if (dof.slave_joint[i] < 0) model_.initial_velocity[i] = velocity.segment<6>(dof.first[i]);
  for (std::size_t j = 0; j < rates_.size(); ++j)
    rates_[j] = velocity.segment(dof.first[dof.variable_of_joint(static_cast<int>(j))], rates_[j].size()).eval();
  for (const DegreesOfFreedom::Mimic& mimic : dof.mimics) {
    const Coordinate& following = model_.coordinates[mimic.coordinate];
    rates_[following.joint][0] = mimic_ratio(following) * rates_[model_.coordinates[following.mimicked].joint][0];
  }
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) follow(j, ReleasedVector(rates_[j]));
}

void InitialVelocity::close_loops() {
  std::map<int, const JointRecord*> loops;  // by first map
  for (const JointRecord& record : mechanism_.records())
    if (record.closed_node >= 0) loops[record.first_map] = &record;
  if (loops.empty()) return;
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
    if (const auto loop = loops.find(j); loop != loops.end()) set_loop(*loop->second);
    follow(j, rates_[j]);
  }
}

void InitialVelocity::set_loop(const JointRecord& record) {
  const Vector6 held = model_.initial_velocity[record.closed_node];
  ReleasedVector rates;
  if (!given_rates(record, rates) && rates.size() > 0) rates = field_rates(record, held);
  for (int k = 0, used = 0; k < record.map_count; ++k) {
    ReleasedVector& own = rates_[record.first_map + k];
    own = rates.segment(used, own.size()).eval();
    used += static_cast<int>(own.size());
  }
}

void InitialVelocity::follow(int j, const ReleasedVector& rates) {
  rates_[j] = rates;
  const SlaveVelocity slave =
      slave_velocity(model_, j, model_.nodes, model_.initial_released[j], model_.initial_velocity);
  model_.initial_velocity[model_.joints[j].slave] = slave.carried + slave.columns * rates;
}

void InitialVelocity::set_joint(const JointRecord& record) {
  if (record.map_count == 0) return;
  const int child = mechanism_.link_index(record.joint->child);
  const JointMap& last = model_.joints[record.first_map + record.map_count - 1];
  ReleasedVector rates;
  if (!given_rates(record, rates) && fields_.count(child)) {
    rates = field_rates(record, field_velocity(*fields_[child], child, model_.nodes[last.slave].position));
    for (int c = 0; c < rates.size(); ++c) field_rates_[model_.first_coordinate[record.first_map] + c] = rates[c];
  }
  for (int k = 0, used = 0; k < record.map_count; ++k) {
    const int count = released_count(model_.joints[record.first_map + k].kind);
    follow(record.first_map + k, ReleasedVector(rates.segment(used, count)));
    used += count;
  }
}

void InitialVelocity::set_beam(int link) {
  const MechanismBuilder::LinkMesh& mesh = *mechanism_.meshes[link];
  const int base = mesh.first_node;
  if (joint_of_[base] >= 0 && model_.joints[joint_of_[base]].kind == JointMapKind::Rigid)
    follow(joint_of_[base], ReleasedVector(0));
  for (std::size_t i = 1; i < mesh.mesh.nodes.size(); ++i) {
    const int node = base + static_cast<int>(i);
    const Vector3& position = model_.nodes[node].position;
    Vector6& velocity = model_.initial_velocity[node];
    if (joint_of_[node] >= 0) {
      follow(joint_of_[node], ReleasedVector(0));
    } else if (fields_.count(link)) {
      velocity = field_velocity(*fields_[link], link, position);
    } else {
      const Vector6& root = model_.initial_velocity[base];
      const Vector3 spin = root.tail<3>();
      velocity << root.head<3>() + spin.cross(position - model_.nodes[base].position), spin;
    }
  }
}

double InitialVelocity::given_rate(const Coordinate& coordinate, bool& is_given) const {
  if (coordinate.mimicked >= 0) {
    const auto from_field = field_rates_.find(coordinate.mimicked);
    if (from_field != field_rates_.end()) {
      is_given = true;
      return mimic_ratio(coordinate) * from_field->second;
    }
    // What follows a coordinate of another joint is given by that, whether it moves or not.
    const bool is_own = coordinate.is_coupled;
    bool is_master_given = false;
    const double rate = mimic_ratio(coordinate) * given_rate(model_.coordinates[coordinate.mimicked], is_master_given);
    is_given = is_given || is_master_given || !is_own;
    return rate;
  }
  if (coordinate.motion >= 0) {
    is_given = true;
    return model_.histories[coordinate.motion].derivative(0.0);
  }
  const auto found = initial_rates_.find(coordinate.name);
  if (found == initial_rates_.end()) return 0;
  is_given = true;
  return found->second;
}

bool InitialVelocity::given_rates(const JointRecord& record, ReleasedVector& rates) const {
  bool is_given = false;
  rates.resize(static_cast<Eigen::Index>(scene::coordinate_suffixes(*record.joint).size()));
  Eigen::Index used = 0;
  for (int j = record.first_map; j < record.first_map + record.map_count; ++j)
    for (int c = 0; c < released_count(model_.joints[j].kind); ++c)
      rates[used++] = given_rate(model_.coordinates[model_.first_coordinate[j] + c], is_given);
  return is_given;
}

double InitialVelocity::mimic_ratio(const Coordinate& coordinate) const {
  const int master = model_.coordinates[coordinate.mimicked].joint;
  return coordinate.mimic.derivative(model_.initial_released[master].displacement[0]);
}

ReleasedVector InitialVelocity::field_rates(const JointRecord& record, const Vector6& target) {
  const int last = model_.joints[record.first_map + record.map_count - 1].slave;
  const Vector3 point = model_.nodes[last].position;
  ReleasedColumns columns(6, 0);
  for (int k = 0; k < record.map_count; ++k) {
    const int j = record.first_map + k;
    const SlaveVelocity slave =
        slave_velocity(model_, j, model_.nodes, model_.initial_released[j], model_.initial_velocity);
    model_.initial_velocity[model_.joints[j].slave] = slave.carried;  // carried along, at rest in the joint
    for (int c = 0; c < slave.columns.cols(); ++c) {
      Vector6 column = slave.columns.col(c);
      column.head<3>() += Vector3(column.tail<3>()).cross(point - model_.nodes[model_.joints[j].slave].position);
      columns.conservativeResize(6, columns.cols() + 1);
      columns.col(columns.cols() - 1) = column;
    }
  }
  const Vector6 relative = target - model_.initial_velocity[last];
  // The travel of a slide that follows an angle, which comes right after it, is a part of the angle's motion.
  const Coordinate& first = model_.coordinates[model_.first_coordinate[record.first_map]];
  if (!first.is_coupled) return Eigen::MatrixXd(columns).colPivHouseholderQr().solve(relative);
  const double ratio = mimic_ratio(first);
  const Vector6 motion = columns.col(1) + ratio * columns.col(0);
  const double rate = motion.dot(relative) / motion.squaredNorm();
  ReleasedVector rates(2);
  rates << ratio * rate, rate;
  return rates;
}

Vector6 InitialVelocity::field_velocity(const scene::InitialLink& field, int link, const Vector3& point) const {
  const Attachment& frame = model_.links[link].frame;
  const Vector3 origin = (mechanism_.pose_of(frame.node) * frame.offset).position;
  Vector6 velocity;
  velocity << field.linear + field.angular.cross(point - origin), field.angular;
  return velocity;
}

void InitialVelocity::check_field(const scene::InitialLink& field, int link) const {
  const int node = model_.links[link].frame.node;
  const Vector6 asked = field_velocity(field, link, model_.nodes[node].position);
  const double error = (asked - model_.initial_velocity[node]).norm();
  if (error > 1e-9 * (1 + asked.norm()))
    throw ModelError(MechanismBuilder::at(field.location, "<initial>") + "the joints of link '" + field.link +
                     "' do not allow this velocity");
}

}  // namespace flexarm
