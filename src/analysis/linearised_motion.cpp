#include "analysis/linearised_motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/QR>

#include "elements/element_configuration.h"
#include "elements/endpoint_beam.h"
#include "joints/joint_kinematics.h"
#include "joints/joint_stop.h"
#include "math/so3.h"

namespace flexarm {
namespace {

template <int Nodes>
using ElementMatrix = Eigen::Matrix<double, 6 * Nodes, 6 * Nodes>;

/// `visit(constants, kinematics, generalised shape functions)` of every stiffness point.
template <int Nodes, class Visit>
void for_each_point(const BeamElement<Nodes>& element, const State& state, const Visit& visit) {
  const ElementConfiguration<Nodes> nodes(element, state);
  const LocalRotationVariation<Nodes> local{LocalRotations<Nodes>(nodes.orientation)};
  for (const auto& constants : element.stiffness_points) {
    GeneralisedShapeFunctions<Nodes> functions;
    const auto rotation = local.evaluate(constants.shape, constants.derivative, functions);
    visit(constants,
          point_kinematics(rotation, interpolate<Nodes>(constants.derivative, nodes.position),
                           constants.reference_strain),
          functions);
  }
}

/// Stiffness of the material alone, without what stress adds to it.
template <int Nodes>
ElementMatrix<Nodes> material_stiffness(const BeamElement<Nodes>& element, const State& state) {
  ElementMatrix<Nodes> stiffness = ElementMatrix<Nodes>::Zero();
  for_each_point(element, state, [&](const auto& constants, const PointKinematics& point, const auto& functions) {
    const endpoint::PointTangent tangent =
        endpoint::point_tangent(point, constants.stiffness, 1, Vector3::Zero(), Vector3::Zero());
    add_point_tangent<Nodes>(constants.weight, LagrangeTests<Nodes>{constants.shape, constants.derivative},
                             {constants.derivative, functions}, tangent.resultants, tangent.couple, stiffness);
  });
  return stiffness;
}

/// d{Gamma, K} of a point by {displacement, spin} of the nodes.
template <int Nodes>
Eigen::Matrix<double, 6, 6 * Nodes> strain_variation(const PointKinematics& point, const NodalValues<Nodes>& derivative,
                                                     const GeneralisedShapeFunctions<Nodes>& spins) {
  const Matrix3& rotation = point.rotation;
  const Matrix3 turned = rotation.transpose() * so3::hat(point.tangent);
  Eigen::Matrix<double, 6, 6 * Nodes> variation;
  for (int i = 0; i < Nodes; ++i)
    variation.template middleCols<6>(6 * i) << derivative[i] * rotation.transpose(), turned * spins.values[i],
        Matrix3::Zero(), rotation.transpose() * spins.derivatives[i];
  return variation;
}

/// Second derivative of the energy by strains alone: the material's stiffness with variations of strains as tests.
template <int Nodes>
ElementMatrix<Nodes> material_curvature(const BeamElement<Nodes>& element, const State& state) {
  ElementMatrix<Nodes> curvature = ElementMatrix<Nodes>::Zero();
  for_each_point(element, state, [&](const auto& constants, const PointKinematics& point, const auto& spins) {
    const auto strains = strain_variation<Nodes>(point, constants.derivative, spins);
    curvature += constants.weight * strains.transpose() * constants.stiffness * strains;
  });
  return curvature;
}

/// Slope of a coordinate's effort against its rate, at rest.
double damping_of(const Coordinate& coordinate, const StopPenalty& stop, const Released& released) {
  if (!coordinate.limit) return coordinate.damping;
  return coordinate.damping + stop_damping(*coordinate.limit, stop, released.displacement[coordinate.component]);
}

/// Equilibrium of exact forces.
Scheme rest(double contact_time) {
  Scheme scheme = statics_of(*find_scheme("newmark"));
  scheme.contact_time = contact_time;
  return scheme;
}

}  // namespace

double work_of_forces(const Model& model) {
  double work = 0;
  for (const NodalInertia& inertia : model.inertias)
    work += inertia.total_mass * model.gravity.norm() * model.length_scale;
  for (const NodalLoad& load : model.loads)
    work +=
        std::abs(model.histories[load.history](0.0)) * (load.force.norm() * model.length_scale + load.moment.norm());
  return work;
}

LinearisedMotion::LinearisedMotion(const Model& model, const State& state, double contact_time)
    : model_(model),
      state_(state),
      contact_time_(contact_time),
      system_(model, rest(contact_time), BackendChoice::Matrix),
      dof_(system_.degrees_of_freedom()),
      stiffness_(static_cast<const SparseTangent&>(system_.tangent())),
      damping_(model, dof_),
      mass_(model, dof_) {
  system_.begin_equilibrium(state, 1.0);
  if (!system_.evaluate(true)) throw std::runtime_error("the stiffness is not finite");
  find_multipliers();
  set_joint_maps();
  assemble_damping();
  assemble_mass();
}

int LinearisedMotion::freedoms() const {
  // Every multiplier of a loop takes two: its own, which has no mass, and the motion that it holds.
  int freedoms = unknowns();
  for (const LoopClosure& closure : model_.closures) freedoms -= 2 * static_cast<int>(closure.constraints.size());
  return freedoms;
}

LinearisedMotion::Matrix LinearisedMotion::matrix(const SparseTangent& tangent) {
  return Matrix(tangent.unknowns(), tangent.unknowns(), tangent.values().size(), tangent.column_starts().data(),
                tangent.row_indices().data(), tangent.values().data());
}

bool LinearisedMotion::is_damped() const {
  const std::vector<double>& values = damping_.values();
  return std::any_of(values.begin(), values.end(), [](double value) { return value != 0; });
}

bool LinearisedMotion::is_circulatory() const {
  const auto load_circulates = [](const NodalLoad& load) { return load.follows || !load.moment.isZero(0); };
  // The moment on a free rotation has axes that stand still while it turns.
  const auto effort_circulates = [&](std::size_t i) {
    const Coordinate& coordinate = model_.coordinates[i];
    return coordinate.is_angle && (coordinate.effort >= 0 || !std::isnan(state_.commands[i]));
  };
  if (std::any_of(model_.loads.begin(), model_.loads.end(), load_circulates)) return true;
  for (std::size_t i = 0; i < model_.coordinates.size(); ++i)
    if (effort_circulates(i)) return true;
  return false;
}

/// Sets the multipliers of loops to what balances the residual: their forces stiffen the mechanism as loads do.
void LinearisedMotion::find_multipliers() {
  std::vector<int> multipliers;
  for (std::size_t k = 0; k < model_.closures.size(); ++k)
    for (std::size_t i = 0; i < model_.closures[k].constraints.size(); ++i)
      multipliers.push_back(dof_.equation[dof_.first[dof_.variable_of_closure(static_cast<int>(k))] + i]);
  if (multipliers.empty()) return;
  Eigen::MatrixXd forces(unknowns(), static_cast<Eigen::Index>(multipliers.size()));
  for (std::size_t m = 0; m < multipliers.size(); ++m)
    forces.col(static_cast<Eigen::Index>(m)) = stiffness().col(multipliers[m]);
  const Eigen::VectorXd balancing = -forces.colPivHouseholderQr().solve(system_.residual());
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

void LinearisedMotion::assemble_mass() {
  mass_.set_zero();
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const LocalRotationVariation<N> local{LocalRotations<N>(ElementConfiguration<N>(element, state_).orientation)};
    const auto block = [&](int i, int j) {
      return Eigen::Map<Matrix6>(mass_.element_block(element.first_block + i * N + j));
    };
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) block(i, j).template topLeftCorner<3, 3>().diagonal().array() += element.mass(i, j);
    for (const auto& point : element.mass_points) {
      GeneralisedShapeFunctions<N> generalised;
      const Matrix3 rotation = local.evaluate(point.shape, point.derivative, generalised).rotation;
      const Matrix3 inertia = point.weight * rotation * point.inertia * rotation.transpose();
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j)
          block(i, j).template bottomRightCorner<3, 3>() += point.shape[i] * inertia * generalised.values[j];
    }
  });
  for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
    const NodalInertia& inertia = model_.inertias[i];
    const Matrix3 rotation = state_.nodes[i].orientation.toRotationMatrix();
    Eigen::Map<Matrix6> block(mass_.diagonal_block(static_cast<int>(i)));
    block.topLeftCorner<3, 3>().diagonal().array() += inertia.mass;
    block.bottomRightCorner<3, 3>() += rotation * inertia.rotary * rotation.transpose();
  }
  fold(mass_);
}

void LinearisedMotion::assemble_damping() {
  damping_.set_zero();
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    if (element.stiffness_damping == 0 && element.mass_damping == 0) return;
    const Eigen::Matrix<double, 6 * N, 6 * N> of_strains =
        element.stiffness_damping * material_stiffness<N>(element, state_);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) {
        Eigen::Map<Matrix6> block(damping_.element_block(element.first_block + i * N + j));
        block += of_strains.template block<6, 6>(6 * i, 6 * j);
        block.template topLeftCorner<3, 3>().diagonal().array() += element.mass_damping * element.mass(i, j);
      }
  });
  for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
    const Matrix3 rotation = state_.nodes[i].orientation.toRotationMatrix();
    Eigen::Map<Matrix6>(damping_.diagonal_block(static_cast<int>(i))).bottomRightCorner<3, 3>() +=
        rotation * model_.inertias[i].rotary_damping * rotation.transpose();
  }
  for (const Coordinate& coordinate : model_.coordinates) {
    const int count = released_count(model_.joints[coordinate.joint].kind), k = coordinate.component;
    damping_.diagonal_block(dof_.variable_of_joint(coordinate.joint))[k * count + k] +=
        damping_of(coordinate, stop_penalty(coordinate, contact_time_), state_.released[coordinate.joint]);
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

Eigen::SparseMatrix<double> LinearisedMotion::curvature() const {
  SparseTangent difference(model_, dof_);
  difference.set_zero();
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const ElementMatrix<N> own = material_curvature<N>(element, state_) - material_stiffness<N>(element, state_);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        Eigen::Map<Matrix6>(difference.element_block(element.first_block + i * N + j)) +=
            own.template block<6, 6>(6 * i, 6 * j);
  });
  fold(difference);
  const Eigen::SparseMatrix<double> sum = stiffness() + matrix(difference);
  return 0.5 * (sum + Eigen::SparseMatrix<double>(sum.transpose()));
}

double LinearisedMotion::strain_energy(const std::vector<ComplexVector6>& node_motion) const {
  double energy = 0;
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    Eigen::Matrix<std::complex<double>, 6 * N, 1> motion;
    for (int i = 0; i < N; ++i) motion.template segment<6>(6 * i) = node_motion[element.nodes[i]];
    energy += motion.dot(material_curvature<N>(element, state_) * motion).real();
  });
  return energy;
}

double LinearisedMotion::round_off(const std::vector<ComplexVector6>& node_motion) const {
  double elastic = 0, largest_spin = 0;
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    Eigen::Matrix<double, 6 * N, 1> motion;
    for (int i = 0; i < N; ++i) motion.template segment<6>(6 * i) = node_motion[element.nodes[i]].cwiseAbs();
    elastic += motion.dot(material_stiffness<N>(element, state_).cwiseAbs() * motion);
  });
  // A force changes its work by a second order of rotations, times an arm.
  for (const ComplexVector6& motion : node_motion) largest_spin = std::max(largest_spin, motion.tail<3>().norm());
  return kRoundOff * (elastic + work_of_forces(model_) * largest_spin * largest_spin);
}

}  // namespace flexarm
