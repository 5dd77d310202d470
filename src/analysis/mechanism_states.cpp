#include "analysis/mechanism_states.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>

#include "joints/joint_map.h"
#include "math/least_squares.h"
#include "math/picked.h"
#include "math/so3.h"

namespace flexarm {
namespace {

Model undriven(Model model) {
  for (Coordinate& coordinate : model.coordinates) coordinate.motion = -1;
  return model;
}

/// Rotation vector from `from` to `to`, in the axes to which both orientations are relative.
Vector3 rotation_between(const Quaternion& from, const Quaternion& to) {
  return so3::log(Quaternion(to * from.conjugate()));
}

}  // namespace

MechanismStates::MechanismStates(const Model& model, const MechanismMotion& reference)
    : model_(undriven(model)), dof_(model_), maps_(model_, dof_), reference_(reference) {
  std::vector<bool> is_driven(maps_.columns(), false);
  for (std::size_t c = 0; c < model.coordinates.size(); ++c)
    if (const int column = dof_.equation[dof_.scalar_of(model.coordinates[c])]; column >= 0)
      is_driven[column] = model.coordinates[c].motion >= 0;
  independent_ = maps_.split(reference_.pose, is_driven).independent;
  const std::vector<int> scalars = maps_.scalars_of_columns();
  for (const int column : independent_) {
    if (is_driven[column]) continue;
    columns_.push_back(column);
    scalars_.push_back(scalars[column]);
  }
  rotors_ = separate_rotors(model, dof_);
  for (int i = 0; i < dof_.node_count; ++i)
    if (const int column = dof_.equation[dof_.first[i] + 3]; column >= 0) spins_.push_back(column);
  for (const Coordinate& coordinate : model.coordinates)
    if (const int column = dof_.equation[dof_.scalar_of(coordinate)];
        column >= 0 && coordinate.is_angle && coordinate.component % 3 == 0)
      spins_.push_back(column);
  rates_ = rates(reference_);
}

Eigen::VectorXd MechanismStates::places(const MechanismPose& pose) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(maps_.columns());
  const NodePose world;
  for (int i = 0; i < dof_.node_count; ++i) {
    const int column = dof_.equation[dof_.first[i]];
    if (column < 0) continue;
    const int carrier = maps_.carrier(i);
    const auto seen = [&](const MechanismPose& all) {
      const NodePose &own = all.nodes[i], &frame = carrier < 0 ? world : all.nodes[carrier];
      const Quaternion back = frame.orientation.conjugate();
      return NodePose{back * (own.position - frame.position), back * own.orientation, Matrix3::Identity()};
    };
    const NodePose before = seen(reference_.pose), after = seen(pose);
    out.segment<3>(column) = after.position - before.position;
    out.segment<3>(column + 3) = rotation_between(before.orientation, after.orientation);
  }
  for (const Coordinate& coordinate : model_.coordinates) {
    const int column = dof_.equation[dof_.scalar_of(coordinate)], k = coordinate.component % 3;
    if (column < 0) continue;
    const Released &before = reference_.pose.released[coordinate.joint], &after = pose.released[coordinate.joint];
    out[column] = coordinate.is_angle ? rotation_between(before.rotation, after.rotation)[k]
                                      : after.displacement[k] - before.displacement[k];
  }
  return out;
}

Eigen::VectorXd MechanismStates::rates(const MechanismMotion& motion) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(maps_.columns());
  for (int i = 0; i < dof_.node_count; ++i) {
    const int column = dof_.equation[dof_.first[i]];
    if (column < 0) continue;
    Vector6 seen = motion.rates.nodes[i];
    if (const int carrier = maps_.carrier(i); carrier >= 0) {
      const NodePose& frame = motion.pose.nodes[carrier];
      const Vector3 arm = motion.pose.nodes[i].position - frame.position;
      seen -= motion.rates.nodes[carrier];
      seen.head<3>() -= motion.rates.nodes[carrier].tail<3>().cross(arm);
      seen.head<3>() = (frame.rotation.transpose() * seen.head<3>()).eval();
      seen.tail<3>() = (frame.rotation.transpose() * seen.tail<3>()).eval();
    }
    out.segment<6>(column) = seen;
  }
  for (std::size_t c = 0; c < model_.coordinates.size(); ++c)
    if (const int column = dof_.equation[dof_.scalar_of(model_.coordinates[c])]; column >= 0)
      out[column] = motion.rates.coordinates[c];
  return out;
}

// For a rotation exp(t) R with the spin w: dt/dtime = dw + w x t.
Eigen::VectorXd MechanismStates::turning(const Eigen::VectorXd& turned) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(turned.size());
  for (const int column : spins_)
    out.segment<3>(column) = Vector3(rates_.segment<3>(column)).cross(Vector3(turned.segment<3>(column)));
  return out;
}

Eigen::VectorXd MechanismStates::deviation(const MechanismMotion& motion) const {
  const Eigen::VectorXd way = places(motion.pose), rate = rates(motion) - rates_ + turning(way);
  const auto count = static_cast<Eigen::Index>(rotors_.size());
  Eigen::VectorXd turns(count), spins(count);
  for (Eigen::Index r = 0; r < count; ++r) {
    const int rotor = rotors_[r];
    turns[r] = motion.rotors[rotor] - reference_.rotors[rotor];
    spins[r] = motion.rates.rotors[rotor] - reference_.rates.rotors[rotor];
  }
  Eigen::VectorXd out(size());
  out << picked_rows(way, columns_), turns, picked_rows(rate, columns_), spins;
  return out;
}

MechanismMotion MechanismStates::moved(int state, double way) const {
  assert(state >= 0 && state < size());
  const int place = state % positions(), own_count = static_cast<int>(columns_.size());
  const bool is_rate = state >= positions(), is_rotor = place >= own_count;
  const int column = is_rotor ? -1 : columns_[place];
  const Eigen::MatrixXd maps = maps_.at(reference_.pose);
  Eigen::VectorXd turned = Eigen::VectorXd::Zero(maps_.columns());
  if (!is_rate && !is_rotor) {
    const auto free = std::lower_bound(independent_.begin(), independent_.end(), column) - independent_.begin();
    turned = way * maps_.allowed(reference_.pose, maps, independent_).col(free);
  }
  MechanismMotion out;
  out.pose = maps_.moved(reference_.pose, {turned, Eigen::VectorXd::Zero(turned.size())}, 1);
  Eigen::VectorXd rate = rates_ - turning(turned);
  if (is_rate && !is_rotor) rate[column] += way;
  const Eigen::MatrixXd own = maps_.at(out.pose);
  const Eigen::VectorXd columns = maps_.allowed(out.pose, own, independent_) * picked_rows(rate, independent_),
                        rows = own * columns;
  for (int i = 0; i < dof_.node_count; ++i) {
    Vector6 velocity = rows.segment<6>(dof_.first[i]);
    velocity.tail<3>() = (out.pose.nodes[i].rotation * velocity.tail<3>()).eval();
    out.rates.nodes.push_back(velocity);
  }
  for (const Coordinate& coordinate : model_.coordinates)
    out.rates.coordinates.push_back(rows[dof_.scalar_of(coordinate)]);
  out.rotors = reference_.rotors;
  out.rates.rotors = reference_.rates.rotors;
  if (is_rotor) (is_rate ? out.rates.rotors : out.rotors)[rotors_[place - own_count]] += way;
  return out;
}

}  // namespace flexarm
