#include "flexarm/solver/modes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>

#include <Spectra/GenEigsSolver.h>
#include <Eigen/Eigenvalues>

#include "flexarm/elements/beam_point.h"
#include "flexarm/integrators/step_system.h"
#include "flexarm/joints/joint_map.h"
#include "flexarm/math/so3.h"
#include "flexarm/solver/linear_solver.h"

namespace flexarm {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// Below this number of unknowns all eigenvalues are computed by a dense solver.
constexpr int kDenseLimit = 200;
/// Modes computed beyond those asked for.
constexpr int kExtraModes = 12;
/// Round-off of a motion's strain energy relative to the sum of the magnitudes of its terms.
constexpr double kEnergyRoundOff = 8 * std::numeric_limits<double>::epsilon();

/// Maps of all joints at a configuration, for zero residual.
struct JointMaps {
  std::vector<FoldMaps> folds;    // per joint
  std::vector<SlideMaps> slides;  // per joint; used for those that slide
  std::vector<MimicMap> mimics;
};
JointMaps joint_maps(const Model& model, const DegreesOfFreedom& dof, const State& state) {
  std::vector<NodePose> nodes;
  for (const NodeState& node : state.nodes) nodes.push_back(node_pose(node));
  JointMaps maps{std::vector<FoldMaps>(model.joints.size()), std::vector<SlideMaps>(model.joints.size()), {}};
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointMap& joint = model.joints[j];
    if (joint.kind == JointMapKind::Slide)
      slide_variational_maps(model.slide_lines[joint.line], nodes, state.released[j].displacement[0], Vector6::Zero(),
                             maps.slides[j]);
    else
      variational_maps(joint, joint.master < 0 ? NodePose() : nodes[joint.master], state.released[j], Vector6::Zero(),
                       maps.folds[j]);
  }
  for (const DegreesOfFreedom::Mimic& mimic : dof.mimics) {
    const Coordinate& following = model.coordinates[mimic.coordinate];
    const int master = model.coordinates[following.mimicked].joint;
    const double slope = following.mimic.derivative(state.released[master].displacement[0]);
    maps.mimics.push_back({slope, slope, 0});
  }
  return maps;
}

void assemble_mass(const Model& model, const State& state, const JointMaps& maps, SparseAssembler& assembler) {
  assembler.set_zero();
  for_each_element(model.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    std::array<Quaternion, N> orientation;
    for (int i = 0; i < N; ++i) orientation[i] = state.nodes[element.nodes[i]].orientation;
    const LocalRotationVariation<N> local{LocalRotations<N>(orientation)};
    const auto block = [&](int i, int j) {
      return Eigen::Map<Matrix6>(assembler.element_block(element.first_block + i * N + j));
    };
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) block(i, j).template topLeftCorner<3, 3>().diagonal().array() += element.mass(i, j);
    for (const auto& point : element.mass_points) {
      GeneralisedShapeFunctions<N> generalised;
      const Matrix3 rotation = local.evaluate(point.shape, point.derivative, generalised).rotation;
      const Matrix3 inertia = point.weight * rotation * element.inertia * rotation.transpose();
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j)
          block(i, j).template bottomRightCorner<3, 3>() += point.shape[i] * inertia * generalised.values[j];
    }
  });
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    const Matrix3 rotation = state.nodes[i].orientation.toRotationMatrix();
    Eigen::Map<Matrix6> block(assembler.diagonal_block(static_cast<int>(i)));
    block.topLeftCorner<3, 3>().diagonal().array() += inertia.mass;
    block.bottomRightCorner<3, 3>() += rotation * inertia.rotary * rotation.transpose();
  }
  for (int j = static_cast<int>(model.joints.size()) - 1; j >= 0; --j) {
    if (model.joints[j].kind == JointMapKind::Slide)
      assembler.fold(j, maps.slides[j], true);
    else
      assembler.fold(j, maps.folds[j], true);
  }
  assembler.fold_mimics(maps.mimics, true);
  assembler.gather_tangent();
}

/// x -> (K + shift M)^{-1} M x, for Spectra and for the dense path.
class ShiftInvert {
 public:
  using Scalar = double;
  ShiftInvert(const SparseAssembler& stiffness, const SparseAssembler& mass, double shift)
      : mass_(mass), solver_(mass.unknowns(), mass.column_starts(), mass.row_indices()), values_(mass.values()) {
    for (std::size_t p = 0; p < values_.size(); ++p) values_[p] = stiffness.values()[p] + shift * mass.values()[p];
    if (!solver_.factorise(values_)) throw std::runtime_error("the shifted stiffness is singular");
  }
  Eigen::Index rows() const { return mass_.unknowns(); }
  Eigen::Index cols() const { return mass_.unknowns(); }
  void perform_op(const double* x, double* y) const {
    Eigen::VectorXd product = Eigen::VectorXd::Zero(rows());
    for (int j = 0; j < mass_.unknowns(); ++j)
      for (int p = mass_.column_starts()[j]; p < mass_.column_starts()[j + 1]; ++p)
        product[mass_.row_indices()[p]] += mass_.values()[p] * x[j];
    if (!solver_.solve(product)) throw std::runtime_error("the eigenvalue problem is singular");
    Eigen::VectorXd::Map(y, rows()) = product;
  }

 private:
  const SparseAssembler& mass_;
  mutable LinearSolver solver_;
  std::vector<double> values_;
};

struct Eigenpairs {
  std::vector<double> squared;  // omega^2, ascending
  std::vector<Eigen::VectorXd> vectors;
};

Eigenpairs lowest(const SparseAssembler& stiffness, const SparseAssembler& mass, double shift, int count) {
  const ShiftInvert operation(stiffness, mass, shift);
  const int n = mass.unknowns();
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
  if (n <= kDenseLimit || 2 * count + 2 >= n) {
    Eigen::MatrixXd dense(n, n);
    for (int j = 0; j < n; ++j) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, j);
      operation.perform_op(unit.data(), dense.col(j).data());
    }
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(dense);
    values = solver.eigenvalues();
    vectors = solver.eigenvectors();
  } else {
    ShiftInvert mutable_operation(stiffness, mass, shift);
    Spectra::GenEigsSolver<ShiftInvert> solver(mutable_operation, count, std::min(n, std::max(2 * count + 20, 40)));
    solver.init();
    solver.compute(Spectra::SortRule::LargestMagn, 2000, 1e-13);
    if (solver.info() != Spectra::CompInfo::Successful)
      throw std::runtime_error("the eigenvalue iteration did not converge");
    values = solver.eigenvalues();
    vectors = solver.eigenvectors();
  }
  std::vector<int> order(values.size());
  for (int i = 0; i < values.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::abs(values[a]) > std::abs(values[b]); });
  Eigenpairs out;
  for (int k = 0; k < std::min<int>(count, static_cast<int>(order.size())); ++k) {
    out.squared.push_back((1.0 / values[order[k]]).real() - shift);
    out.vectors.push_back(vectors.col(order[k]).real());
  }
  return out;
}

double trace(const SparseAssembler& matrix) {
  double sum = 0;
  for (int j = 0; j < matrix.unknowns(); ++j)
    for (int p = matrix.column_starts()[j]; p < matrix.column_starts()[j + 1]; ++p)
      if (matrix.row_indices()[p] == j) sum += std::abs(matrix.values()[p]);
  return sum;
}

/// True for a motion whose energy is no more than the round-off of its own terms.
bool is_rigid(const SparseAssembler& stiffness, const Eigen::VectorXd& motion) {
  double energy = 0, magnitude = 0;
  for (int j = 0; j < stiffness.unknowns(); ++j)
    for (int p = stiffness.column_starts()[j]; p < stiffness.column_starts()[j + 1]; ++p) {
      const double term = motion[stiffness.row_indices()[p]] * stiffness.values()[p] * motion[j];
      energy += term;
      magnitude += std::abs(term);
    }
  return std::abs(energy) <= kEnergyRoundOff * magnitude;
}

std::vector<Vector6> expand(const Model& model, const DegreesOfFreedom& dof, const JointMaps& maps,
                            const Eigen::VectorXd& vector) {
  std::vector<Vector6> motion(model.nodes.size(), Vector6::Zero());
  std::vector<double> scalars(dof.scalar_count, 0.0);
  for (int s = 0; s < dof.scalar_count; ++s)
    if (dof.equation[s] >= 0) scalars[s] = vector[dof.equation[s]];
  for (std::size_t i = 0; i < dof.mimics.size(); ++i)
    scalars[dof.first[dof.mimics[i].slave_variable]] =
        maps.mimics[i].right * scalars[dof.first[dof.mimics[i].master_variable]];
  for (std::size_t i = 0; i < motion.size(); ++i)
    for (int k = 0; k < 6; ++k) motion[i][k] = scalars[dof.first[i] + k];
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointMap& joint = model.joints[j];
    const double* rates = &scalars[dof.first[dof.variable_of_joint(static_cast<int>(j))]];
    Vector6& slave = motion[joint.slave];
    slave.setZero();
    if (joint.kind == JointMapKind::Slide) {
      const SlideMaps& map = maps.slides[j];
      slave = rates[0] * map.released_right;
      for (int k = 0; k < map.count; ++k)
        slave += map.right[k] * motion[model.slide_lines[joint.line].nodes[map.first + k]];
      continue;
    }
    const FoldMaps& map = maps.folds[j];
    if (joint.master >= 0) {
      slave = motion[joint.master];
      slave.head<3>() += motion[joint.master].tail<3>().cross(map.lever_right);
    }
    for (int k = 0; k < map.right.cols(); ++k) slave += map.right.col(k) * rates[k];
  }
  double largest = 0;
  for (const Vector6& m : motion) largest = std::max(largest, m.cwiseAbs().maxCoeff());
  for (Vector6& m : motion) m /= largest > 0 ? largest : 1;
  return motion;
}

/// Sets the multipliers of loops to what balances the residual: their forces stiffen the mechanism as loads do.
void find_multipliers(const Model& model, StepSystem& system) {
  const DegreesOfFreedom& dof = system.degrees_of_freedom();
  const SparseAssembler& matrix = system.assembler();
  std::vector<int> multipliers;
  for (std::size_t k = 0; k < model.closures.size(); ++k)
    for (std::size_t i = 0; i < model.closures[k].constraints.size(); ++i)
      multipliers.push_back(dof.equation[dof.first[dof.variable_of_closure(static_cast<int>(k))] + i]);
  if (multipliers.empty()) return;
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(dof.unknowns, static_cast<Eigen::Index>(multipliers.size()));
  for (std::size_t m = 0; m < multipliers.size(); ++m)
    for (int p = matrix.column_starts()[multipliers[m]]; p < matrix.column_starts()[multipliers[m] + 1]; ++p)
      forces(matrix.row_indices()[p], static_cast<Eigen::Index>(m)) = matrix.values()[p];
  const Eigen::VectorXd balancing = -forces.colPivHouseholderQr().solve(system.residual());
  Eigen::VectorXd update = Eigen::VectorXd::Zero(dof.unknowns);
  for (std::size_t m = 0; m < multipliers.size(); ++m) update[multipliers[m]] = balancing[static_cast<Eigen::Index>(m)];
  system.update(update);
  if (!system.evaluate(true)) throw std::runtime_error("the stiffness is not finite");
}

}  // namespace

std::vector<Mode> natural_modes(const Model& model, const State& state, int count) {
  StepSystem system(model, *find_scheme("newmark"));
  if (count <= 0 || system.assembler().unknowns() == 0) return {};
  system.begin_static(state, 1.0);
  if (!system.evaluate(true)) throw std::runtime_error("the stiffness is not finite");
  find_multipliers(model, system);
  const DegreesOfFreedom& dof = system.degrees_of_freedom();
  const JointMaps maps = joint_maps(model, dof, state);
  SparseAssembler mass(model, dof);
  assemble_mass(model, state, maps, mass);

  // The shift makes free mechanisms solvable. A first pass finds the scale of the wanted eigenvalues, a second one with
  // a shift far below them loses no digits.
  // More modes than asked for, so that the scale is that of elastic ones where there are rigid motions.
  // Every multiplier of a loop takes two: its own, which has no mass, and the motion that it holds.
  int modes_of_motion = dof.unknowns;
  for (const LoopClosure& closure : model.closures) modes_of_motion -= 2 * static_cast<int>(closure.constraints.size());
  const int computed = std::min(count + kExtraModes, modes_of_motion);
  if (computed <= 0) return {};
  const double stiffness_trace = trace(system.assembler());
  double shift = std::max(1e-8 * stiffness_trace / trace(mass), 1e-12);
  Eigenpairs pairs = lowest(system.assembler(), mass, shift, computed);
  const double scale = *std::max_element(pairs.squared.begin(), pairs.squared.end());
  if (scale > 0) {
    shift = 1e-3 * scale;
    pairs = lowest(system.assembler(), mass, shift, computed);
  }
  std::vector<Mode> modes;
  for (std::size_t k = 0; k < pairs.squared.size(); ++k) {
    const double squared = pairs.squared[k];
    Mode mode;
    if (!is_rigid(system.assembler(), pairs.vectors[k]))
      mode.frequency = std::copysign(std::sqrt(std::abs(squared)), squared) / (2 * kPi);
    mode.node_motion = expand(model, dof, maps, pairs.vectors[k]);
    modes.push_back(mode);
  }
  std::sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) { return a.frequency < b.frequency; });
  modes.resize(std::min<std::size_t>(modes.size(), count));
  return modes;
}

}  // namespace flexarm
