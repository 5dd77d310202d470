#include "building/passes.h"

#include <map>
#include <string>

#include "building/model_builder.h"
#include "joints/kinematics.h"
#include "math/least_squares.h"

namespace flexarm {
namespace {

/// Largest rate at which the initial velocities of joints may violate constraints with multipliers, relative to the
/// largest velocity. Implied constraints follow from these by the rule of rank, and may open by as much as that.
constexpr double kAgrees = 1e-9;

/// The smallest change of scaled velocities by which constraints open no more, if there is one. `jacobian`: with the
/// columns of what may change. `opening`: the rate of each constraint.
Eigen::VectorXd closing_velocity(const ConstraintRows& jacobian, const Eigen::VectorXd& opening) {
  Eigen::VectorXd change = Eigen::VectorXd::Zero(jacobian.cols());
  for (const ConstraintGroup& group : independent_groups(jacobian)) {
    if (group.columns.empty()) continue;
    const auto size = static_cast<Eigen::Index>(group.rows.size());
    Eigen::VectorXd closing(size);
    for (Eigen::Index i = 0; i < size; ++i) closing[i] = -opening[group.rows[i]];
    const Eigen::VectorXd part = smallest_least_squares(group.block, closing, kIndependent);
    for (Eigen::Index k = 0; k < part.size(); ++k) change[group.columns[k]] = part[k];
  }
  return change;
}

class InitialVelocity {
 public:
  InitialVelocity(const ScenePlan& plan, const Mechanism& mechanism);
  std::vector<Vector6> field();

 private:
  void set_joint(const JointChain& chain);
  void set_beam(int link);
  /// Sets the velocity of the node that a link may have of its own even if its joint releases nothing: the first node
  /// of a beam, or the node of a rigid link whose reaction a sensor measures.
  void follow_fixed(int link);
  /// Sets the rates of a joint that closes a loop: those that the scene gives, or those that change its slave's
  /// velocity least.
  void set_loop(const JointChain& chain);
  /// Makes every slave follow its master once more, including the slaves of joints that close loops.
  void close_loops();
  /// Changes the rates that the scene does not give, by the smallest amount that keeps loops of rigid links closed.
  void satisfy_closures();
  bool is_given(const Coordinate& coordinate) const;
  /// Sets the velocity of a joint's slave from its master's.
  void follow(int joint, const ReleasedVector& rates);
  /// Rates that the scene gives or implies (by a motion or a mimic). Returns false if none is given.
  bool given_rates(const JointChain& chain, ReleasedVector& rates) const;
  double given_rate(const Coordinate& coordinate, bool& is_given) const;
  /// The rates with which the joint's moved frame has the velocity `target`, by least squares.
  ReleasedVector field_rates(const JointChain& chain, const Vector6& target);
  Vector6 field_velocity(const scene::InitialLink& field, int link, const Vector3& point) const;
  void check_field(const scene::InitialLink& field, int link) const;

  const ScenePlan& plan_;
  const Mechanism& mechanism_;
  const Model& model_;
  std::map<int, const scene::InitialLink*> fields_;  // by link
  std::map<std::string, double> initial_rates_;      // by coordinate, as the scene gives them
  std::map<int, double> field_rates_;                // by coordinate: given by a field, for later mimics
  std::vector<int> joint_of_;                        // by node: the joint of the tree of which it is the slave, or -1
  std::vector<Vector6> velocity_;                    // by node, {v, w}
  std::vector<ReleasedVector> rates_;                // by joint
};

InitialVelocity::InitialVelocity(const ScenePlan& plan, const Mechanism& mechanism)
    : plan_(plan),
      mechanism_(mechanism),
      model_(mechanism.model),
      joint_of_(mechanism.slave_joint),
      velocity_(model_.nodes.size(), Vector6::Zero()) {
  for (const scene::InitialLink& field : plan.scene.initial_links) fields_[plan.links[field.link]] = &field;
  for (const scene::InitialJoint& initial : plan.scene.initial_joints)
    if (initial.gives_velocity || initial.velocity != 0) initial_rates_[initial.coordinate] = initial.velocity;
  for (const JointChain& loop : mechanism.loop_joints) joint_of_[loop.closed_node] = -1;
  for (const JointMap& joint : model_.joints) rates_.push_back(ReleasedVector::Zero(released_count(joint.kind)));
}

std::vector<Vector6> InitialVelocity::field() {
  follow_fixed(plan_.tree.root);
  if (plan_.meshes[plan_.tree.root]) set_beam(plan_.tree.root);
  for (const JointChain& chain : mechanism_.tree_joints) {
    const int child = plan_.links[chain.joint->child];
    set_joint(chain);
    follow_fixed(child);
    if (plan_.meshes[child])
      set_beam(child);
    else if (fields_.count(child) && model_.links[child].frame.node >= 0)
      check_field(*fields_[child], child);
  }
  for (const int j : joint_of_)  // nodes at centres of mass
    if (j >= 0 && model_.joints[j].kind == JointMapKind::Rigid) follow(j, ReleasedVector(0));
  close_loops();
  if (!model_.closures.empty()) satisfy_closures();
  return std::move(velocity_);
}

bool InitialVelocity::is_given(const Coordinate& coordinate) const {
  return coordinate.motion >= 0 || initial_rates_.count(coordinate.name) > 0;
}

void InitialVelocity::satisfy_closures() {
  const DegreesOfFreedom dof(model_);
  const Eigen::VectorXd scales = scalar_scales(model_, dof);
  const Kinematics start(model_, dof, initial_configuration(model_));
  const ConstraintRows jacobian = closure_jacobian(start, Constraints::WithMultipliers);
  Eigen::VectorXd velocity = Eigen::VectorXd::Zero(dof.scalar_count);
  for (int i = 0; i < dof.node_count; ++i) velocity.segment<6>(dof.first[i]) = velocity_[i];
  for (std::size_t j = 0; j < rates_.size(); ++j)
    velocity.segment(dof.first[dof.variable_of_joint(static_cast<int>(j))], rates_[j].size()) = rates_[j];
  velocity.array() /= scales.array();
  std::vector<bool> is_adjustable(static_cast<std::size_t>(dof.scalar_count), true);
  for (const Coordinate& coordinate : model_.coordinates)
    if (is_given(coordinate)) is_adjustable[dof.scalar_of(coordinate)] = false;
  const Eigen::VectorXd opening = jacobian * velocity;
  const double speed = velocity.lpNorm<Eigen::Infinity>();
  const bool is_closed = opening.lpNorm<Eigen::Infinity>() <= kAgrees * speed;
  if (!is_closed) velocity += closing_velocity(with_columns(jacobian, is_adjustable), opening);
  if ((jacobian * velocity).lpNorm<Eigen::Infinity>() > kAgrees * speed ||
      (closure_jacobian(start, Constraints::All) * velocity).lpNorm<Eigen::Infinity>() > kIndependent * speed)
    throw ModelError(at_loop_joint(plan_.scene, model_.closures.front().name) +
                     "the initial velocities of the joints contradict the loop that it closes: give fewer of them");
  if (is_closed) return;
  velocity.array() *= scales.array();
  for (int i = 0; i < dof.node_count; ++i)
    if (dof.slave_joint[i] < 0) velocity_[i] = velocity.segment<6>(dof.first[i]);
  for (std::size_t j = 0; j < rates_.size(); ++j)
    rates_[j] = velocity.segment(dof.first[dof.variable_of_joint(static_cast<int>(j))], rates_[j].size()).eval();
  set_follower_rates(model_, model_.initial_released, rates_);
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) follow(j, ReleasedVector(rates_[j]));
}

void InitialVelocity::close_loops() {
  if (mechanism_.loop_joints.empty()) return;
  std::map<int, const JointChain*> loops;  // by first map
  for (const JointChain& loop : mechanism_.loop_joints) loops[loop.first_map] = &loop;
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
    if (const auto loop = loops.find(j); loop != loops.end()) set_loop(*loop->second);
    follow(j, rates_[j]);
  }
}

void InitialVelocity::set_loop(const JointChain& chain) {
  const Vector6 held = velocity_[chain.closed_node];
  ReleasedVector rates;
  if (!given_rates(chain, rates) && rates.size() > 0) rates = field_rates(chain, held);
  for (int k = 0, used = 0; k < chain.map_count; ++k) {
    ReleasedVector& own = rates_[chain.first_map + k];
    own = rates.segment(used, own.size()).eval();
    used += static_cast<int>(own.size());
  }
}

void InitialVelocity::follow(int j, const ReleasedVector& rates) {
  rates_[j] = rates;
  velocity_[model_.joints[j].slave] =
      slave_velocity(model_, j, model_.nodes, model_.initial_released[j], velocity_).with(rates);
}

void InitialVelocity::follow_fixed(int link) {
  const int node = model_.links[link].frame.node, joint = node < 0 ? -1 : joint_of_[node];
  if (joint >= 0 && model_.joints[joint].kind == JointMapKind::Rigid) follow(joint, ReleasedVector(0));
}

void InitialVelocity::set_joint(const JointChain& chain) {
  if (chain.map_count == 0) return;
  const int child = plan_.links[chain.joint->child];
  const JointMap& last = model_.joints[chain.first_map + chain.map_count - 1];
  ReleasedVector rates;
  if (!given_rates(chain, rates) && fields_.count(child)) {
    rates = field_rates(chain, field_velocity(*fields_[child], child, moved_origin(last, model_.nodes[last.slave])));
    for (int c = 0; c < rates.size(); ++c) field_rates_[model_.first_coordinate[chain.first_map] + c] = rates[c];
  }
  for (int k = 0, used = 0; k < chain.map_count; ++k) {
    const int count = released_count(model_.joints[chain.first_map + k].kind);
    follow(chain.first_map + k, ReleasedVector(rates.segment(used, count)));
    used += count;
  }
}

void InitialVelocity::set_beam(int link) {
  const BeamMesh& mesh = plan_.meshes[link]->mesh;
  const int base = model_.links[link].frame.node;
  for (std::size_t i = 1; i < mesh.nodes.size(); ++i) {
    const int node = base + static_cast<int>(i);
    const Vector3& position = model_.nodes[node].position;
    Vector6& velocity = velocity_[node];
    if (joint_of_[node] >= 0) {
      follow(joint_of_[node], ReleasedVector(0));
    } else if (fields_.count(link)) {
      velocity = field_velocity(*fields_[link], link, position);
    } else {
      const Vector6& root = velocity_[base];
      const Vector3 spin = root.tail<3>();
      velocity << root.head<3>() + spin.cross(position - model_.nodes[base].position), spin;
    }
  }
}

double InitialVelocity::given_rate(const Coordinate& coordinate, bool& is_given) const {
  if (coordinate.mimicked >= 0) {
    const double ratio = follower_ratio(model_, coordinate, model_.initial_released);
    const auto from_field = field_rates_.find(coordinate.mimicked);
    if (from_field != field_rates_.end()) {
      is_given = true;
      return ratio * from_field->second;
    }
    // A coordinate that follows one of another joint is given by it, whether that one moves or not.
    const bool is_own = coordinate.is_coupled;
    bool is_master_given = false;
    const double rate = ratio * given_rate(model_.coordinates[coordinate.mimicked], is_master_given);
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

bool InitialVelocity::given_rates(const JointChain& chain, ReleasedVector& rates) const {
  bool is_given = false;
  rates.resize(static_cast<Eigen::Index>(scene::coordinate_suffixes(*chain.joint).size()));
  Eigen::Index used = 0;
  for (int j = chain.first_map; j < chain.first_map + chain.map_count; ++j)
    for (int c = 0; c < released_count(model_.joints[j].kind); ++c)
      rates[used++] = given_rate(model_.coordinates[model_.first_coordinate[j] + c], is_given);
  return is_given;
}

ReleasedVector InitialVelocity::field_rates(const JointChain& chain, const Vector6& target) {
  const JointMap& last = model_.joints[chain.first_map + chain.map_count - 1];
  const Vector3 point = moved_origin(last, model_.nodes[last.slave]);
  const auto at_point = [&](Vector6 velocity, int node) {
    velocity.head<3>() += Vector3(velocity.tail<3>()).cross(point - model_.nodes[node].position);
    return velocity;
  };
  ReleasedColumns columns(6, 0);
  for (int k = 0; k < chain.map_count; ++k) {
    const int j = chain.first_map + k;
    const SlaveVelocity slave = slave_velocity(model_, j, model_.nodes, model_.initial_released[j], velocity_);
    velocity_[model_.joints[j].slave] = slave.carried;  // carried along, at rest in the joint
    for (int c = 0; c < slave.columns.cols(); ++c) {
      columns.conservativeResize(6, columns.cols() + 1);
      columns.col(columns.cols() - 1) = at_point(slave.columns.col(c), model_.joints[j].slave);
    }
  }
  const Vector6 relative = target - at_point(velocity_[last.slave], last.slave);
  // The travel of a slide that follows an angle is a part of the angle's motion. The angle comes right after the
  // travel.
  const Coordinate& first = model_.coordinates[model_.first_coordinate[chain.first_map]];
  if (!first.is_coupled) return least_squares(columns, relative);
  const double ratio = follower_ratio(model_, first, model_.initial_released);
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
  const double error = (asked - velocity_[node]).norm();
  if (error > 1e-9 * (1 + asked.norm()))
    throw ModelError(at(field.location, "<initial>") + "the joints of link '" + field.link +
                     "' do not allow this velocity");
}

}  // namespace

std::vector<Vector6> initial_velocity(const ScenePlan& plan, const SolvableMechanism& mechanism) {
  return InitialVelocity(plan, mechanism).field();
}

}  // namespace flexarm
