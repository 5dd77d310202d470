#include "analysis/linearised_motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/element_matrices.h"
#include "analysis/falling.h"
#include "integrators/force_elements.h"
#include "joints/joint_kinematics.h"
#include "joints/joint_stop.h"
#include "math/least_squares.h"

namespace flexarm {
namespace {

/// Slope of a coordinate's effort against its rate, at rest.
double damping_of(const Coordinate& coordinate, const Released& released) {
  if (!coordinate.limit) return coordinate.damping;
  return coordinate.damping + stop_damping(*coordinate.limit, released.displacement[coordinate.component]);
}

}  // namespace

Scheme exact_equilibrium() {
  return statics_of(*find_scheme("newmark"));
}

LinearisedMotion::LinearisedMotion(const Model& model, const State& state)
    : model_(model),
      state_(state),
      system_(model, exact_equilibrium(), BackendChoice::Matrix),
      dof_(system_.degrees_of_freedom()),
      stiffness_(system_.tangent().matrix()),
      damping_(model, dof_),
      mass_(model, dof_) {
  balance();
  const Fall fall = fall_of(model, dof_, state_, system_.residual());
  if (!fall.inertia.empty()) {
    state_.wrenches.insert(state_.wrenches.end(), fall.inertia.begin(), fall.inertia.end());
    balance();
  }
  set_joint_maps();
  for (SparseTangent* tangent : {&damping_, &mass_}) couple_force_elements(model, state_, *tangent);
  assemble_damping();
  assemble_mass();
  matrices_ = with_rotors(model, dof_, state_, system_.actuators(), stiffness_, damping_, mass_);
}

int LinearisedMotion::freedoms() const {
  // Each multiplier of a loop removes two unknowns: itself, since it has no mass, and the motion that it constrains.
  int freedoms = unknowns();
  for (const LoopClosure& closure : model_.closures) freedoms -= 2 * static_cast<int>(closure.constraints.size());
  return freedoms;
}

LinearisedMotion::Matrix LinearisedMotion::matrix(const SparseTangent& tangent) {
  return Matrix(tangent.unknowns(), tangent.unknowns(), tangent.values().size(), tangent.column_starts().data(),
                tangent.row_indices().data(), tangent.values().data());
}

LinearisedMotion::Matrix LinearisedMotion::matrix(const std::vector<double>& extended, const SparseTangent& own) const {
  if (!has_rotors()) return matrix(own);
  return Matrix(unknowns(), unknowns(), static_cast<Eigen::Index>(extended.size()), column_starts().data(),
                row_indices().data(), extended.data());
}

bool LinearisedMotion::is_damped() const {
  const Matrix values = damping();
  return std::any_of(values.valuePtr(), values.valuePtr() + values.nonZeros(), [](double value) { return value != 0; });
}

void LinearisedMotion::balance() {
  system_.begin_equilibrium(state_, 1.0);
  if (!system_.evaluate(true)) throw std::runtime_error("the stiffness is not finite");
  find_multipliers();
}

/// Sets the multipliers of loops so that they balance the residual best, since their forces stiffen the mechanism as
/// loads do.
void LinearisedMotion::find_multipliers() {
  std::vector<int> multipliers;
  for (std::size_t k = 0; k < model_.closures.size(); ++k)
    for (std::size_t i = 0; i < model_.closures[k].constraints.size(); ++i)
      multipliers.push_back(dof_.equation[dof_.first[dof_.variable_of_closure(static_cast<int>(k))] + i]);
  if (multipliers.empty()) return;
  Eigen::MatrixXd forces(unknowns(), static_cast<Eigen::Index>(multipliers.size()));
  for (std::size_t m = 0; m < multipliers.size(); ++m)
    forces.col(static_cast<Eigen::Index>(m)) = matrix(stiffness_).col(multipliers[m]);
  const Eigen::VectorXd balancing = -least_squares(forces, system_.residual());
  Eigen::VectorXd update = Eigen::VectorXd::Zero(unknowns());
  for (std::size_t m = 0; m < multipliers.size(); ++m) update[multipliers[m]] = balancing[static_cast<Eigen::Index>(m)];
  system_.update(update);
  if (!system_.evaluate(true)) throw std::runtime_error("the stiffness is not finite");
}

void LinearisedMotion::set_joint_maps() {
  std::vector<NodePose> nodes;
  for (const NodeState& node : state_.nodes) nodes.push_back(node_pose(node));
  maps_.folds.resize(model_.joints.size());
  maps_.slides.resize(model_.joints.size());
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointMap& joint = model_.joints[j];
    if (joint.kind == JointMapKind::Slide)
      slide_variational_maps(model_.slide_lines[joint.line], nodes, state_.released[j].displacement[0], Vector6::Zero(),
                             maps_.slides[j]);
    else
      variational_maps(joint, joint_pose(joint, nodes, state_.released[j]), Vector6::Zero(), maps_.folds[j]);
  }
  for (const DegreesOfFreedom::Mimic& mimic : dof_.mimics) {
    const Coordinate& following = model_.coordinates[mimic.coordinate];
    const int master = model_.coordinates[following.mimicked].joint;
    const double slope = following.mimic.derivative(state_.released[master].displacement[0]);
    maps_.mimics.push_back({slope, slope, 0});
  }
}

/// The diagonal entry of a released coordinate.
double& LinearisedMotion::diagonal(SparseTangent& tangent, int joint, int component) const {
  const int count = released_count(model_.joints[joint].kind);
  return tangent.diagonal_block(dof_.variable_of_joint(joint))[component * count + component];
}

void LinearisedMotion::assemble_mass() {
  mass_.set_zero();
  for_each_element(model_.beams,
                   [&](const auto& element) { add_element(mass_, element.first_block, mass_matrix(element, state_)); });
  for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
    const NodalInertia& inertia = model_.inertias[i];
    const Matrix3 rotation = state_.nodes[i].orientation.toRotationMatrix();
    Eigen::Map<Matrix6> block(mass_.diagonal_block(static_cast<int>(i)));
    block.topLeftCorner<3, 3>().diagonal().array() += inertia.mass;
    block.bottomRightCorner<3, 3>() += rotation * inertia.rotary * rotation.transpose();
  }
  for (const ActuatorTerms& terms : actuator_terms(model_, state_))
    diagonal(mass_, terms.joint, terms.component) += terms.mass;
  fold(mass_);
}

void LinearisedMotion::assemble_damping() {
  damping_.set_zero();
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    if (element.stiffness_damping == 0 && element.mass_damping == 0) return;
    Eigen::MatrixXd damping = element.stiffness_damping * material_stiffness(with_damped_stiffness(element), state_);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        damping.block<3, 3>(6 * i, 6 * j).diagonal().array() += element.mass_damping * element.mass(i, j);
    add_element(damping_, element.first_block, damping);
  });
  for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
    const Matrix3 rotation = state_.nodes[i].orientation.toRotationMatrix();
    Eigen::Map<Matrix6>(damping_.diagonal_block(static_cast<int>(i))).bottomRightCorner<3, 3>() +=
        rotation * model_.inertias[i].rotary_damping * rotation.transpose();
  }
  for (const Coordinate& coordinate : model_.coordinates)
    diagonal(damping_, coordinate.joint, coordinate.component) +=
        damping_of(coordinate, state_.released[coordinate.joint]);
  for (const ActuatorTerms& terms : actuator_terms(model_, state_))
    diagonal(damping_, terms.joint, terms.component) += terms.damping + terms.servo_damping;
  const std::vector<std::vector<int>> nodes = nodes_of(model_.force_elements, state_);
  const std::vector<const double*> memories = memories_of(model_.force_elements, state_.force_memory);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const ForceElement& element = *model_.force_elements[k];
    const Eigen::MatrixXd rows = element.measures(state_, memories[k], nodes[k].data()).rows;
    const Eigen::MatrixXd slope = element.dampers(state_, memories[k], Eigen::VectorXd::Zero(rows.rows())).slope;
    damping_.add_coupling(static_cast<int>(k), rows.transpose() * slope * rows);
  }
  fold(damping_);
}

void LinearisedMotion::fold(SparseTangent& tangent) const {
  for (int j = static_cast<int>(model_.joints.size()) - 1; j >= 0; --j) {
    if (model_.joints[j].kind == JointMapKind::Slide)
      tangent.fold(j, maps_.slides[j]);
    else
      tangent.fold(j, maps_.folds[j]);
  }
  tangent.fold_mimics(maps_.mimics);
  tangent.finish();
}

// ---------------------------------------------------------------- motions

std::vector<double> LinearisedMotion::scalars(const Eigen::VectorXd& vector) const {
  std::vector<double> scalars(dof_.scalar_count, 0.0);
  for (int s = 0; s < dof_.scalar_count; ++s)
    if (dof_.equation[s] >= 0) scalars[s] = vector[dof_.equation[s]];
  for (std::size_t i = 0; i < dof_.mimics.size(); ++i)
    scalars[dof_.first[dof_.mimics[i].slave_variable]] =
        maps_.mimics[i].right * scalars[dof_.first[dof_.mimics[i].master_variable]];
  return scalars;
}

std::vector<Vector6> LinearisedMotion::node_motion(const std::vector<double>& scalars) const {
  std::vector<Vector6> motion(model_.nodes.size());
  for (std::size_t i = 0; i < motion.size(); ++i) motion[i] = Eigen::Map<const Vector6>(&scalars[dof_.first[i]]);
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointMap& joint = model_.joints[j];
    const double* rates = scalars.data() + dof_.first[dof_.variable_of_joint(static_cast<int>(j))];
    Vector6& slave = motion[joint.slave];
    slave.setZero();
    if (joint.kind == JointMapKind::Slide) {
      const SlideMaps& map = maps_.slides[j];
      slave = rates[0] * map.released_right;
      for (int k = 0; k < map.count; ++k)
        slave += map.right[k] * motion[model_.slide_lines[joint.line].nodes[map.first + k]];
      continue;
    }
    const FoldMaps& map = maps_.folds[j];
    if (joint.master >= 0) {
      slave = motion[joint.master];
      slave.head<3>() += motion[joint.master].tail<3>().cross(map.lever_right);
    }
    for (int k = 0; k < map.right.cols(); ++k) slave += map.right.col(k) * rates[k];
  }
  return motion;
}

Mode LinearisedMotion::expand(const Eigen::VectorXcd& vector) const {
  const std::vector<double> real = scalars(vector.real()), imaginary = scalars(vector.imag());
  const std::vector<Vector6> real_motion = node_motion(real), imaginary_motion = node_motion(imaginary);
  Mode mode;
  for (std::size_t n = 0; n < real_motion.size(); ++n) {
    mode.node_motion.emplace_back();
    mode.node_motion.back().real() = real_motion[n];
    mode.node_motion.back().imag() = imaginary_motion[n];
  }
  for (const Coordinate& coordinate : model_.coordinates) {
    const int scalar = dof_.first[dof_.variable_of_joint(coordinate.joint)] + coordinate.component;
    mode.coordinate_motion.emplace_back(real[scalar], imaginary[scalar]);
  }
  return mode;
}

}  // namespace flexarm
