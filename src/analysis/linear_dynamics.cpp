#include "analysis/linear_dynamics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/falling.h"
#include "analysis/linearised_motion.h"
#include "math/least_squares.h"
#include "math/picked.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// Distance between the poses from which differences along a motion are taken [rad]. With it, their truncation error
/// (of eighth order) and round-off are about equal, some 1e-12 of the derivative.
constexpr double kTurn = 0.05;
/// Most updates of Newton's method in the search for a steady motion. Updates below kShort that do not shrink by
/// kShorter are round-off.
constexpr int kMostUpdates = 50;
constexpr double kShort = 1e-8, kShorter = 0.5;

/// The model with its functions of time held constant, and without prescribed motions.
Model frozen(Model model, double time) {
  for (TimeFunction& history : model.histories) history = TimeFunction(history(time));
  for (Coordinate& coordinate : model.coordinates) coordinate.motion = -1;
  return model;
}

/// The static rule with the forces that the scheme's steps have at rest, and with local interpolation.
Scheme resting(const Scheme& scheme) {
  Scheme statics = statics_of(with_local_strains(scheme));
  statics.tests_vary_strains = scheme.stress == StressRule::Conjugate;
  return statics;
}

std::vector<bool> driven(const Model& model) {
  std::vector<bool> is_driven;
  for (const Coordinate& coordinate : model.coordinates) is_driven.push_back(coordinate.motion >= 0);
  return is_driven;
}

CoordinateRates standstill(int columns) {
  return {Eigen::VectorXd::Zero(columns), Eigen::VectorXd::Zero(columns)};
}

double second_derivative(const TimeFunction& motion, double time) {
  const double way = 1e-4 * std::max(1.0, time), from = std::max(0.0, time - way), to = time + way;
  return (motion.derivative(to) - motion.derivative(from)) / (to - from);
}

/// Variations of the rows' x' and x'' by the coordinates y, and of x'' by y'.
struct VariedRates {
  Eigen::MatrixXd first, second, second_by_rates;
};

/// The variation of a node's material angular velocity W is spin' + W x spin.
VariedRates varied_rates(const DegreesOfFreedom& dof, const MovingMatrix& motion, const CoordinateRates& rows) {
  VariedRates out{motion.first, motion.second, 2 * motion.first};
  for (int i = 0; i < dof.node_count; ++i) {
    const int at = dof.first[i] + 3;
    const Matrix3 velocity = so3::hat(Vector3(rows.first.segment<3>(at)));
    const Matrix3 acceleration = so3::hat(Vector3(rows.second.segment<3>(at)));
    const auto spins = motion.value.middleRows<3>(at);
    out.first.middleRows<3>(at) += velocity * spins;
    out.second_by_rates.middleRows<3>(at) += velocity * spins;
    out.second.middleRows<3>(at) += acceleration * spins + velocity * motion.first.middleRows<3>(at);
  }
  return out;
}

}  // namespace

LinearDynamics::LinearDynamics(const Model& model, const State& state, const Scheme& scheme, Reference reference,
                               const KnownRates& known)
    : model_(frozen(model, reference == Reference::Instant ? state.time : 0)),
      undamped_(model_.beams),
      state_(state),
      wrenches_(state.wrenches),
      is_driven_(driven(model)),
      system_(model_, resting(scheme), BackendChoice::Matrix),
      dof_(system_.degrees_of_freedom()),
      maps_(model_, dof_),
      pose_(maps_.moved(pose_of(state), standstill(maps_.columns()), 0)) {
  if (reference == Reference::Instant) {
    rotor_rates_ = known.rotors;
    command_by_rates(model, known, model_, state_);
    system_.hold_rotors();
  }
  choose_independent();
  Fall fall;
  if (reference == Reference::Rest) {
    system_.begin_equilibrium(state_, 1);
    if (!system_.evaluate(true)) throw std::runtime_error("the stiffness is not finite");
    fall = fall_of(model, dof_, state_, system_.residual());  // `model` knows which coordinates are driven
    wrenches_.insert(wrenches_.end(), fall.inertia.begin(), fall.inertia.end());
  }
  const Eigen::Index count = static_cast<Eigen::Index>(independent_.size());
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(count), accelerations = rates;
  if (reference == Reference::Instant) rates = picked_rows(coordinates_of(known), independent_);
  for (std::size_t c = 0; c < model.coordinates.size() && reference != Reference::Rest; ++c) {
    const auto place = std::find(scalars_.begin(), scalars_.end(), dof_.scalar_of(model.coordinates[c]));
    if (place == scalars_.end() || !is_driven_[c]) continue;
    const Eigen::Index i = place - scalars_.begin();
    const TimeFunction& motion = model.histories[model.coordinates[c].motion];
    const double time = reference == Reference::Instant ? state.time : 0;
    rates[i] = motion.derivative(time);
    if (reference == Reference::Instant) accelerations[i] = second_derivative(motion, time);
  }
  if (reference == Reference::Steady) move_to_steady(rates);
  set_motion(rates, accelerations);
  assemble();
  if (reference == Reference::Instant) {
    accelerations += free_accelerations();
    set_motion(rates, accelerations);
    assemble();
  }
  add_rotors(reference);
  for (const auto& [scalar, acceleration] : fall.accelerations)
    if (const auto place = std::find(scalars_.begin(), scalars_.end(), scalar); place != scalars_.end())
      rates_.second[place - scalars_.begin()] = acceleration;
}

Eigen::VectorXd LinearDynamics::coordinates_of(const KnownRates& known) const {
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(maps_.columns());
  for (int i = 0; i < dof_.node_count; ++i)
    for (int k = 0; k < 6; ++k)
      if (const int column = dof_.equation[dof_.first[i] + k]; column >= 0) unknowns[column] = known.nodes[i][k];
  for (std::size_t c = 0; c < model_.coordinates.size(); ++c)
    if (const int column = dof_.equation[dof_.scalar_of(model_.coordinates[c])]; column >= 0)
      unknowns[column] = known.coordinates[c];
  return square_solution(maps_.unknowns(pose_, maps_.at(pose_)), unknowns);
}

void LinearDynamics::choose_independent() {
  std::vector<bool> is_driven(maps_.columns(), false);
  for (std::size_t c = 0; c < model_.coordinates.size(); ++c)
    if (const int column = dof_.equation[dof_.scalar_of(model_.coordinates[c])]; column >= 0 && is_driven_[c])
      is_driven[column] = true;
  MotionMaps::Split columns = maps_.split(pose_, is_driven);
  const std::vector<int> scalars = maps_.scalars_of_columns();
  for (const int column : columns.independent) {
    scalars_.push_back(scalars[column]);
    is_driven_place_.push_back(is_driven[column]);
  }
  independent_ = std::move(columns.independent);
  dependent_ = std::move(columns.dependent);
}

std::vector<int> LinearDynamics::free_places() const {
  std::vector<int> places;
  for (std::size_t i = 0; i < is_driven_place_.size(); ++i)
    if (!is_driven_place_[i]) places.push_back(static_cast<int>(i));
  return places;
}

MovingMatrix LinearDynamics::along_reference(const Rows& rows) const {
  return along(
      [&](double time) {
        const MechanismPose pose = time == 0 ? pose_ : maps_.moved(pose_, columns_, time);
        const Eigen::MatrixXd maps = maps_.at(pose);
        return rows(pose, maps * maps_.allowed(pose, maps, independent_));
      },
      spacing_);
}

void LinearDynamics::set_motion(const Eigen::VectorXd& rates, const Eigen::VectorXd& accelerations) {
  rates_ = {rates, accelerations};
  row_maps_ = maps_.at(pose_);
  unknowns_ = maps_.unknowns(pose_, row_maps_);
  const Eigen::MatrixXd allowed = maps_.allowed(pose_, row_maps_, independent_);
  columns_ = {allowed * rates, allowed * accelerations};
  const auto spacing = [&] {
    const Eigen::VectorXd first = row_maps_ * columns_.first, second = row_maps_ * columns_.second;
    double speed = 0;
    for (int i = 0; i < dof_.node_count; ++i) {
      const int at = dof_.first[i];
      speed = std::max({speed, first.segment<3>(at).norm() / model_.length_scale, first.segment<3>(at + 3).norm(),
                        std::sqrt(second.segment<3>(at).norm() / model_.length_scale),
                        std::sqrt(second.segment<3>(at + 3).norm())});
    }
    return speed > 0 ? kTurn / speed : 0;
  };
  const auto both = [&] {
    spacing_ = spacing();
    const Eigen::Index count = allowed.rows();
    const MovingMatrix all = along(
        [&](double time) {
          const MechanismPose pose = time == 0 ? pose_ : maps_.moved(pose_, columns_, time);
          const Eigen::MatrixXd maps = maps_.at(pose), part = maps_.allowed(pose, maps, independent_);
          Eigen::MatrixXd stacked(count + maps.rows(), part.cols());
          stacked << part, maps * part;
          return stacked;
        },
        spacing_);
    const Eigen::Index rows = row_maps_.rows();
    allowed_ = {all.value.topRows(count), all.first.topRows(count), all.second.topRows(count)};
    motion_ = {all.value.bottomRows(rows), all.first.bottomRows(rows), all.second.bottomRows(rows)};
  };
  both();
  // Rates cause accelerations in loops, and second derivatives depend on these: compute them again.
  if (dependent_.empty() || spacing_ == 0) return;
  columns_.second += allowed_.first * rates;
  both();
}

/// Replaces stresses of dampers by reference strains, so that they add to the geometric stiffness like any stress.
void LinearDynamics::put_dampers_stress(const std::vector<Stretch>& stretches, const Eigen::VectorXd& speeds) {
  model_.beams = undamped_;
  auto stretch = stretches.begin();
  for_each_element(model_.beams, [&](auto& element) {
    if (element.stiffness_damping == 0) return;
    for (auto& point : element.stiffness_points) {
      const Vector6 stress =
          (stretch->damping / point.weight) * (stretch->rows * picked_rows(speeds, stretch->scalars));
      point.reference_strain -= point.stiffness.ldlt().solve(stress);
      ++stretch;
    }
  });
}

/// Applies the forces of inertia as loads that do not turn with their nodes.
void LinearDynamics::put_loads(const Eigen::VectorXd& force) {
  state_.wrenches = wrenches_;
  for (int i = 0; i < dof_.node_count; ++i) {
    NodalLoad load;
    load.node = i;
    load.force = -force.segment<3>(dof_.first[i]);
    load.moment = -(pose_.nodes[i].rotation * force.segment<3>(dof_.first[i] + 3));
    if (!load.force.isZero(0) || !load.moment.isZero(0)) state_.wrenches.push_back(load);
  }
}

void LinearDynamics::balance(const Eigen::VectorXd& efforts) {
  const auto evaluate = [&] {
    if (!system_.evaluate(true)) throw std::runtime_error("the stiffness is not finite");
    const SparseTangent& tangent = system_.tangent().matrix();
    tangent_ = Eigen::Map<const Eigen::SparseMatrix<double>>(
        tangent.unknowns(), tangent.unknowns(), static_cast<Eigen::Index>(tangent.values().size()),
        tangent.column_starts().data(), tangent.row_indices().data(), tangent.values().data());
  };
  system_.begin_equilibrium(state_, 1);
  evaluate();
  if (dependent_.empty()) return;
  std::vector<int> rows;  // all that are not driven
  for (int column = 0; column < maps_.columns(); ++column) {
    const auto place = std::lower_bound(independent_.begin(), independent_.end(), column);
    const bool is_independent = place != independent_.end() && *place == column;
    if (!is_independent || !is_driven_place_[place - independent_.begin()]) rows.push_back(column);
  }
  const int count = maps_.columns();
  const Eigen::MatrixXd forces = unknowns_.transpose() * tangent_.topRightCorner(count, dof_.unknowns - count);
  const Eigen::VectorXd lacking = unknowns_.transpose() * system_.residual().head(count) +
                                  row_maps_.bottomRows(efforts.size()).transpose() * efforts;
  Eigen::VectorXd update = Eigen::VectorXd::Zero(dof_.unknowns);
  update.tail(forces.cols()) = -least_squares(picked_rows(forces, rows), picked_rows(lacking, rows));
  system_.update(update);
  evaluate();
}

ActuatorRates LinearDynamics::actuator_rates(const Eigen::VectorXd& rows) const {
  ActuatorRates out{{}, rotor_rates_};
  for (const Coordinate& coordinate : model_.coordinates) out.coordinates.push_back(rows[dof_.scalar_of(coordinate)]);
  if (rotor_rates_.empty())  // in steady motion rotors turn with their coordinates
    for (const Actuator& actuator : model_.actuators) out.rotors.push_back(out.coordinates[actuator.coordinate]);
  return out;
}

void LinearDynamics::assemble() {
  const CoordinateRates rows = {row_maps_ * columns_.first,
                                motion_.value * rates_.second + motion_.first * rates_.first};
  NodalDynamics own = nodal_dynamics(model_, dof_, state_, rows);
  const std::vector<ActuatorTerms> motors = actuator_terms(model_, state_);
  const std::vector<double> dampers = efforts_of_gear_dampers(model_, state_, actuator_rates(rows.first));
  const auto scalar_of = [&](std::size_t actuator) {
    return dof_.scalar_of(model_.coordinates[model_.actuators[actuator].coordinate]);
  };
  for (std::size_t i = 0; i < motors.size(); ++i) own.force[scalar_of(i)] -= dampers[i];
  put_dampers_stress(damped_stretches(model_, dof_, pose_), rows.first);
  const StretchDamping stretched = stretch_damping(model_, dof_, maps_, pose_, columns_, spacing_);
  const Eigen::VectorXd force = own.force + stretched.of_elements;
  const Eigen::Index coordinates = maps_.rows() - 6 * static_cast<Eigen::Index>(dof_.node_count);
  put_loads(force);
  balance(force.tail(coordinates));
  // The balance counts the efforts that controllers demand because of rates as commands, so their damping is added
  // here.
  for (std::size_t i = 0; i < motors.size(); ++i)
    if (!system_.actuators().is_cut(i)) own.damping.coeffRef(scalar_of(i), scalar_of(i)) += motors[i].servo_damping;

  const VariedRates varied = varied_rates(dof_, motion_, rows);
  const Eigen::MatrixXd tests = motion_.value.transpose(), unknowns = unknowns_ * allowed_.value;
  const Eigen::Index count = maps_.columns();
  mass_ = tests * (own.mass * motion_.value);
  damping_ =
      tests * (own.mass * varied.second_by_rates + own.damping * motion_.value + stretched.by_rates * motion_.value);
  stiffness_ = unknowns.transpose() * (tangent_.topLeftCorner(count, count) * unknowns) +
               tests * (own.mass * varied.second + own.damping * varied.first + own.turning * motion_.value +
                        stretched.by_rates * motion_.first + stretched.by_places * motion_.value);
  residual_ = unknowns.transpose() * system_.residual().head(count) +
              motion_.value.bottomRows(coordinates).transpose() * force.tail(coordinates);
}

Eigen::VectorXd LinearDynamics::stiffness_round_off() const {
  Eigen::VectorXd round_off = Eigen::VectorXd::Zero(size());
  const Eigen::Index count = maps_.columns();
  const Eigen::MatrixXd terms = tangent_.topLeftCorner(count, count).cwiseAbs();
  for (Eigen::Index i = 0; i < allowed_.value.cols(); ++i) {
    const Eigen::VectorXd moved = (unknowns_ * allowed_.value.col(i)).cwiseAbs();
    if ((moved.array() > 0).count() > 6) round_off[i] = kStiffnessRoundOff * moved.dot(terms * moved);
  }
  return round_off;
}

void LinearDynamics::move(const Eigen::VectorXd& increment) {
  Eigen::VectorXd update = Eigen::VectorXd::Zero(dof_.unknowns);
  const Eigen::Index count = maps_.columns(), constraints = dof_.unknowns - count;
  Eigen::VectorXd columns = allowed_.value * increment;
  if (constraints > 0) {
    const Eigen::MatrixXd rows = tangent_.bottomLeftCorner(constraints, count) * unknowns_;
    add_to_rows(columns, dependent_,
                -square_solution(picked_columns(rows, dependent_), system_.residual().tail(constraints)));
  }
  update.head(count) = unknowns_ * columns;
  system_.update(update);
  const StepConfiguration& configuration = system_.configuration();
  for (std::size_t i = 0; i < state_.nodes.size(); ++i) {
    state_.nodes[i].position = configuration.end()[i].position;
    state_.nodes[i].orientation = configuration.end()[i].orientation;
  }
  state_.released = configuration.released();
  pose_ = pose_of(state_);
}

void LinearDynamics::move_to_steady(const Eigen::VectorXd& rates) {
  const std::vector<int> places = free_places();
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMostUpdates; ++k) {
    set_motion(rates, Eigen::VectorXd::Zero(rates.size()));
    assemble();
    Eigen::VectorXd increment = Eigen::VectorXd::Zero(rates.size());
    add_to_rows(increment, places,
                -square_solution(picked(stiffness_, places, places), picked_rows(residual_, places)));
    if (!increment.allFinite()) break;
    move(increment);
    const double way = increment.size() > 0 ? increment.cwiseAbs().maxCoeff() : 0;
    if (way == 0 || (way < kShort && way > kShorter * last)) return;
    last = way;
  }
  throw std::runtime_error("no steady motion was found: nothing holds some joints, or motions are too fast");
}

Eigen::VectorXd LinearDynamics::free_accelerations() const {
  const std::vector<int> places = free_places();
  Eigen::VectorXd accelerations = Eigen::VectorXd::Zero(residual_.size());
  add_to_rows(accelerations, places, -square_solution(picked(mass_, places, places), picked_rows(residual_, places)));
  if (!accelerations.allFinite()) throw std::runtime_error("a coordinate moves nothing that has mass");
  return accelerations;
}

void LinearDynamics::add_rotors(Reference reference) {
  const int count = maps_.columns();
  const RotorEntries entries = rotor_entries(model_, dof_, state_, system_.actuators(), count);
  rotors_ = entries.actuators;
  if (rotors_.empty()) return;
  const Eigen::Index own = mass_.rows(), more = static_cast<Eigen::Index>(rotors_.size());
  Eigen::MatrixXd allowed = Eigen::MatrixXd::Zero(count + more, own + more);
  allowed.topLeftCorner(count, own) = allowed_.value;
  allowed.bottomRightCorner(more, more).setIdentity();
  Eigen::MatrixXd turning = Eigen::MatrixXd::Zero(count + more, own + more);  // for the rates that dampers feel
  turning.topLeftCorner(count, own) = allowed_.first;
  const auto summed = [&](const std::vector<Eigen::Triplet<double>>& added) {
    Eigen::SparseMatrix<double> sum(count + more, count + more);
    sum.setFromTriplets(added.begin(), added.end());
    return sum;
  };
  const auto extend = [&](Eigen::MatrixXd& matrix, const Eigen::MatrixXd& added) {
    Eigen::MatrixXd extended = allowed.transpose() * added;
    extended.topLeftCorner(own, own) += matrix;
    matrix = std::move(extended);
  };
  const Eigen::SparseMatrix<double> damping = summed(entries.damping);
  extend(mass_, summed(entries.mass) * allowed);
  extend(damping_, damping * allowed);
  extend(stiffness_, summed(entries.stiffness) * allowed + damping * turning);
  for (Eigen::VectorXd* vector : {&residual_, &rates_.first, &rates_.second}) {
    vector->conservativeResize(own + more);
    vector->tail(more).setZero();
  }
  if (reference != Reference::Instant) return;
  const Eigen::VectorXd rows = row_maps_ * columns_.first;
  const std::vector<double> dampers = efforts_of_gear_dampers(model_, state_, actuator_rates(rows));
  for (Eigen::Index r = 0; r < more; ++r) {
    const int actuator = rotors_[r];
    rates_.first[own + r] = rotor_rates_[actuator];
    rates_.second[own + r] =
        (system_.actuators().effort_on_rotor(actuator) - dampers[actuator]) / model_.actuators[actuator].drive.inertia;
  }
}

}  // namespace flexarm
