#include "integrators/joint_fold.h"

#include <algorithm>
#include <type_traits>

#include "joints/joint_forces.h"
#include "math/cayley.h"

namespace flexarm {
JointFold::JointFold(const StepConfiguration& configuration, const JointEfforts& efforts, DryFrictionStep& friction,
                     const Actuators& actuators)
    : configuration_(configuration),
      efforts_(efforts),
      friction_(friction),
      actuators_(actuators),
      is_resisted_(configuration.model().joints.size_with_held(), false),
      slide_maps_(most_active_nodes(configuration.model().slide_lines)),
      mimic_maps_(configuration.degrees_of_freedom().mimics.size()) {
  for (const Coordinate& coordinate : configuration.model().coordinates) {
    if (resists(coordinate) || coordinate.sticks) is_resisted_[coordinate.joint] = true;
  }
}

void JointFold::add_efforts(int j, Balance& balance) {
  const Model& model = configuration_.model();
  const int count = released_count(model.joints[j].kind);
  if (count == 0) return;
  double* residual = balance.residual.at(configuration_.degrees_of_freedom().variable_of_joint(j));
  for (int k = 0; k < count; ++k) {
    const std::size_t index = model.first_coordinate[j] + k;
    const Coordinate& coordinate = model.coordinates[index];
    if (has_motor(coordinate)) continue;
    residual[k] -= configuration_.effort_weight() * efforts_.of(index).acting;
  }
  if (is_resisted_[j]) add_resistance(j, balance);
}

void JointFold::add_resistance(int j, Balance& balance) {
  const Model& model = configuration_.model();
  const int count = released_count(model.joints[j].kind);
  const int variable = configuration_.degrees_of_freedom().variable_of_joint(j);
  double* residual = balance.residual.at(variable);
  const ReleasedVector change =
      configuration_.scheme().is_static ? ReleasedVector(ReleasedVector::Zero(count)) : configuration_.increment_of(j);
  const double weight = configuration_.effort_weight();
  for (int k = 0; k < count; ++k) {
    const std::size_t index = model.first_coordinate[j] + k;
    const Coordinate& coordinate = model.coordinates[index];
    const CoordinateStep moved = configuration_.coordinate_step(index, change[k]);
    const PassiveEffort passive = passive_effort(coordinate, moved);
    const PassiveEffort friction = friction_.constant_effort(static_cast<int>(index), moved);
    balance.dissipated += passive.dissipated + friction.dissipated;
    residual[k] -= weight * (passive.effort + friction.effort);
    const double slope = weight * (passive.slope + friction.slope);
    if (!balance.tangent || slope == 0) continue;
    Eigen::Map<ReleasedSquare> tangent(balance.tangent->diagonal_block(variable), count, count);
    if (coordinate.is_angle) {  // the increment's variation is S^{-1} spin
      const Vector3 rotation = change.tail<3>();
      tangent.row(k).tail<3>() -= slope * cayley::inverse_tangent(rotation).row(k - (count - 3));
    } else {
      tangent(k, k) -= slope;
    }
  }
}

/// The force on the slave that the geometric parts of a joint's maps use: the residual, with carried stresses if any.
Vector6 JointFold::force_on_slave(int j, const Balance& balance) const {
  const int slave = configuration_.model().joints[j].slave;
  const ReducedResidual& residual = balance.residual;
  if (!balance.carried) return residual.node(slave);
  return residual.node(slave) + balance.carried->node(slave);
}

template <class Maps>
void JointFold::fold(int j, Maps& maps, Balance& balance) {
  const Vector6 g = force_on_slave(j, balance);
  configuration_.joint_maps(j, g, maps, balance.tangent != nullptr);
  friction_.add_normal(j, g, maps, balance);
  if constexpr (std::is_same_v<Maps, FoldMaps>)
    if (balance.tangent) actuators_.add_gyroscope(j, maps);
  balance.residual.fold(j, maps);
  if (balance.carried) balance.carried->fold(j, maps);
}

void JointFold::evaluate(Balance& balance) {
  const JointList& joints = configuration_.model().joints;
  friction_.begin_evaluation();
  for (int j = static_cast<int>(joints.size()) - 1; j >= 0; --j) {
    if (joints[j].kind == JointMapKind::Slide)
      fold(j, balance.tangent ? balance.tangent->slide_maps(j) : slide_maps_, balance);
    else
      fold(j, balance.tangent ? balance.tangent->fold_maps(j) : fold_maps_, balance);
    if (balance.tangent) balance.tangent->fold(j);
    add_efforts(j, balance);
  }
  const std::vector<DegreesOfFreedom::Mimic>& mimics = configuration_.degrees_of_freedom().mimics;
  for (std::size_t i = 0; i < mimics.size(); ++i) mimic_maps_[i] = configuration_.mimic_map(mimics[i].coordinate);
  balance.residual.fold_mimics(mimic_maps_);
  if (balance.tangent) balance.tangent->fold_mimics(mimic_maps_);
}

void JointFold::accept(State& state) const {
  std::copy(configuration_.released().begin(), configuration_.released().end(), state.released.begin());
}

}  // namespace flexarm
