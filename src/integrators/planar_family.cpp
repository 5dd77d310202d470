#include "integrators/planar_family.h"

#include "integrators/planar_beams.h"
#include "integrators/planar_endpoint_beams.h"

namespace flexarm {

PlanarFamily::PlanarFamily(const StepConfiguration& configuration, const PlaneOfMotion& plane)
    : configuration_(configuration),
      plane_(plane),
      rule_(configuration.scheme()),
      begin_poses_(configuration.model().nodes.size()),
      end_poses_(begin_poses_.size()),
      forces_(begin_poses_.size()),
      carried_(begin_poses_.size()) {
  const Model& model = configuration.model();
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const Quaternion& frame = plane.frames[i];
    frames_.push_back(
        {frame.coeffs(), (Quaternion(0, plane.normal.x(), plane.normal.y(), plane.normal.z()) * frame).coeffs()});
    const Vector3 normal = plane.material_normal(static_cast<int>(i));
    material_normals_.push_back(normal);
    const NodalInertia& inertia = model.inertias[i];
    Matrix3 rotary = inertia.rotary;
    if (rule_.nodal_rotary_inertia) rotary += inertia.beam_rotary;
    if (inertia.mass != 0 || !rotary.isZero(0))
      inertias_.push_back({static_cast<int>(i), inertia.mass, normal.dot(rotary * normal)});
  }
}

PlanarPose PlanarFamily::pose(std::size_t node, const NodePose& at) const {
  const Frame& frame = frames_[node];
  const auto& q = at.orientation.coeffs();
  return {plane_.first.dot(at.position), plane_.second.dot(at.position), q.dot(frame.cosine), q.dot(frame.sine)};
}

void PlanarFamily::set_begin_poses() {
  for (std::size_t i = 0; i < begin_poses_.size(); ++i) begin_poses_[i] = pose(i, configuration_.begin()[i]);
}

void PlanarFamily::hand_over(Balance& balance) const {
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    const int node = static_cast<int>(i);
    balance.residual.node(node) += in_space(forces_[i]);
    if (balance.carried) balance.carried->node(node) += in_space(carried_[i]);
  }
}

std::unique_ptr<BeamFamily> make_planar_family(const StepConfiguration& configuration, const PlaneOfMotion& plane) {
  if (configuration.scheme().stress == StressRule::EndPoint)
    return std::make_unique<PlanarEndpointBeams>(configuration, plane);
  return std::make_unique<PlanarBeams>(configuration, plane);
}

}  // namespace flexarm
