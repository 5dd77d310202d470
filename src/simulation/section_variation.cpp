#include "simulation/section_variation.h"

#include "analysis/element_matrices.h"
#include "math/so3.h"
#include "simulation/beam_sections.h"

namespace flexarm {
namespace {

struct SectionVariation {
  std::vector<int> nodes;
  Eigen::MatrixXd strain, resultant;  // about the mass centroid
};

SectionVariation section_variation(const Model& model, const State& state, const ProbePoint& point) {
  SectionVariation out;
  visit_element(model, *model.links[point.link].beam, point.element, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    out.nodes.assign(element.nodes.begin(), element.nodes.end());
    out.strain = out.resultant = Eigen::MatrixXd::Zero(6, 6 * N);
    const std::array<double, N - 1> weights = extension_weights<N>(point.xi);
    const std::vector<Eigen::MatrixXd> variations = strain_variations(element, state);
    for (int k = 0; k < N - 1; ++k) {
      out.strain += weights[k] * variations[k];
      out.resultant += weights[k] * element.stiffness_points[k].stiffness.lazyProduct(variations[k]);
    }
  });
  return out;
}

}  // namespace

double NodalGradient::along(const std::vector<Vector6>& velocities) const {
  double sum = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    sum += row.segment<6>(6 * static_cast<Eigen::Index>(i)).dot(velocities[nodes[i]]);
  return sum;
}

NodalGradient fibre_strain_gradient(const Model& model, const State& state, const ProbePoint& point) {
  const SectionVariation section = section_variation(model, state, point);
  // From the mass centroid, beside which the sensor stands, comes K x d.
  const Vector3 beside = point.offset.position;
  return {section.nodes, section.strain.row(0) - so3::hat(beside).row(0) * section.strain.bottomRows<3>()};
}

NodalGradient section_force_gradient(const Model& model, const State& state, const ProbePoint& point, int component) {
  const SectionVariation section = section_variation(model, state, point);
  const Vector3 centroid = model.links[point.link].beam->centroid;
  Eigen::RowVectorXd row = section.resultant.row(component);
  if (component >= 3) row += so3::hat(centroid).row(component - 3) * section.resultant.topRows<3>();
  return {section.nodes, row};
}

}  // namespace flexarm
