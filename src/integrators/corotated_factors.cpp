#include "integrators/corotated_factors.h"

namespace flexarm {

CorotatedFactors::CorotatedFactors(const StepConfiguration& configuration, TangentBackend& tangent)
    : configuration_(configuration), tangent_(tangent) {
  const DegreesOfFreedom& dof = configuration.degrees_of_freedom();
  for (int i = 0; i < dof.node_count; ++i)
    if (dof.slave_joint[i] < 0) free_nodes_.push_back({i, dof.equation[dof.first[i]]});
  made_at_.assign(free_nodes_.size(), Matrix3::Identity());
  turns_ = made_at_;
}

bool CorotatedFactors::make() {
  for (std::size_t i = 0; i < free_nodes_.size(); ++i)
    made_at_[i] = configuration_.end()[free_nodes_[i].node].rotation;
  return tangent_.factorise();
}

bool CorotatedFactors::solve_turned(Eigen::VectorXd& b) {
  const auto turn = [&](std::size_t i, const Matrix3& rotation) {
    for (const int first : {free_nodes_[i].equation, free_nodes_[i].equation + 3}) {
      const Vector3 turned = rotation * b.segment<3>(first);
      b.segment<3>(first) = turned;
    }
  };
  for (std::size_t i = 0; i < free_nodes_.size(); ++i) {
    turns_[i] = configuration_.end()[free_nodes_[i].node].rotation * made_at_[i].transpose();
    turn(i, turns_[i].transpose());
  }
  if (!tangent_.solve(b)) return false;
  for (std::size_t i = 0; i < free_nodes_.size(); ++i) turn(i, turns_[i]);
  return true;
}

}  // namespace flexarm
