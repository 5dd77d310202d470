#include "elements/additive_to_spins.h"

#include "elements/orders.h"
#include "math/so3.h"

namespace flexarm {

template <int Nodes>
void additive_to_spins(const ElementNodes<Nodes>& nodes, bool with_tangent, ElementSystem<Nodes>& system) {
  for (int i = 0; i < Nodes; ++i) {
    const so3::ExponentialMap<double> map(nodes.rotation_vector[i]), opposite(Vector3(-nodes.rotation_vector[i]));
    const Matrix3 inverse = map.inverse_tangent();
    const Vector3 moment = system.residual.template segment<3>(6 * i + 3);
    system.residual.template segment<3>(6 * i + 3) = inverse.transpose() * moment;
    if (!with_tangent) continue;
    auto rows = system.tangent.template middleRows<3>(6 * i + 3);
    rows = (inverse.transpose() * rows).eval();
    rows.template middleCols<3>(6 * i + 3) -= opposite.xi_inverse_tangent(moment);  // T^{-T}(theta) = T^{-1}(-theta)
  }
  for (int j = 0; j < Nodes && with_tangent; ++j) {
    auto columns = system.tangent.template middleCols<3>(6 * j + 3);
    columns = (columns * so3::inverse_tangent(nodes.rotation_vector[j])).eval();
  }
}

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes) template decltype(additive_to_spins<Nodes>) additive_to_spins<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
