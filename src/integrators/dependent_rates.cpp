#include "integrators/dependent_rates.h"

#include <algorithm>
#include <cmath>

#include "joints/kinematics.h"

namespace flexarm {
namespace {

/// Newton's method for loops ends when constraints are violated by less than kClosed, or after an update of constraints
/// violated by less than kNearlyClosed: its error is quadratic. Relative to lengths of the model.
constexpr double kClosed = 1e-14, kNearlyClosed = 1e-8;
constexpr int kMostIterations = 12;
/// Relative: differences of a motion's rates that are not jumps but errors of its polynomials.
constexpr double kSmoothRate = 1e-7;

NodePose pose_of(const ArticulatedBodies& bodies, int node) {
  NodePose pose;
  if (node >= 0) pose.position = bodies.position(node), pose.rotation = bodies.rotation(node);
  return pose;
}

ClosurePoses poses_of(const LoopClosure& closure, const ArticulatedBodies& bodies) {
  return {pose_of(bodies, closure.parent), pose_of(bodies, closure.child)};
}

/// A vector that is fixed to a node, with its first and second derivatives; world axes.
struct Carried {
  Vector3 value = Vector3::Zero(), rate = Vector3::Zero(), change = Vector3::Zero();
};

Carried carried(const ArticulatedBodies& bodies, int node, const Vector3& vector) {
  if (node < 0) return {vector, Vector3::Zero(), Vector3::Zero()};
  const Vector3 value = bodies.rotation(node) * vector, spin = bodies.velocity(node).tail<3>();
  const Vector3 rate = spin.cross(value);
  return {value, rate, bodies.acceleration(node).tail<3>().cross(value) + spin.cross(rate)};
}

Carried point(const ArticulatedBodies& bodies, int node, const Vector3& arm) {
  Carried out = carried(bodies, node, arm);
  if (node < 0) return out;
  out.value += bodies.position(node);
  out.rate += bodies.velocity(node).head<3>();
  out.change += bodies.acceleration(node).head<3>();
  return out;
}

}  // namespace

DependentRates::DependentRates(const Model& model, const ArticulatedBodies& bodies, const ExplicitTableau& tableau)
    : model_(model), derivatives_(tableau), rates_(bodies.rate_count()) {
  root_column_.assign(rates_, -1);
  factors_.assign(rates_, 1);
  places_.resize(rates_);
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j)
    for (int k = 0; k < released_count(model.joints[j].kind); ++k) places_[bodies.first_rate(j) + k] = {j, k};
  const auto rate_of = [&](const Coordinate& c) { return bodies.first_rate(c.joint) + c.component; };
  for (const Coordinate& c : model.coordinates)
    if (c.motion >= 0 && !is_held(model, c)) motions_.push_back({rate_of(c), c.joint, c.motion, {}});
  for (const Coordinate& c : model.coordinates) {
    if (c.mimicked < 0 || is_held(model, c)) continue;
    const Coordinate& leader = model.coordinates[c.mimicked];
    followers_.push_back({rate_of(c), c.joint, rate_of(leader), leader.joint, &c.mimic});
  }
  for (const Motion& motion : motions_) roots_.push_back(motion.rate);
  for (int k = 0; k < rates_; ++k) {
    const bool follows =
        std::any_of(followers_.begin(), followers_.end(), [&](const Follower& f) { return f.rate == k; });
    const bool is_moved = std::any_of(motions_.begin(), motions_.end(), [&](const Motion& m) { return m.rate == k; });
    if (!follows && !is_moved) roots_.push_back(k);
  }
  for (std::size_t column = 0; column < roots_.size(); ++column)
    root_column_[roots_[column]] = static_cast<int>(column);
  for (const Follower& follower : followers_) root_column_[follower.rate] = root_column_[follower.leader_rate];
  rows_ = multiplier_count(model);
  closure_forces_.assign(model.closures.size(), Vector6::Zero());
  any_ = !motions_.empty() || !followers_.empty() || rows_ > 0;
  if (!any_) return;

  const int roots = static_cast<int>(roots_.size()), moved = static_cast<int>(motions_.size()),
            free = roots - moved - rows_;
  dependent_.resize(rows_), independent_.resize(free);
  for (int i = 0; i < free; ++i) independent_[i] = moved + i;  // until loops choose
  values_.setZero(rows_), drives_.setZero(moved), root_rates_.setZero(roots);
  for (Eigen::VectorXd* vector : {&follower_bends_, &bend_, &needed_, &forces_, &change_}) vector->setZero(rates_);
  reduced_.setZero(free), right_.setZero(rows_);
  rows_of_rates_.setZero(rates_, rows_);
  jacobian_.setZero(rows_, roots), block_.setZero(rows_, rows_), transfer_.setZero(rows_, moved + free);
  columns_.setZero(rates_, moved + free), mass_.setZero(rates_, rates_), moved_.setZero(rates_, moved + free);
  small_.setZero(free, free);
  loops_ = Eigen::PartialPivLU<Eigen::MatrixXd>(rows_);
  scaled_.setZero(rows_, roots - moved);
  choice_ = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(rows_, roots - moved);
  choice_.setThreshold(kIndependent);
  factor_ = Eigen::LLT<Eigen::MatrixXd>(free);
}

double DependentRates::derivative(std::size_t stage, int order, const Motion& motion) const {
  return derivatives_(order, stage, motion.samples, step_);
}

bool DependentRates::begin(double time, double step, std::vector<Released>& released, double* rates,
                           ArticulatedBodies& bodies) {
  step_ = step;
  for (Motion& motion : motions_)
    StageDerivatives::sample(model_.histories[motion.history], time, step, motion.samples);
  if (rows_ == 0) return true;
  follow(released, rates);
  bodies.set(released, rates);
  find_constraints(bodies);
  const int moved = static_cast<int>(motions_.size());
  for (Eigen::Index k = 0; k < scaled_.cols(); ++k) {
    const Place& place = places_[roots_[moved + k]];
    const Coordinate& coordinate = model_.coordinates[model_.first_coordinate[place.joint] + place.component];
    scaled_.col(k) = coordinate_scale(model_, coordinate) * jacobian_.col(moved + k);
  }
  choice_.compute(scaled_);
  if (choice_.rank() < rows_) return false;
  const auto& order = choice_.colsPermutation().indices();
  for (int i = 0; i < rows_; ++i) dependent_[i] = moved + order[i];
  for (std::size_t i = 0; i < independent_.size(); ++i)
    independent_[i] = moved + order[rows_ + static_cast<Eigen::Index>(i)];
  return true;
}

/// Sets positions and rates of coordinates that mimic others.
void DependentRates::follow(std::vector<Released>& released, double* rates) {
  for (const Follower& follower : followers_) {
    const double leader = released[follower.leader_joint].displacement[0];
    factors_[follower.rate] = follower.law->derivative(leader);
    released[follower.joint].displacement[0] = follower.law->value(leader);
    const double rate = rates[follower.leader_rate];
    rates[follower.rate] = factors_[follower.rate] * rate;
    follower_bends_[follower.rate] = follower.law->second_derivative(leader) * rate * rate;
  }
}

/// Finds the violations of all constraints, and their derivatives by the roots.
void DependentRates::find_constraints(const ArticulatedBodies& bodies) {
  rows_of_rates_.setZero();
  int row = 0;
  for_each_constraint(model_, Constraints::WithMultipliers, [&](const auto& closure, const auto& constraint) {
    const ClosurePoses poses = poses_of(closure, bodies);
    const ClosureRows rows = closure_rows(closure, constraint, poses);
    const double scale = constraint_scale(model_, constraint);
    values_[row] = closure_value(closure, constraint, poses) / scale;
    bodies.add_power(closure.child, rows.child / scale, rows_of_rates_.col(row).data());
    bodies.add_power(closure.parent, rows.parent / scale, rows_of_rates_.col(row).data());
    ++row;
  });
  jacobian_.setZero();
  for (int k = 0; k < rates_; ++k) jacobian_.col(root_column_[k]) += factors_[k] * rows_of_rates_.row(k).transpose();
}

/// Moves the dependent coordinates of loops by a step of Newton's method.
void DependentRates::move(std::vector<Released>& released) {
  for (int i = 0; i < rows_; ++i) block_.col(i) = jacobian_.col(dependent_[i]);
  loops_.compute(block_);
  solve_loops(values_);
  for (int i = 0; i < rows_; ++i) {
    const Place& place = places_[roots_[dependent_[i]]];
    const JointMap& joint = model_.joints[place.joint];
    ReleasedVector increment = ReleasedVector::Zero(released_count(joint.kind));
    increment[place.component] = -right_[i];
    released[place.joint] = updated(joint, released[place.joint], increment);
  }
}

bool DependentRates::place(std::size_t stage, const std::vector<double>& positions, std::vector<Released>& released,
                           double* rates, ArticulatedBodies& bodies) {
  for (const Motion& motion : motions_) {
    released[motion.joint].displacement[0] = positions[motion.history];
    rates[motion.rate] = derivative(stage, 1, motion);
  }
  follow(released, rates);
  bodies.set(released, rates);
  if (rows_ == 0) {
    find_columns();
    return true;
  }
  double violation = 1;
  for (int iteration = 0;; ++iteration) {
    find_constraints(bodies);
    const double now = values_.lpNorm<Eigen::Infinity>();
    if (now <= kClosed || violation < kNearlyClosed) break;
    if (!(now < 1) || iteration == kMostIterations) return false;
    violation = now;
    move(released);
    follow(released, rates);
    bodies.set(released, rates);
  }
  for (int i = 0; i < rows_; ++i) block_.col(i) = jacobian_.col(dependent_[i]);
  loops_.compute(block_);
  find_columns();
  for (std::size_t i = 0; i < roots_.size(); ++i) root_rates_[static_cast<Eigen::Index>(i)] = rates[roots_[i]];
  for (int i = 0; i < rows_; ++i) {
    double sum = 0;
    const int moved = static_cast<int>(motions_.size());
    for (int k = 0; k < transfer_.cols(); ++k)
      sum += transfer_(i, k) * root_rates_[k < moved ? k : independent_[k - moved]];
    rates[roots_[dependent_[i]]] = sum;
  }
  follow(released, rates);
  bodies.set(released, rates);
  return true;
}

/// Sets right_ to the solution for the factors of loops_. As Eigen's solve(), but that allocates memory in Eigen 5.
void DependentRates::solve_loops(const Eigen::Ref<const Eigen::VectorXd>& given) {
  right_.noalias() = loops_.permutationP() * given;
  loops_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(right_);
  loops_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(right_);
}

/// Sets G: first the columns of motions, then those of the independent coordinates.
void DependentRates::find_columns() {
  const int moved = static_cast<int>(motions_.size());
  columns_.setZero();
  const auto column_of = [&](int k) { return k < moved ? k : independent_[k - moved]; };
  for (int k = 0; k < transfer_.cols() && rows_ > 0; ++k) {
    solve_loops(jacobian_.col(column_of(k)));
    transfer_.col(k) = -right_;
  }
  for (int rate = 0; rate < rates_; ++rate) {
    const int root = root_column_[rate];
    const auto found = std::find(dependent_.begin(), dependent_.end(), root);
    if (found != dependent_.end())
      columns_.row(rate) = factors_[rate] * transfer_.row(found - dependent_.begin());
    else
      for (int k = 0; k < columns_.cols(); ++k)
        if (column_of(k) == root) columns_(rate, k) = factors_[rate];
  }
}

/// The second derivative of a constraint's value, at the bodies' present accelerations.
double DependentRates::find_curvature(const LoopClosure& closure, const ClosureConstraint& constraint,
                                      const ArticulatedBodies& bodies) const {
  const Carried normal = carried(bodies, closure.parent, constraint.normal);
  Carried other;
  if (constraint.kind == ClosureConstraint::Kind::Gap) {
    const Carried child = point(bodies, closure.child, closure.child_arm),
                  parent = point(bodies, closure.parent, closure.parent_arm);
    other = {child.value - parent.value, child.rate - parent.rate, child.change - parent.change};
  } else {
    other = carried(bodies, closure.child, constraint.direction);
  }
  const double change =
      other.change.dot(normal.value) + 2 * other.rate.dot(normal.rate) + other.value.dot(normal.change);
  return change / constraint_scale(model_, constraint);
}

void DependentRates::accelerate(std::size_t stage, const double* efforts, const double* armatures,
                                ArticulatedBodies& bodies, double* rates_change) {
  const int moved = static_cast<int>(motions_.size()), free = static_cast<int>(independent_.size());
  // Derivatives of all rates if those of the independent coordinates are constant.
  bend_.setZero();
  for (int i = 0; i < moved; ++i) bend_ += derivative(stage, 2, motions_[i]) * columns_.col(i);
  change_ = follower_bends_;
  if (rows_ > 0) {
    bodies.set_accelerations(change_.data());
    int row = 0;
    for_each_constraint(model_, Constraints::WithMultipliers, [&](const auto& closure, const auto& constraint) {
      values_[row++] = find_curvature(closure, constraint, bodies);
    });
    solve_loops(values_);
    for (int i = 0; i < rows_; ++i)
      for (int rate = 0; rate < rates_; ++rate)
        if (root_column_[rate] == dependent_[i]) change_[rate] -= factors_[rate] * right_[i];
  }
  bend_ += change_;

  bodies.set_accelerations(bend_.data());
  bodies.find_needed_efforts(bend_.data(), armatures, needed_.data());
  bodies.find_mass_matrix(armatures, mass_);
  forces_ = Eigen::Map<const Eigen::VectorXd>(efforts, rates_) - needed_;
  moved_.noalias() = mass_ * columns_;
  const auto own = columns_.rightCols(free);
  small_.noalias() = own.transpose() * moved_.rightCols(free);
  reduced_.noalias() = own.transpose() * forces_;
  if (free > 0) {
    factor_.compute(small_);
    factor_.solveInPlace(reduced_);
  }
  change_ = bend_;
  change_.noalias() += own * reduced_;
  forces_.noalias() -= moved_.rightCols(free) * reduced_;
  drives_.noalias() = -columns_.leftCols(moved).transpose() * forces_;
  bodies.set_accelerations(change_.data());
  std::copy_n(change_.data(), rates_, rates_change);
}

void DependentRates::add_closure_forces(ArticulatedBodies& bodies) {
  if (rows_ == 0) return;
  // Where a dependent coordinate is not in balance, the multipliers make up for it.
  values_.setZero();
  for (int rate = 0; rate < rates_; ++rate)
    for (int i = 0; i < rows_; ++i)
      if (root_column_[rate] == dependent_[i]) values_[i] -= factors_[rate] * forces_[rate];
  // With P J_D = L U; Eigen's own solution with the transpose allocates memory.
  loops_.matrixLU().triangularView<Eigen::Upper>().transpose().solveInPlace(values_);
  loops_.matrixLU().triangularView<Eigen::UnitLower>().transpose().solveInPlace(values_);
  right_.noalias() = loops_.permutationP().transpose() * values_;
  int row = 0;
  for (std::size_t i = 0; i < model_.closures.size(); ++i) {
    const LoopClosure& closure = model_.closures[i];
    const ClosurePoses poses = poses_of(closure, bodies);
    Vector6 &on_child = closure_forces_[i], on_parent = Vector6::Zero();
    on_child.setZero();
    for (const ClosureConstraint& constraint : closure.constraints) {
      const ClosureRows rows = closure_rows(closure, constraint, poses);
      const double force = right_[row++] / constraint_scale(model_, constraint);
      on_child += force * rows.child, on_parent += force * rows.parent;
    }
    if (closure.child >= 0) bodies.add_force(closure.child, on_child);
    if (closure.parent >= 0) bodies.add_force(closure.parent, on_parent);
  }
}

double DependentRates::strike(const double* before, const double* armatures, ArticulatedBodies& bodies, double* rates) {
  const int moved = static_cast<int>(motions_.size()), free = static_cast<int>(independent_.size());
  bool jumps = false;
  for (int i = 0; i < moved; ++i) {
    const double from = before[roots_[i]], to = rates[roots_[i]];
    jumps = jumps || std::abs(to - from) > kSmoothRate * (std::abs(to) + std::abs(from));
    drives_[i] = to - from;
  }
  if (!jumps) return 0;
  bodies.find_mass_matrix(armatures, mass_);
  moved_.noalias() = mass_ * columns_;
  change_.noalias() = moved_.leftCols(moved) * drives_;
  const auto own = columns_.rightCols(free);
  reduced_.noalias() = -own.transpose() * change_;
  small_.noalias() = own.transpose() * moved_.rightCols(free);
  if (free > 0) {
    factor_.compute(small_);
    factor_.solveInPlace(reduced_);
  }
  change_.noalias() += moved_.rightCols(free) * reduced_;
  double work = 0;
  for (int i = 0; i < moved; ++i) work += 0.5 * columns_.col(i).dot(change_) * (before[roots_[i]] + rates[roots_[i]]);
  for (int i = 0; i < free; ++i) rates[roots_[independent_[i]]] += reduced_[i];
  return work;
}

double DependentRates::largest_opening(const ArticulatedBodies& bodies) const {
  double largest = 0;
  for (const LoopClosure& closure : model_.closures)
    for (const ClosureConstraint& constraint : closure.implied)
      largest = std::max(largest, std::abs(closure_value(closure, constraint, poses_of(closure, bodies))) /
                                      constraint_scale(model_, constraint));
  return largest;
}

}  // namespace flexarm
