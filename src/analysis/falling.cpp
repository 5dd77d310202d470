#include "analysis/falling.h"

#include "analysis/linearised_motion.h"
#include "math/least_squares.h"

namespace flexarm {
namespace {

/// Forces below this part of weight and loads are the tolerance of an equilibrium.
constexpr double kInBalance = 1e-6;
/// Accelerations that differ by less from gravity are gravity, so that both cancel to the last bit.
constexpr double kFreeFall = 1e-9;

/// Ways in which a joint on the world lets its slave move without turning.
struct Ways {
  std::vector<int> scalars;  ///< of DegreesOfFreedom
  Eigen::Matrix3Xd columns;  ///< direction of each [m per unit], world axes
};

Ways ways_of(const Kinematics& kinematics, int joint) {
  const Model& model = kinematics.model();
  const DegreesOfFreedom& dof = kinematics.degrees_of_freedom();
  const ReleasedColumns& columns = kinematics.joint(joint).right;
  Ways out{{}, Eigen::Matrix3Xd(3, columns.cols())};
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    const int scalar = dof.first[dof.variable_of_joint(joint)] + static_cast<int>(k);
    const bool is_driven = model.coordinates[model.first_coordinate[joint] + k].motion >= 0;
    if (is_driven || dof.equation[scalar] < 0 || !columns.col(k).tail<3>().isZero(0)) continue;
    out.columns.col(static_cast<Eigen::Index>(out.scalars.size())) = columns.col(k).head<3>();
    out.scalars.push_back(scalar);
  }
  out.columns.conservativeResize(3, static_cast<Eigen::Index>(out.scalars.size()));
  return out;
}

/// Whether something else than joints on the world may tell its parts where to be.
bool is_tied(const Model& model, const DegreesOfFreedom& dof) {
  for (const LoopClosure& closure : model.closures)
    if (closure.parent < 0) return true;
  return !dof.mimics.empty();
}

/// Per node: the joint on the world that carries it, or -1.
std::vector<int> carriers(const Model& model) {
  std::vector<int> out(model.nodes.size(), -1);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    if (model.joints[j].master < 0 && model.joints[j].kind != JointMapKind::Slide)
      out[model.joints[j].slave] = static_cast<int>(j);
  for (std::size_t i = 0; i < out.size(); ++i)  // parents come before their children
    if (const int parent = model.node_parents[i]; out[i] < 0 && parent >= 0) out[i] = out[parent];
  return out;
}

/// Accelerations along the ways by which `force` moves a mass [m/s^2]. Rotors that turn with the ways have inertia,
/// too.
Eigen::VectorXd accelerations(const Model& model, const DegreesOfFreedom& dof, const Ways& ways, double mass,
                              const Eigen::VectorXd& force) {
  Eigen::MatrixXd inertia = mass * ways.columns.transpose() * ways.columns;
  for (const Coordinate& coordinate : model.coordinates)
    for (std::size_t k = 0; k < ways.scalars.size(); ++k)
      if (dof.scalar_of(coordinate) == ways.scalars[k])
        inertia.diagonal()[static_cast<Eigen::Index>(k)] += armature(model, coordinate);
  return square_solution(inertia, force);
}

void add_inertia(const NodalInertia& inertia, std::size_t node, const Vector3& acceleration, Fall& fall) {
  if (inertia.total_mass == 0) return;
  fall.inertia.emplace_back();
  fall.inertia.back().node = static_cast<int>(node);
  fall.inertia.back().force = -inertia.total_mass * acceleration;
}

}  // namespace

Fall fall_of(const Model& model, const DegreesOfFreedom& dof, const State& state, const Eigen::VectorXd& residual) {
  Fall fall;
  if (is_tied(model, dof)) return fall;
  const std::vector<int> carried_by = carriers(model);
  const Kinematics kinematics(model, dof, configuration_of(state));
  const double balanced = kInBalance * work_of_forces(model, state) / model.length_scale;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    if (model.joints[j].master >= 0 || model.joints[j].kind == JointMapKind::Slide) continue;
    const Ways ways = ways_of(kinematics, j);
    double mass = 0;
    for (std::size_t i = 0; i < carried_by.size(); ++i)
      if (carried_by[i] == j) mass += model.inertias[i].total_mass;
    Eigen::VectorXd force(ways.columns.cols());
    for (Eigen::Index k = 0; k < force.size(); ++k)
      force[k] = -residual[dof.equation[ways.scalars[static_cast<std::size_t>(k)]]];
    if (!(mass > 0 && force.norm() > balanced)) continue;
    const Eigen::VectorXd rates = accelerations(model, dof, ways, mass, force);
    Vector3 acceleration = ways.columns * rates;
    if ((acceleration - model.gravity).norm() < kFreeFall * model.gravity.norm()) acceleration = model.gravity;
    for (Eigen::Index k = 0; k < rates.size(); ++k)
      fall.accelerations.emplace_back(ways.scalars[static_cast<std::size_t>(k)], rates[k]);
    for (std::size_t i = 0; i < carried_by.size(); ++i)
      if (carried_by[i] == j) add_inertia(model.inertias[i], i, acceleration, fall);
  }
  return fall;
}

}  // namespace flexarm
