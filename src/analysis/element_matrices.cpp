#include "analysis/element_matrices.h"

#include "elements/element_configuration.h"
#include "elements/orders.h"
#include "solver/sparse_tangent.h"

namespace flexarm {

template <int Nodes>
Eigen::MatrixXd mass_matrix(const BeamElement<Nodes>& element, const State& state) {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(6 * Nodes, 6 * Nodes);
  const LocalRotationVariation<Nodes> local{
      LocalRotations<Nodes>(ElementConfiguration<Nodes>(element, state).orientation)};
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j) mass.block<3, 3>(6 * i, 6 * j).diagonal().array() += element.mass(i, j);
  for (const auto& point : element.mass_points) {
    GeneralisedShapeFunctions<Nodes> generalised;
    const Matrix3 rotation = local.evaluate(point.shape, point.derivative, generalised).rotation;
    const Matrix3 inertia = point.weight * rotation * point.inertia * rotation.transpose();
    for (int i = 0; i < Nodes; ++i)
      for (int j = 0; j < Nodes; ++j)
        mass.block<3, 3>(6 * i + 3, 6 * j + 3) += point.shape[i] * inertia * generalised.values[j];
  }
  return mass;
}

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes) template decltype(mass_matrix<Nodes>) mass_matrix<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

void add_element(SparseTangent& sum, std::size_t first, const Eigen::MatrixXd& matrix) {
  const int nodes = static_cast<int>(matrix.rows()) / 6;
  for (int i = 0; i < nodes; ++i)
    for (int j = 0; j < nodes; ++j)
      Eigen::Map<Matrix6>(sum.element_block(first + i * nodes + j)) += matrix.block<6, 6>(6 * i, 6 * j);
}

}  // namespace flexarm
