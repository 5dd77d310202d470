#include "integrators/drag.h"

#include <algorithm>
#include <cassert>

#include "math/cayley.h"

namespace flexarm {

Vector3 Drag::displacement(std::size_t node) const {
  return (configuration_.end()[node].position - configuration_.begin()[node].position) /
         configuration_.model().length_scale;
}

Vector3 Drag::turn(std::size_t node) const {
  return cayley::increment(configuration_.begin()[node].orientation, configuration_.end()[node].orientation);
}

void Drag::evaluate(Balance& balance) const {
  assert(strength == 0 || configuration_.scheme().is_static);
  if (strength == 0) return;
  const double length = configuration_.model().length_scale;
  for (std::size_t i = 0; i < configuration_.end().size(); ++i) {
    const int node = static_cast<int>(i);
    const Vector3 increment = turn(i);
    balance.residual.node(node).head<3>() += strength / length * displacement(i);
    balance.residual.node(node).tail<3>() += strength * increment;
    if (!balance.tangent) continue;
    Eigen::Map<Matrix6> tangent(balance.tangent->diagonal_block(node));
    tangent.topLeftCorner<3, 3>().diagonal().array() += strength / (length * length);
    tangent.bottomRightCorner<3, 3>() += strength * cayley::inverse_tangent(increment);
  }
}

double Drag::largest_way() const {
  double largest = 0;
  for (std::size_t i = 0; i < configuration_.end().size(); ++i)
    largest = std::max({largest, displacement(i).norm(), turn(i).norm()});
  return largest;
}

}  // namespace flexarm
