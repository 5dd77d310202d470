// Dry friction in a step: friction that grows with the force on a joint, and sticking.
//
// Friction of the coefficient mu turns the coordinate's row left^T g into (left + mu s n)^T g, with the slave's total
// residual g, the direction n of the force that presses, and the part s in [-1, 1] by which friction acts: its effort
// is homogeneous in g. So it folds as the joint itself does, with the full tangent. (joints.md 2)
//
// A coordinate that is held has the row "increment = known" instead of its own, of which the residual is what friction
// has to hold. Branches of the set-valued law are revised between Newton's iterations: a block principal pivoting
// (Júdice and Pires, A block principal pivoting algorithm for large-scale strictly monotone linear complementarity
// problems, Computers & Operations Research 21, 1994), with one exchange at a time where those at once do not settle.
#include <algorithm>
#include <cmath>

#include "integrators/step_system.h"
#include "joints/joint_forces.h"
#include "math/cayley.h"
#include "model/model_builder.h"

namespace flexarm {
namespace {

/// Newton updates of a step in which smooth friction may stop at rate zero.
constexpr int kMostStoppedUpdates = 3;

/// Increments over a step below which a coordinate is taken to be at rest, relative to the model's length or to 1 rad.
constexpr double kAtRest = 1e-12;
/// Part of the capacity by which efforts at rest may exceed it: round-off, and where branches do not settle.
constexpr double kSlack = 1e-10, kLooseSlack = 1e-6;
/// Revisions in a solve after which only one coordinate is revised at a time, and after which slack is loose.
constexpr int kRevisionsAtOnce = 4, kTightRevisions = 10;

Contact contact_of(const JointMap& joint) {
  if (joint.kind == JointMapKind::Slide || joint.rotation.isZero(0)) return Contact::Travel;
  return joint.translation.isZero(0) ? Contact::Turn : Contact::Both;
}

bool is_angle(const Model& model, const Coordinate& coordinate) {
  return coordinate.is_angle || !model.joints[coordinate.joint].rotation.isZero(0);
}

}  // namespace

void StepSystem::find_friction() {
  std::vector<int> carrier_at(model_.coordinates.size(), -1);  // per coordinate that none mimics
  for (std::size_t index = 0; index < model_.coordinates.size(); ++index) {
    const Coordinate& coordinate = model_.coordinates[index];
    if (coordinate.friction <= 0 && coordinate.friction_coefficient <= 0) continue;
    if (!coordinate.sticks) {
      if (equation_of(coordinate) >= 0 && !coordinate.is_angle) smooth_coordinates_.push_back(static_cast<int>(index));
      continue;
    }
    if (scheme_.is_composition)
      throw ModelError("<integrator>: scheme '" + std::string(scheme_.name) +
                       "' steps backwards, in which friction of the law 'coulomb' (coordinate '" + coordinate.name +
                       "') would drive; take another scheme or the law 'smooth'");
    int base = static_cast<int>(index);
    while (model_.coordinates[base].mimicked >= 0) base = model_.coordinates[base].mimicked;
    int& c = carrier_at[base];
    if (c < 0) {
      c = static_cast<int>(carriers_.size());
      carriers_.emplace_back();
      carriers_[c].coordinate = base;
    }
    carriers_[c].members.push_back(static_cast<int>(index));
    carrier_of_[index] = c;
  }
  tangent_branches_.assign(carriers_.size(), StickSlip::Free);
  smooth_rates_.resize(smooth_coordinates_.size());
}

int StepSystem::equation_of(const Coordinate& coordinate) const {
  return dof_.equation[dof_.first[dof_.variable_of_joint(coordinate.joint)] + coordinate.component];
}

double StepSystem::increment_of(const Coordinate& coordinate) const {
  return released_increment(model_.joints[coordinate.joint], state_->released[coordinate.joint],
                            released_[coordinate.joint])[coordinate.component];
}

double StepSystem::travel_per_carrier(int coordinate) const {
  double ratio = 1;
  for (; model_.coordinates[coordinate].mimicked >= 0; coordinate = model_.coordinates[coordinate].mimicked)
    ratio *= mimic_map(coordinate).left;
  return ratio;
}

void StepSystem::begin_friction() {
  revisions_ = 0;
  const double gamma = scheme_.is_incremental() ? (scheme_.backward_velocity ? 1.0 : 0.5) : scheme_.gamma;
  for (FrictionCarrier& carrier : carriers_) {
    const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
    double rate = state_->rests[carrier.coordinate] > 0 ? 0.0 : begin_rates_[coordinate.joint][coordinate.component];
    const double scale = is_angle(model_, coordinate) ? 1.0 : model_.length_scale;
    if (std::abs(rate * step_) <= kAtRest * scale) rate = 0;
    carrier.law.begin((1 - gamma) * step_ * rate, rate);
  }
}

double StepSystem::friction_direction(int index) const {
  const int c = carrier_of_[index];
  if (c < 0 || static_) return 0;
  const FrictionCarrier& carrier = carriers_[c];
  const Coordinate& base = model_.coordinates[carrier.coordinate];
  const double along = base.motion >= 0 ? increment_of(base) : carrier.law.direction();
  return along == 0 ? 0.0 : std::copysign(1.0, along * travel_per_carrier(index));
}

void StepSystem::add_constant_friction(int index, double increment, double& row) {
  const Coordinate& coordinate = model_.coordinates[index];
  const double effort = friction_direction(index) * coordinate.friction;
  row += effort_weight() * effort;
  dissipated_ += effort * increment;
  capacities_[index] += coordinate.friction;
}

template <class AddDerivative>
void StepSystem::turn_row(int j, const Vector6& g, Eigen::Ref<Vector6> left, const AddDerivative& add_derivative,
                          bool with_tangent) {
  const int index = model_.first_coordinate[j];
  const Coordinate& coordinate = model_.coordinates[index];
  if (coordinate.friction_coefficient <= 0 || static_) return;
  const NormalForce normal = normal_force(contact_of(model_.joints[j]), left, g.head<3>());
  const double capacity = coordinate.friction_coefficient * normal.magnitude;  // of the row
  capacities_[index] = capacity / effort_weight();
  const CoordinateStep change = coordinate_step(index, increment_of(coordinate));
  const SmoothDirection direction =
      coordinate.sticks ? SmoothDirection{friction_direction(index), 0} : smooth_direction(change);
  dissipated_ += direction.value * capacities_[index] * change.increment;
  const double factor = direction.value * coordinate.friction_coefficient;
  left.head<3>() += factor * normal.direction;
  if (with_tangent) add_derivative(normal.arm, factor * normal.along, direction.slope * capacity);
}

void StepSystem::add_normal_friction(int j, const Vector6& g, FoldMaps& maps, bool with_tangent) {
  if (model_.joints[j].kind != JointMapKind::Scalar) return;
  const auto add_derivative = [&](const Vector6& arm, double along, double slope) {
    maps.released_released(0, 0) += slope;
    if (along == 0) return;
    FoldMaps of_arm;
    joint_maps(j, arm, of_arm, true);
    maps.released_released += along * of_arm.released_released;
    maps.released_master += along * of_arm.released_master;
  };
  Vector6 left = maps.left.col(0);
  turn_row(j, g, left, add_derivative, with_tangent);
  maps.left.col(0) = left;
}

void StepSystem::add_normal_friction(int j, const Vector6& g, SlideMaps& maps, bool with_tangent) {
  const auto add_derivative = [&](const Vector6& arm, double along, double slope) {
    maps.released_released += slope;
    if (along == 0) return;
    slide_maps(j, arm, friction_slide_maps_, true);
    maps.released_released += along * friction_slide_maps_.released_released;
    for (int i = 0; i < maps.count; ++i) maps.released_master[i] += along * friction_slide_maps_.released_master[i];
  };
  turn_row(j, g, maps.released_left, add_derivative, with_tangent);
}

void StepSystem::hold_friction() {
  if (static_) return;
  for (FrictionCarrier& carrier : carriers_) {
    const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
    if (coordinate.motion >= 0) continue;
    double& row = rows_.at(dof_.variable_of_joint(coordinate.joint))[coordinate.component];
    carrier.increment = increment_of(coordinate);
    carrier.reaction = -row / effort_weight();
    carrier.capacity = 0;
    for (const int index : carrier.members)
      carrier.capacity += std::abs(travel_per_carrier(index)) * capacities_[index];
    if (!carrier.law.is_held()) continue;
    dissipated_ += carrier.reaction * carrier.increment;
    row = carrier.increment - carrier.law.held_increment();
  }
}

void StepSystem::hold_friction_tangent() {
  if (static_) return;
  for (std::size_t c = 0; c < carriers_.size(); ++c) {
    const FrictionCarrier& carrier = carriers_[c];
    tangent_branches_[c] = carrier.law.branch();
    const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
    if (coordinate.motion >= 0 || !carrier.law.is_held()) continue;
    ReleasedVector coefficients = ReleasedVector::Ones(1);
    int component = 0;
    if (coordinate.is_angle) {  // the increment varies as S^{-1} spin
      component = coordinate.component % 3;
      const Vector3 rotation = released_increment(model_.joints[coordinate.joint], state_->released[coordinate.joint],
                                                  released_[coordinate.joint])
                                   .tail<3>();
      coefficients = cayley::inverse_tangent(rotation).row(component).transpose();
    }
    backend_->hold_row(coordinate.joint, coordinate.component, coordinate.component - component, coefficients);
  }
}

bool StepSystem::tangent_holds() const {
  for (std::size_t c = 0; c < carriers_.size(); ++c)
    if (tangent_branches_[c] != carriers_[c].law.branch()) return false;
  return true;
}

bool StepSystem::revise_friction() {
  if (static_) return false;
  bool revised = false;
  for (FrictionCarrier& carrier : carriers_) {
    if (model_.coordinates[carrier.coordinate].motion >= 0) continue;
    if (revised && revisions_ >= kRevisionsAtOnce) break;
    const double slack = revisions_ < kTightRevisions ? kSlack : kLooseSlack;
    if (carrier.law.revise(carrier.increment, carrier.reaction, carrier.capacity, slack)) revised = true;
  }
  revisions_ += revised;
  return revised;
}

void StepSystem::place_held_coordinates() {
  if (static_) return;
  // The last digits of what the update has brought about.
  const auto is_there = [&](const FrictionCarrier& carrier) {
    const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
    const double scale = is_angle(model_, coordinate) ? 1.0 : model_.length_scale;
    return coordinate.motion < 0 && carrier.law.is_held() &&
           std::abs(increment_of(coordinate) - carrier.law.held_increment()) <= kAtRest * scale;
  };
  int resting_angles = 0;  // of the free rotation at hand; its components follow each other
  for (const FrictionCarrier& carrier : carriers_) {
    const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
    const int component = coordinate.component % 3;
    Released& released = released_[coordinate.joint];
    const Released& begin = state_->released[coordinate.joint];
    if (coordinate.is_angle) {
      if (component == 0) resting_angles = 0;
      resting_angles += is_there(carrier) && carrier.law.held_increment() == 0;
      if (component == 2 && resting_angles == 3) released.rotation = begin.rotation;
    } else if (is_there(carrier)) {
      released.displacement[component] = begin.displacement[component] + carrier.law.held_increment();
    }
  }
}

double StepSystem::smooth_rate(int index) const {
  return rate_of(coordinate_step(index, increment_of(model_.coordinates[index])));
}

void StepSystem::remember_smooth_rates() {
  if (static_) return;
  for (std::size_t i = 0; i < smooth_coordinates_.size(); ++i) smooth_rates_[i] = smooth_rate(smooth_coordinates_[i]);
}

// Newton's method for tanh jumps to and fro between both ends, where it has no slope. An update that would reverse the
// rate stops at rate zero instead: from there, and from any smaller rate than the solution's, the method goes on to it
// without passing it, because tanh is concave. Only a few times: joints of a loop, or in the Newmark family, whose
// rates ring, can hold each other there in turns.
void StepSystem::stop_smooth_reversals() {
  if (static_ || ++updates_ > kMostStoppedUpdates) return;
  for (std::size_t i = 0; i < smooth_coordinates_.size(); ++i) {
    const Coordinate& coordinate = model_.coordinates[smooth_coordinates_[i]];
    const double before = smooth_rates_[i], after = smooth_rate(smooth_coordinates_[i]);
    if (before * after >= 0 || std::max(std::abs(before), std::abs(after)) <= kFrictionSpeed) continue;
    const CoordinateStep step = coordinate_step(smooth_coordinates_[i], 0);
    released_[coordinate.joint].displacement[coordinate.component] =
        step.begin + (1 - step.gamma) * step.step * step.begin_rate;
  }
}

void StepSystem::accept_friction(State& state) const {
  for (const FrictionCarrier& carrier : carriers_) state.rests[carrier.coordinate] = carrier.law.is_stopped() ? 1 : 0;
}

}  // namespace flexarm
