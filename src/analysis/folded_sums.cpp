#include "analysis/folded_sums.h"

#include "analysis/element_matrices.h"
#include "analysis/rotor_motion.h"

namespace flexarm {

double& diagonal_entry(const Kinematics& kinematics, SparseTangent& sum, int joint, int component) {
  const int count = released_count(kinematics.model().joints[joint].kind);
  return sum.diagonal_block(kinematics.degrees_of_freedom().variable_of_joint(joint))[component * count + component];
}

void add_mass(const Kinematics& kinematics, const State& state, SparseTangent& mass) {
  const Model& model = kinematics.model();
  for_each_element(model.beams,
                   [&](const auto& element) { add_element(mass, element.first_block, mass_matrix(element, state)); });
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    const Matrix3 rotation = state.nodes[i].orientation.toRotationMatrix();
    Eigen::Map<Matrix6> block(mass.diagonal_block(static_cast<int>(i)));
    block.topLeftCorner<3, 3>().diagonal().array() += inertia.mass;
    block.bottomRightCorner<3, 3>() += rotation * inertia.rotary * rotation.transpose();
  }
  for (const ActuatorTerms& terms : actuator_terms(model, state))
    diagonal_entry(kinematics, mass, terms.joint, terms.component) += terms.mass;
}

void fold(const Kinematics& kinematics, SparseTangent& sum) {
  const JointList& joints = kinematics.model().joints;
  for (int j = static_cast<int>(joints.size()) - 1; j >= 0; --j) {
    if (joints[j].kind == JointMapKind::Slide)
      sum.fold(j, kinematics.slide(j));
    else
      sum.fold(j, kinematics.joint(j));
  }
  std::vector<MimicMap> mimics;
  for (std::size_t i = 0; i < kinematics.degrees_of_freedom().mimics.size(); ++i)
    mimics.push_back({kinematics.mimic(i), kinematics.mimic(i), 0});
  sum.fold_mimics(mimics);
  sum.finish();
}

}  // namespace flexarm
