#include "integrators/initial_strain_memory.h"

#include "elements/element_configuration.h"

namespace flexarm {

std::vector<StrainMemory> initial_strain_memory(const Model& model, const State& state) {
  std::vector<StrainMemory> memories(model.stiffness_point_count);
  for_each_element(model.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const ElementConfiguration<N> nodes(element, state);
    const LocalRotationVariation<N> local{LocalRotations<N>(nodes.orientation)};
    for (int k = 0; k < N - 1; ++k) {
      const auto& constants = element.stiffness_points[k];
      GeneralisedShapeFunctions<N> functions;
      const PointKinematics point =
          point_kinematics(local.evaluate(constants.shape, constants.derivative, functions),
                           interpolate<N>(constants.derivative, nodes.position), constants.reference_strain);
      Eigen::Matrix<double, 9, 1> rate = Eigen::Matrix<double, 9, 1>::Zero();  // of {r', spin, spin'}
      rate.head<3>() = interpolate<N>(constants.derivative, nodes.velocity);
      for (int i = 0; i < N; ++i) {
        rate.segment<3>(3) += functions.values[i] * nodes.spin[i];
        rate.tail<3>() += functions.derivatives[i] * nodes.spin[i];
      }
      StrainMemory& memory = memories[element.first_stiffness_point + k];
      memory.rate = memory.delayed_rate = strain_derivative(point) * rate;
    }
  });
  return memories;
}

}  // namespace flexarm
