#include "integrators/planar_step.h"

#include "integrators/step_plane.h"

namespace flexarm {

PlanarStep::PlanarStep(const StepConfiguration& configuration, PlaneOfMotion found)
    : plane(std::move(found)),
      beams(configuration, plane),
      tangent(configuration.model(), configuration.degrees_of_freedom(), plane) {
  const Model& model = configuration.model();
  for (const JointMap& joint : model.joints) {
    const Vector3 normal = joint.master >= 0 ? plane.material_normal(joint.master) : plane.normal;
    joint_normals.push_back(joint.origin.orientation.conjugate() * normal);
  }
}

void PlanarStep::tidy(const StepConfiguration& configuration, IncrementHistory& history) const {
  const DegreesOfFreedom& dof = configuration.degrees_of_freedom();
  std::vector<double>& made = history.increments[0];
  const auto tidy_travel = [&](int equation, const Vector3& normal) {
    Eigen::Map<Vector3> travel(made.data() + equation);
    travel -= normal.dot(travel) * normal;
  };
  const auto tidy_turn = [&](int equation, const Vector3& normal) {
    Eigen::Map<Vector3> turn(made.data() + equation);
    turn = normal.dot(turn) * normal;
  };
  for (int i = 0; i < dof.node_count; ++i) {
    const int equation = dof.equation[dof.first[i]];
    if (equation < 0) continue;
    tidy_travel(equation, plane.normal);
    tidy_turn(equation + 3, plane.normal);
  }
  for (int j = 0; j < dof.joint_count; ++j) {
    const int variable = dof.variable_of_joint(j);
    if (dof.size[variable] < 3) continue;
    const int equation = dof.equation[dof.first[variable]];
    if (dof.size[variable] == 6) tidy_travel(equation, joint_normals[j]);
    tidy_turn(equation + dof.size[variable] - 3, joint_normals[j]);
  }
}

bool PlanarStep::choose(const Model& model, const State& state) {
  const bool was_on = is_on;
  is_on = acts_in_plane(model, plane, state) && (is_sure || lies_in_plane(model, plane, state));
  is_sure = is_on;
  return is_on != was_on;
}

std::unique_ptr<PlanarStep> make_planar_step(const StepConfiguration& configuration) {
  PlaneSearch search = find_step_plane(configuration.model(), configuration.scheme());
  return search.plane ? std::make_unique<PlanarStep>(configuration, std::move(*search.plane)) : nullptr;
}

}  // namespace flexarm
