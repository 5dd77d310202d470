#include "integrators/step_space.h"

#include <vector>

#include "integrators/planar_beams.h"
#include "integrators/step_plane.h"
#include "model/plane_finder.h"
#include "solver/planar_tangent.h"

namespace flexarm {

struct StepSpace::InPlane {
  InPlane(const StepConfiguration& configuration, PlaneOfMotion found);

  PlaneOfMotion plane;
  PlanarBeams beams;
  PlanarTangent tangent;
  std::vector<Vector3> joint_normals;  // normal of the plane in the frame of each joint
  bool is_sure = false;                // whether the end of the last step lies in the plane
};

StepSpace::InPlane::InPlane(const StepConfiguration& configuration, PlaneOfMotion found)
    : plane(std::move(found)),
      beams(configuration, plane),
      tangent(configuration.model(), configuration.degrees_of_freedom(), plane) {
  for (const JointMap& joint : configuration.model().joints) {
    const Vector3 normal = joint.master >= 0 ? plane.material_normal(joint.master) : plane.normal;
    joint_normals.push_back(joint.origin.orientation.conjugate() * normal);
  }
}

StepSpace::StepSpace(const StepConfiguration& configuration, const StepPrestrains& prestrains, BackendChoice backend,
                     Space space)
    : configuration_(configuration),
      spatial_family_(make_scheme_family(configuration, prestrains)),
      spatial_tangent_(make_tangent_backend(configuration.model(), configuration.degrees_of_freedom(), backend)),
      family_(spatial_family_.get()),
      tangent_(spatial_tangent_.get()) {
  if (spatial_family_->evaluates_packs()) spatial_tangent_->condense_interiors();
  if (space == Space::ThreeDimensional) return;
  PlaneSearch search = find_step_plane(configuration.model(), configuration.scheme());
  if (search.plane) plane_ = std::make_unique<InPlane>(configuration, std::move(*search.plane));
}

StepSpace::~StepSpace() = default;

void StepSpace::choose(const State& state) {
  if (!plane_) return;
  const Model& model = configuration_.model();
  plane_->is_sure =
      acts_in_plane(model, plane_->plane, state) && (plane_->is_sure || lies_in_plane(model, plane_->plane, state));
  SchemeFamily* const before = family_;
  family_ = plane_->is_sure ? &plane_->beams : spatial_family_.get();
  tangent_ = plane_->is_sure ? static_cast<TangentBackend*>(&plane_->tangent) : spatial_tangent_.get();
  if (family_ != before) family_->invalidate();
}

void StepSpace::tidy(IncrementHistory& history) const {
  if (!plane_ || tangent_ != &plane_->tangent) return;
  const DegreesOfFreedom& dof = configuration_.degrees_of_freedom();
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
    tidy_travel(equation, plane_->plane.normal);
    tidy_turn(equation + 3, plane_->plane.normal);
  }
  for (int j = 0; j < dof.joint_count; ++j) {
    const int variable = dof.variable_of_joint(j);
    if (dof.size[variable] < 3) continue;
    const int equation = dof.equation[dof.first[variable]];
    if (dof.size[variable] == 6) tidy_travel(equation, plane_->joint_normals[j]);
    tidy_turn(equation + dof.size[variable] - 3, plane_->joint_normals[j]);
  }
}

void StepSpace::invalidate() {
  spatial_family_->invalidate();
  if (!plane_) return;
  plane_->is_sure = false;
  plane_->beams.invalidate();
}

}  // namespace flexarm
