#include "analysis/linearised_motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/element_matrices.h"
#include "analysis/falling.h"
#include "analysis/folded_sums.h"
#include "integrators/force_elements.h"
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
      mass_(model, dof_),
      kinematics_(model, dof_, configuration_of(state)) {
  balance();
  const Fall fall = fall_of(model, dof_, state_, system_.residual());
  if (!fall.inertia.empty()) {
    state_.wrenches.insert(state_.wrenches.end(), fall.inertia.begin(), fall.inertia.end());
    balance();
  }
  for (SparseTangent* tangent : {&damping_, &mass_}) couple_force_elements(model, state_, *tangent);
  assemble_damping();
  mass_.set_zero();
  add_mass(kinematics_, state_, mass_);
  fold(kinematics_, mass_);
  matrices_ = with_rotors(model, dof_, state_, system_.actuators(), stiffness_, damping_, mass_);
}

int LinearisedMotion::freedoms() const {
  // Each multiplier of a loop removes two unknowns: itself, since it has no mass, and the motion that it constrains.
  return unknowns() - 2 * multiplier_count(model_);
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
  const std::vector<int> multipliers = multiplier_equations(model_, dof_);
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
    diagonal_entry(kinematics_, damping_, coordinate.joint, coordinate.component) +=
        damping_of(coordinate, state_.released[coordinate.joint]);
  for (const ActuatorTerms& terms : actuator_terms(model_, state_))
    diagonal_entry(kinematics_, damping_, terms.joint, terms.component) += terms.damping + terms.servo_damping;
  const std::vector<std::vector<int>> nodes = nodes_of(model_.force_elements, state_);
  const std::vector<const double*> memories = memories_of(model_.force_elements, state_.force_memory);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const ForceElement& element = *model_.force_elements[k];
    const Eigen::MatrixXd rows = element.measures(state_, memories[k], nodes[k].data()).rows;
    const Eigen::MatrixXd slope = element.dampers(state_, memories[k], Eigen::VectorXd::Zero(rows.rows())).slope;
    damping_.add_coupling(static_cast<int>(k), rows.transpose() * slope * rows);
  }
  fold(kinematics_, damping_);
}

Mode LinearisedMotion::expand(const Eigen::VectorXcd& vector) const {
  Eigen::MatrixXd parts = Eigen::MatrixXd::Zero(dof_.scalar_count, 2);  // real, imaginary
  for (int scalar = 0; scalar < dof_.scalar_count; ++scalar)
    if (const int equation = dof_.equation[scalar]; equation >= 0)
      parts.row(scalar) << vector[equation].real(), vector[equation].imag();
  kinematics_.complete(parts);
  Mode mode;
  for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
    const auto motion = parts.middleRows<6>(dof_.first[n]);
    mode.node_motion.emplace_back();
    mode.node_motion.back().real() = motion.col(0);
    mode.node_motion.back().imag() = motion.col(1);
  }
  for (const Coordinate& coordinate : model_.coordinates) {
    const auto motion = parts.row(dof_.scalar_of(coordinate));
    mode.coordinate_motion.emplace_back(motion[0], motion[1]);
  }
  return mode;
}

}  // namespace flexarm
