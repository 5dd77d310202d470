// The energy of small motions, and how much of it is round-off.
#include <algorithm>
#include <cmath>

#include "analysis/element_matrices.h"
#include "analysis/folded_sums.h"
#include "analysis/linearised_motion.h"

namespace flexarm {
namespace {

/// {displacement, spin} of these nodes, one after the other.
template <class Nodes>
Eigen::VectorXcd motion_of(const Nodes& nodes, const std::vector<ComplexVector6>& node_motion) {
  Eigen::VectorXcd motion(6 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    motion.segment<6>(6 * static_cast<Eigen::Index>(i)) = node_motion[nodes[i]];
  return motion;
}

}  // namespace

double work_of_forces(const Model& model, const State& equilibrium) {
  double work = 0;
  const auto add = [&](const NodalLoad& load, double value) {
    work += std::abs(value) * (load.force.norm() * model.length_scale + load.moment.norm());
  };
  for (const NodalInertia& inertia : model.inertias)
    work += inertia.total_mass * model.gravity.norm() * model.length_scale;
  for (const NodalLoad& load : model.loads) add(load, model.histories[load.history](0.0));
  for (const NodalLoad& wrench : equilibrium.wrenches) add(wrench, 1);
  return work;
}

double round_off(const Model& model, const State& equilibrium, const std::vector<ComplexVector6>& node_motion) {
  double elastic = 0, largest_spin = 0;
  for_each_element(model.beams, [&](const auto& element) {
    const Eigen::VectorXd motion = motion_of(element.nodes, node_motion).cwiseAbs();
    elastic += motion.dot(material_stiffness(element, equilibrium).cwiseAbs().lazyProduct(motion));
  });
  const std::vector<std::vector<int>> nodes = nodes_of(model.force_elements, equilibrium);
  const std::vector<const double*> memories = memories_of(model.force_elements, equilibrium.force_memory);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto& [rows, stiffness] = model.force_elements[k]->measures(equilibrium, memories[k], nodes[k].data());
    const Eigen::VectorXd way = rows.cwiseAbs() * motion_of(nodes[k], node_motion).cwiseAbs();
    elastic += way.dot(stiffness.cwiseAbs() * way);
  }
  // Rotations change the work of a force in second order, times an arm.
  for (const ComplexVector6& motion : node_motion) largest_spin = std::max(largest_spin, motion.tail<3>().norm());
  return kStiffnessRoundOff * (elastic + work_of_forces(model, equilibrium) * largest_spin * largest_spin);
}

bool is_circulatory(const Model& model, const State& equilibrium) {
  const auto load_circulates = [](const NodalLoad& load) { return load.follows || !load.moment.isZero(0); };
  // The axes of the moment on a free rotation stand still while the joint turns, so that it has no potential.
  const auto effort_circulates = [&](std::size_t i) {
    const Coordinate& coordinate = model.coordinates[i];
    return coordinate.is_angle && (coordinate.effort >= 0 || !std::isnan(equilibrium.commands[i]));
  };
  for (const std::vector<NodalLoad>* loads : {&model.loads, &equilibrium.wrenches})
    if (std::any_of(loads->begin(), loads->end(), load_circulates)) return true;
  for (std::size_t i = 0; i < model.coordinates.size(); ++i)
    if (effort_circulates(i)) return true;
  // A servo that measures behind its gear acts at another place than it measures.
  return std::any_of(model.actuators.begin(), model.actuators.end(), [](const Actuator& actuator) {
    return actuator.drive.gear && actuator.servo && actuator.servo->on_link;
  });
}

Eigen::SparseMatrix<double> LinearisedMotion::curvature() const {
  SparseTangent difference(model_, dof_);
  difference.set_zero();
  for_each_element(model_.beams, [&](const auto& element) {
    add_element(difference, element.first_block,
                material_curvature(element, state_) - material_stiffness(element, state_));
  });
  fold(kinematics_, difference);
  const Eigen::SparseMatrix<double> sum = matrix(stiffness_) + matrix(difference);
  return 0.5 * (sum + Eigen::SparseMatrix<double>(sum.transpose()));
}

double LinearisedMotion::strain_energy(const std::vector<ComplexVector6>& node_motion) const {
  double energy = 0;
  for_each_element(model_.beams, [&](const auto& element) {
    const Eigen::VectorXcd motion = motion_of(element.nodes, node_motion);
    const Eigen::VectorXd real = motion.real(), imaginary = motion.imag();
    const Eigen::MatrixXd curvature = material_curvature(element, state_);
    energy += real.dot(curvature.lazyProduct(real)) + imaginary.dot(curvature.lazyProduct(imaginary));
  });
  const std::vector<std::vector<int>> nodes = nodes_of(model_.force_elements, state_);
  const std::vector<const double*> memories = memories_of(model_.force_elements, state_.force_memory);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto& [rows, stiffness] = model_.force_elements[k]->measures(state_, memories[k], nodes[k].data());
    const Eigen::VectorXcd way = rows * motion_of(nodes[k], node_motion);
    energy += way.real().dot(stiffness * way.real()) + way.imag().dot(stiffness * way.imag());
  }
  return energy;
}

}  // namespace flexarm
