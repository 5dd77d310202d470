#include "integrators/dry_friction_step.h"

#include <algorithm>
#include <cmath>

#include "flexarm/model/model_error.h"
#include "joints/joint_forces.h"
#include "joints/kinematics.h"
#include "math/cayley.h"

namespace flexarm {
namespace {

/// A coordinate with a smaller increment over a step counts as being at rest; relative to the model's length or to 1
/// rad.
constexpr double kAtRest = 1e-12;
/// An effort at rest may exceed the capacity by this part of it: round-off, and a looser value if branches do not
/// settle.
constexpr double kSlack = 1e-10, kLooseSlack = 1e-6;
/// After this many revisions in a solve only one coordinate is revised at a time, or the loose slack is used.
constexpr int kRevisionsAtOnce = 4, kTightRevisions = 10;
/// For a stop that occurs within a step. The prediction of its time is accepted up to the first multiple of the step,
/// since it is not exact. The step is then cut to the second fraction of this time, so that the coordinate still
/// slides.
constexpr double kMostForeseen = 1.1, kShortOfStop = 0.98;

Contact contact_of(const JointMap& joint) {
  if (joint.kind == JointMapKind::Slide || joint.rotation.isZero(0)) return Contact::Travel;
  return joint.translation.isZero(0) ? Contact::Turn : Contact::Both;
}

}  // namespace

DryFrictionStep::DryFrictionStep(StepConfiguration& configuration)
    : configuration_(configuration),
      model_(configuration.model()),
      carrier_of_(model_.coordinates.size(), -1),
      capacities_(model_.coordinates.size(), 0.0),
      scratch_(most_active_nodes(model_.slide_lines)) {
  if (!configuration.scheme().is_static) find_carriers();
  tangent_branches_.assign(carriers_.size(), StickSlip::Free);
  if (!carriers_.empty()) configuration.keep_begin_rates();
}

void DryFrictionStep::find_carriers() {
  const Scheme& scheme = configuration_.scheme();
  std::vector<int> carrier_at(model_.coordinates.size(), -1);  // per coordinate: index of its carrier
  for (std::size_t index = 0; index < model_.coordinates.size(); ++index) {
    const Coordinate& coordinate = model_.coordinates[index];
    if (!coordinate.sticks || (coordinate.friction <= 0 && coordinate.friction_coefficient <= 0)) continue;
    if (scheme.is_composition)
      throw ModelError("<integrator>: scheme '" + std::string(scheme.name) +
                       "' also steps backwards in time, where friction of the law 'coulomb' (coordinate '" +
                       coordinate.name + "') would add energy; take another scheme or the law 'smooth'");
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
}

double DryFrictionStep::travel_per_carrier(int coordinate) const {
  double ratio = 1;
  for (; model_.coordinates[coordinate].mimicked >= 0; coordinate = model_.coordinates[coordinate].mimicked)
    ratio *= configuration_.mimic_map(coordinate).left;
  return ratio;
}

void DryFrictionStep::begin() {
  revisions_ = 0;
  const double share = (1 - configuration_.scheme().rate_gamma()) * configuration_.step();
  for (FrictionCarrier& carrier : carriers_) {
    const double rate = rate_at_begin(carrier);
    carrier.law.begin(share * rate, rate);
  }
  const EventModes* held = configuration_.held_modes();
  for (std::size_t c = 0; held && c < carriers_.size(); ++c) {
    StickSlip& law = carriers_[c].law;
    if (held->friction[c] == StickSlip::HeldLow)
      law.take_rest();
    else
      law.take_branch(held->friction[c]);
  }
}

/// Rate of a carrier at the beginning of the step; exactly 0 if it rests.
double DryFrictionStep::rate_at_begin(const FrictionCarrier& carrier) const {
  const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
  if (configuration_.state().rests[carrier.coordinate] > 0) return 0;
  const double rate = configuration_.begin_rates(coordinate.joint)[coordinate.component];
  return std::abs(rate * configuration_.step()) <= kAtRest * coordinate_scale(model_, coordinate) ? 0 : rate;
}

void DryFrictionStep::begin_evaluation() {
  std::fill(capacities_.begin(), capacities_.end(), 0.0);
}

double DryFrictionStep::direction(int index) const {
  const int c = carrier_of_[index];
  if (c < 0) return 0;
  const FrictionCarrier& carrier = carriers_[c];
  const Coordinate& base = model_.coordinates[carrier.coordinate];
  const double along = base.motion >= 0 ? configuration_.increment_of(base) : carrier.law.direction();
  return along == 0 ? 0.0 : std::copysign(1.0, along * travel_per_carrier(index));
}

PassiveEffort DryFrictionStep::constant_effort(int index, const CoordinateStep& change) {
  if (carrier_of_[index] < 0) return {};
  const Coordinate& coordinate = model_.coordinates[index];
  const FrictionRise rise = friction_rise(coordinate, change);
  const double capacity = rise.value * coordinate.friction, along = direction(index);
  capacities_[index] += capacity;
  return {-along * capacity, -along * rise.slope * coordinate.friction, along * capacity * change.increment};
}

template <class AddDerivative>
void DryFrictionStep::turn_row(int j, const Vector6& g, Eigen::Ref<Vector6> left, const AddDerivative& add_derivative,
                               Balance& balance) {
  const int index = model_.first_coordinate[j];
  const Coordinate& coordinate = model_.coordinates[index];
  const NormalForce normal = normal_force(contact_of(model_.joints[j]), left, g.head<3>());
  const CoordinateStep change = configuration_.coordinate_step(index, configuration_.increment_of(coordinate));
  const FrictionRise rise = friction_rise(coordinate, change);
  const double sliding = coordinate.friction_coefficient * normal.magnitude;  // in units of the row
  capacities_[index] = rise.value * sliding / configuration_.effort_weight();
  const SmoothDirection direction_now =
      coordinate.sticks ? SmoothDirection{direction(index), 0} : smooth_direction(change);
  balance.dissipated += direction_now.value * capacities_[index] * change.increment;
  const double factor = direction_now.value * rise.value * coordinate.friction_coefficient;
  left.head<3>() += factor * normal.direction;
  const double slope = direction_now.slope * rise.value + direction_now.value * rise.slope;
  if (balance.tangent) add_derivative(normal.arm, factor * normal.along, slope * sliding);
}

bool DryFrictionStep::turns_row(int j) const {
  const JointMapKind kind = model_.joints[j].kind;
  return (kind == JointMapKind::Scalar || kind == JointMapKind::Slide) && !configuration_.scheme().is_static &&
         model_.coordinates[model_.first_coordinate[j]].friction_coefficient > 0;
}

void DryFrictionStep::add_normal(int j, const Vector6& g, FoldMaps& maps, Balance& balance) {
  if (!turns_row(j)) return;
  const auto add_derivative = [&](const Vector6& arm, double along, double slope) {
    maps.released_released(0, 0) += slope;
    if (along == 0) return;
    FoldMaps of_arm;
    configuration_.joint_maps(j, arm, of_arm, true);
    maps.released_released += along * of_arm.released_released;
    maps.released_spin += along * of_arm.released_spin;
  };
  Vector6 left = maps.left.col(0);
  turn_row(j, g, left, add_derivative, balance);
  maps.left.col(0) = left;
}

void DryFrictionStep::add_normal(int j, const Vector6& g, SlideMaps& maps, Balance& balance) {
  if (!turns_row(j)) return;
  const auto add_derivative = [&](const Vector6& arm, double along, double slope) {
    maps.released_released += slope;
    if (along == 0) return;
    configuration_.joint_maps(j, arm, scratch_, true);
    maps.released_released += along * scratch_.released_released;
    for (int i = 0; i < maps.count; ++i) maps.released_master[i] += along * scratch_.released_master[i];
  };
  turn_row(j, g, maps.released_left, add_derivative, balance);
}

void DryFrictionStep::hold(Balance& balance) {
  const DegreesOfFreedom& dof = configuration_.degrees_of_freedom();
  for (std::size_t c = 0; c < carriers_.size(); ++c) {
    FrictionCarrier& carrier = carriers_[c];
    if (balance.tangent) tangent_branches_[c] = carrier.law.branch();
    const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
    if (coordinate.motion >= 0) continue;
    double& row = balance.residual.at(dof.variable_of_joint(coordinate.joint))[coordinate.component];
    carrier.increment = configuration_.increment_of(coordinate);
    carrier.reaction = -row / configuration_.effort_weight();
    carrier.capacity = 0;
    for (const int index : carrier.members)
      carrier.capacity += std::abs(travel_per_carrier(index)) * capacities_[index];
    if (!carrier.law.is_held()) continue;
    balance.dissipated += carrier.reaction * carrier.increment;
    row = carrier.increment - carrier.law.held_increment();
    if (balance.tangent) hold_tangent_row(coordinate, *balance.tangent);
  }
}

void DryFrictionStep::hold_tangent_row(const Coordinate& coordinate, TangentBackend& tangent) const {
  ReleasedVector coefficients = ReleasedVector::Ones(1);
  int component = 0;
  if (coordinate.is_angle) {  // the increment's variation is S^{-1} spin
    component = coordinate.component % 3;
    const Vector3 rotation = configuration_.increment_of(coordinate.joint).tail<3>();
    coefficients = cayley::inverse_tangent(rotation).row(component).transpose();
  }
  tangent.hold_row(coordinate.joint, coordinate.component, coordinate.component - component, coefficients);
}

bool DryFrictionStep::tangent_holds() const {
  for (std::size_t c = 0; c < carriers_.size(); ++c)
    if (tangent_branches_[c] != carriers_[c].law.branch()) return false;
  return true;
}

void DryFrictionStep::stick_as(const DryFrictionStep& other) {
  if (configuration_.held_modes()) return;
  for (std::size_t c = 0; c < carriers_.size(); ++c) carriers_[c].law.take_branch(other.carriers_[c].law.branch());
}

bool DryFrictionStep::revise() {
  if (configuration_.held_modes()) return false;
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

void DryFrictionStep::place_held() {
  const auto is_there = [&](const FrictionCarrier& carrier) {
    const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
    return coordinate.motion < 0 && carrier.law.is_held() &&
           std::abs(configuration_.increment_of(coordinate) - carrier.law.held_increment()) <=
               kAtRest * coordinate_scale(model_, coordinate);
  };
  int resting_angles = 0;  // of the present spherical joint, whose three components follow each other in the list
  for (const FrictionCarrier& carrier : carriers_) {
    const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
    const int component = coordinate.component % 3;
    Released& released = configuration_.released(coordinate.joint);
    const Released& begin = configuration_.state().released[coordinate.joint];
    if (coordinate.is_angle) {
      if (component == 0) resting_angles = 0;
      resting_angles += is_there(carrier) && carrier.law.held_increment() == 0;
      if (component == 2 && resting_angles == 3) released.rotation = begin.rotation;
    } else if (is_there(carrier)) {
      released.displacement[component] = begin.displacement[component] + carrier.law.held_increment();
    }
  }
}

/// Predicts after which fraction of the step friction stops a coordinate. `rate`: at the beginning of the step. The
/// rate at the end does not help: it is not that of sliding, since the coordinate stops or turns in the step. So the
/// deceleration is computed from the mean rate of the last step, which belongs to the middle of that step.
double DryFrictionStep::fraction_of_stop(const FrictionCarrier& carrier, double rate) const {
  const DegreesOfFreedom& dof = configuration_.degrees_of_freedom();
  const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
  const int equation = dof.equation[dof.first[dof.variable_of_joint(coordinate.joint)] + coordinate.component];
  const IncrementHistory& history = configuration_.state().history;
  if (equation < 0 || history.count == 0 || !history.holds_for(dof.unknowns)) return kUnknownStop;
  const double mean = history.increments[0][equation] / history.steps[0];
  const double deceleration = (mean - rate) / (0.5 * history.steps[0]);
  const double fraction = rate / (deceleration * configuration_.step());
  if (!(fraction > 0 && fraction <= kMostForeseen)) return kUnknownStop;
  return kShortOfStop * std::min(fraction, 1.0);
}

void DryFrictionStep::note_events(FirstEvent& first) const {
  for (const FrictionCarrier& carrier : carriers_) {
    const Coordinate& coordinate = model_.coordinates[carrier.coordinate];
    const double rate = rate_at_begin(carrier);
    if (coordinate.motion >= 0 || rate == 0) continue;
    if (carrier.law.is_stopped() || rate * configuration_.end_rate(coordinate) <= 0)
      first.note_stop(fraction_of_stop(carrier, rate));
  }
}

bool DryFrictionStep::breaks_away() const {
  return std::any_of(carriers_.begin(), carriers_.end(), [&](const FrictionCarrier& carrier) {
    return !carrier.law.is_stopped() && configuration_.state().rests[carrier.coordinate] > 0;
  });
}

void DryFrictionStep::accept(State& state) const {
  for (const FrictionCarrier& carrier : carriers_) state.rests[carrier.coordinate] = carrier.law.is_stopped() ? 1 : 0;
}

}  // namespace flexarm
