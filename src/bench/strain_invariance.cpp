#include "bench/strain_invariance.h"

#include <algorithm>

#include "bench/scenes.h"
#include "building/model_builder.h"
#include "math/so3.h"
#include "simulation/observables.h"
#include "study_schemes/rotation_reference.h"

namespace flexarm::bench {
namespace {

constexpr int kNodes = 3, kSteps = 2, kIterates = 2;

/// Rotation of node i at the fraction `part`, in (0, 1], of the path; not proportional to `part`.
Quaternion node_rotation(int i, double part) {
  const Vector3 along(0.8 * i, -0.5 * i, 0.6 * i), aside(0.2, 0.3 * i, -0.1);
  return so3::exp_quaternion(Vector3(part * along + std::sin(3 * part) * aside));
}

/// Curvatures at the end, with a superposed rotation that grows to `rigid` (a rotation vector) in proportion to the
/// path.
std::vector<Vector3> curvatures(const Scheme& scheme, const Vector3& rigid) {
  const Model model = build_model(cantilever(1, kNodes - 1));
  State state = initial_state(model);
  RotationReference reference(model, scheme);
  reference.initialise(state);
  std::vector<NodePose> nodes = model.nodes;
  const auto& element = std::get<BeamGroup<kNodes>>(model.beams).elements.front();
  for (int step = 0; step < kSteps; ++step) {
    reference.begin(state);
    for (int iterate = 1; iterate <= kIterates; ++iterate) {
      const double part = (step + static_cast<double>(iterate) / kIterates) / kSteps;
      for (int i = 0; i < kNodes; ++i) {
        const int node = element.nodes[i];
        nodes[node].orientation =
            so3::exp_quaternion(Vector3(part * rigid)) * node_rotation(i, part) * model.nodes[node].orientation;
        nodes[node].rotation = nodes[node].orientation.toRotationMatrix();
      }
      reference.set_trial(nodes);
    }
    reference.accept(state);
    for (std::size_t i = 0; i < nodes.size(); ++i) state.nodes[i].orientation = nodes[i].orientation;
  }
  std::vector<Vector3> out;
  if (reference.is_used()) {
    for (const PointRotation& point : state.study.stiffness_rotations) out.push_back(point.curvature);
    return out;
  }
  std::array<Quaternion, kNodes> orientation;
  for (int i = 0; i < kNodes; ++i) orientation[i] = nodes[element.nodes[i]].orientation;
  const LocalRotations<kNodes> local(orientation);
  for (const auto& point : element.stiffness_points)
    out.push_back(local.evaluate(point.shape, point.derivative).curvature);
  return out;
}

}  // namespace

double strain_change(const Variant& variant) {
  const std::vector<Vector3> as_is = curvatures(variant.scheme, Vector3::Zero());
  const std::vector<Vector3> turned = curvatures(variant.scheme, 1.2 * Vector3(2, -1, 2) / 3);
  double change = 0, largest = 0;
  for (std::size_t i = 0; i < as_is.size(); ++i) {
    change = std::max(change, (turned[i] - as_is[i]).norm());
    largest = std::max(largest, as_is[i].norm());
  }
  return change / largest;
}

}  // namespace flexarm::bench
