#include "analysis/joint_potential.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/linearised_motion.h"
#include "analysis/passed_contacts.h"
#include "joints/kinematics.h"
#include "math/least_squares.h"

namespace flexarm {
namespace {

/// Most coordinates: matrices of more of them would be large.
constexpr std::size_t kMostAxes = 300;
/// If whole updates lead to no equilibrium, updates with larger rotations are shortened to this [rad].
constexpr double kLargestTurn = 1;
/// Weight of a coordinate with limits, when coordinates are chosen to close loops. The others have 1.
constexpr double kShareOfLimited = 0.1;

bool is_unknown(const DegreesOfFreedom& dof, const Coordinate& coordinate) {
  return dof.equation[dof.scalar_of(coordinate)] >= 0;
}

}  // namespace

bool JointPotentials::exist(const Model& model, const State& state) {
  if (model.coordinates.size() > kMostAxes || is_circulatory(model, state)) return false;
  const DegreesOfFreedom dof(model);
  return std::any_of(model.coordinates.begin(), model.coordinates.end(),
                     [&](const Coordinate& coordinate) { return is_unknown(dof, coordinate); });
}

JointPotentials::JointPotentials(const Model& model, const Scheme& scheme, const StepSettings& settings)
    : model_(model), scheme_(scheme), settings_(settings), system_(model, scheme_, BackendChoice::Matrix) {
  const DegreesOfFreedom& dof = system_.degrees_of_freedom();
  for (std::size_t c = 0; c < model.coordinates.size(); ++c) {
    const Coordinate& coordinate = model.coordinates[c];
    if (is_unknown(dof, coordinate))
      coordinates_.push_back({dof.equation[dof.scalar_of(coordinate)], c, 1 / coordinate_scale(model, coordinate)});
  }
  multipliers_ = multiplier_equations(model, dof);
  axes_ = coordinates_;
  find_bounds();
}

void JointPotentials::find_bounds() {
  stopped_.clear();
  bounds_.clear();
  std::vector<std::size_t> axis_of(model_.coordinates.size(), model_.coordinates.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) axis_of[axes_[i].coordinate] = i;
  for (std::size_t c = 0; c < model_.coordinates.size(); ++c) {
    const Coordinate& coordinate = model_.coordinates[c];
    const bool follows = coordinate.mimicked >= 0;
    if (!coordinate.limit || coordinate.is_angle || coordinate.motion >= 0 || (follows && coordinate.mimic.profile))
      continue;
    const std::size_t axis = axis_of[follows ? coordinate.mimicked : c];
    if (axis == model_.coordinates.size() || (follows && coordinate.mimic.multiplier == 0)) continue;
    add_bounds(axis, c);
  }
}

void JointPotentials::add_bounds(std::size_t axis, std::size_t index) {
  const Coordinate& coordinate = model_.coordinates[index];
  const bool follows = coordinate.mimicked >= 0;
  const double multiplier = follows ? coordinate.mimic.multiplier : 1, offset = follows ? coordinate.mimic.offset : 0;
  stopped_.push_back({axis, index, multiplier});
  const LimitStop& limit = *coordinate.limit;
  const double stiffness = limit.stiffness * multiplier * multiplier;
  const double size = std::abs(multiplier), sign = multiplier > 0 ? 1 : -1;
  if (std::isfinite(limit.lower))
    bounds_.push_back({axis, (limit.lower - offset) / multiplier, -sign, stiffness, limit.give_below / size});
  if (std::isfinite(limit.upper))
    bounds_.push_back({axis, (limit.upper - offset) / multiplier, sign, stiffness, limit.give_above / size});
}

void JointPotentials::add_stops(JointPotential& at) const {
  at.stop_force = at.stop_curvature = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(axes_.size()));
  at.stop_energy = 0;
  for (const Stopped& stopped : stopped_) {
    const Coordinate& coordinate = model_.coordinates[stopped.coordinate];
    CoordinateStep there;
    there.begin = there.end = at.state.released[coordinate.joint].displacement[coordinate.component];
    const PassiveEffort effort = stop_effort(*coordinate.limit, there);
    const double way = stopped.multiplier / axes_[stopped.axis].scale;
    const auto i = static_cast<Eigen::Index>(stopped.axis);
    at.stop_force[i] -= effort.effort * way;
    at.stop_curvature[i] -= effort.slope * way * way;
    at.stop_energy += stop_energy(*coordinate.limit, there.end);
  }
}

double JointPotentials::position(const State& state, std::size_t axis) const {
  assert(axis < axes_.size());
  const Coordinate& coordinate = model_.coordinates[axes_[axis].coordinate];
  return coordinate.is_angle ? 0.0 : state.released[coordinate.joint].displacement[coordinate.component];
}

/// Indices of the coordinates that remain independent. The others are the ones that close loops best: their columns of
/// the constraints' derivatives are independent.
std::vector<std::size_t> JointPotentials::independent(const State& state) const {
  const DegreesOfFreedom& dof = system_.degrees_of_freedom();
  const Eigen::MatrixXd jacobian =
      closure_jacobian({model_, dof, configuration_of(state)}, Constraints::WithMultipliers);
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(coordinates_.size()), jacobian.rows());
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const Coordinate& coordinate = model_.coordinates[coordinates_[i].coordinate];
    // Stops should stay bounds of axes, so coordinates with stops are the last to be chosen to close loops.
    const double share = coordinate.limit ? kShareOfLimited : 1.0;
    columns.row(static_cast<Eigen::Index>(i)) = share * jacobian.col(dof.scalar_of(coordinate)).transpose();
  }
  std::vector<bool> is_taken(coordinates_.size(), false);
  for (const Eigen::Index taken : independent_rows(columns, kIndependent)) is_taken[taken] = true;
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < coordinates_.size(); ++i)
    if (!is_taken[i]) left.push_back(i);
  return left;
}

bool JointPotentials::choose_axes(const State& state) {
  if (multipliers_.empty()) return false;
  std::vector<Axis> chosen;
  for (const std::size_t i : independent(state)) chosen.push_back(coordinates_[i]);
  const auto is_same = [](const Axis& a, const Axis& b) { return a.coordinate == b.coordinate; };
  if (std::equal(chosen.begin(), chosen.end(), axes_.begin(), axes_.end(), is_same)) return false;
  axes_ = std::move(chosen);
  find_bounds();
  return true;
}

JointPotentials::Matrix JointPotentials::tangent_matrix() const {
  const Eigen::Index unknowns = tangent().unknowns();
  return Matrix(unknowns, unknowns, static_cast<Eigen::Index>(tangent().values().size()),
                tangent().column_starts().data(), tangent().row_indices().data(), tangent().values().data());
}

bool JointPotentials::begin(const State& state) {
  choose_axes(state);
  return !axes_.empty() && find_reference(state);
}

bool JointPotentials::find_reference(const State& state) {
  reference_ = work_of_forces(model_, state);
  system_.begin_equilibrium(state, 1);
  if (!system_.evaluate(reference_ == 0)) return false;
  if (reference_ == 0) reference_ = system_.scales().largest_moment(system_.residual());
  if (reference_ != 0) return std::isfinite(reference_);
  const auto stiffness = [&](const Axis& axis) {
    return std::abs(tangent_matrix().coeff(axis.equation, axis.equation)) / (axis.scale * axis.scale);
  };
  for (const Axis& axis : axes_) reference_ = std::max(reference_, stiffness(axis));
  if (reference_ == 0) reference_ = 1;
  return std::isfinite(reference_);
}

/// Replaces the rows of the joint coordinates by those of a unit matrix.
void JointPotentials::hold_joints() {
  for (const Axis& axis : axes_) {
    const Coordinate& coordinate = model_.coordinates[axis.coordinate];
    system_.tangent().hold_row(coordinate.joint, coordinate.component, coordinate.component, ReleasedVector::Ones(1));
  }
}

/// Finds the multipliers of loops. The stiffness contains the multipliers times the second derivatives of the
/// constraints.
bool JointPotentials::find_multipliers(JointPotential& at) {
  at.multipliers = Eigen::VectorXd::Zero(tangent().unknowns());
  if (multipliers_.empty()) return true;
  Eigen::VectorXd solution = -system_.residual();
  for (const Axis& axis : axes_) solution[axis.equation] = 0;
  hold_joints();
  if (!system_.tangent().factorise_and_solve(solution)) return false;
  for (const int equation : multipliers_) at.multipliers[equation] = solution[equation];
  system_.update(at.multipliers);
  return system_.evaluate(true);
}

bool JointPotentials::look(JointPotential& at) {
  system_.begin_equilibrium(at.state, 1);
  if (!system_.evaluate(true) || !find_multipliers(at)) return false;
  const auto size = static_cast<Eigen::Index>(axes_.size());
  const Eigen::Index unknowns = tangent().unknowns();
  const Eigen::SparseMatrix<double> whole = tangent_matrix();
  at.motions = Eigen::MatrixXd::Zero(unknowns, size);
  for (Eigen::Index i = 0; i < size; ++i) at.motions(axes_[i].equation, i) = 1 / axes_[i].scale;
  at.correction = Eigen::VectorXd::Zero(unknowns);
  if (!is_rigid()) {
    Eigen::MatrixXd right(unknowns, size + 1);
    right << -(whole * at.motions), system_.residual();
    for (Eigen::Index i = 0; i < size; ++i) right.row(axes_[i].equation).setZero();
    hold_joints();
    if (!system_.tangent().factorise()) return false;
    for (Eigen::Index i = 0; i <= size; ++i) {
      Eigen::VectorXd column = right.col(i);
      if (!system_.tangent().solve(column)) return false;
      if (i < size)
        at.motions.col(i) += column;
      else
        at.correction = column;
    }
  }
  const Eigen::MatrixXd forces = whole * at.motions;
  const Eigen::VectorXd left = system_.residual() - whole * at.correction;
  at.force.resize(size);
  at.curvature.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    at.force[i] = left[axes_[i].equation] / axes_[i].scale;
    at.curvature.row(i) = forces.row(axes_[i].equation) / axes_[i].scale;
  }
  at.curvature = (0.5 * (at.curvature + at.curvature.transpose())).eval();
  add_stops(at);
  return at.curvature.allFinite() && at.force.allFinite();
}

Eigen::VectorXd JointPotentials::step(const JointPotential& from, const Eigen::VectorXd& ways) const {
  assert(ways.size() == from.motions.cols());
  return from.motions * ways - from.correction;
}

bool JointPotentials::place(const JointPotential& from, const Eigen::VectorXd& step, State& to) {
  to = from.state;
  system_.begin_equilibrium(from.state, 1);
  system_.update(step);
  if (!system_.evaluate(false)) return false;
  system_.accept(to);
  return true;
}

bool JointPotentials::move(const JointPotential& from, const Eigen::VectorXd& ways, State& to, StepResult& result) {
  if (!place(from, step(from, ways), to)) return false;
  if (!is_rigid() && !rest(to, 1, result)) return false;
  return !pass_through(model_, from.state, to);
}

bool JointPotentials::rest(State& state, double factor, StepResult& result) {
  if (is_rigid()) return true;
  return rest(state, factor, std::numeric_limits<double>::infinity(), result) ||
         rest(state, factor, kLargestTurn, result);
}

bool JointPotentials::rest(State& state, double factor, double largest_rotation, StepResult& result) {
  system_.begin_equilibrium(state, factor);
  for (int i = 0; i < settings_.max_iterations; ++i) {
    ++result.iterations;
    result.reason = StepResult::Reason::NotFinite;
    if (!system_.evaluate(true)) return false;
    hold_joints();
    Eigen::VectorXd update = -system_.residual();
    for (const Axis& axis : axes_) update[axis.equation] = 0;
    result.reason = StepResult::Reason::SingularTangent;
    ++result.factorisations;
    if (!system_.tangent().factorise_and_solve(update)) return false;
    const double rotation = system_.scales().largest_rotation(update);
    if (rotation > largest_rotation) update *= largest_rotation / rotation;
    const double norm = system_.scales().norm(update, 0);
    result.reason = StepResult::Reason::NoConvergence;
    if (!std::isfinite(norm)) return false;
    system_.update(update);
    if (norm > settings_.tolerance) continue;
    if (!system_.evaluate(false)) return false;
    system_.accept(state);
    return true;
  }
  return false;
}

double JointPotentials::shift(const JointPotential& from, const Eigen::VectorXd& ways, State& to) {
  const Eigen::VectorXd newton = step(from, ways);
  const double norm = system_.scales().norm(newton, 0);
  return std::isfinite(norm) && place(from, newton, to) ? norm : std::numeric_limits<double>::infinity();
}

Eigen::VectorXd JointPotentials::ways(const State& from, const State& to) const {
  Eigen::VectorXd ways(static_cast<Eigen::Index>(axes_.size()));
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Coordinate& coordinate = model_.coordinates[axes_[i].coordinate];
    const ReleasedVector way = released_increment(model_.joints[coordinate.joint], from.released[coordinate.joint],
                                                  to.released[coordinate.joint]);
    ways[static_cast<Eigen::Index>(i)] = axes_[i].scale * way[coordinate.component];
  }
  return ways;
}

double JointPotentials::round_off_of_loads(const Eigen::VectorXd& motion) const {
  return kStiffnessRoundOff * reference_ * motion.norm();
}

/// Adds up the terms of weight and loads, of springs and stops of coordinates, and of beams.
Eigen::VectorXd JointPotentials::round_off(const JointPotential& at, const Eigen::MatrixXd& curvature,
                                           const Eigen::MatrixXd& motions) const {
  Eigen::VectorXd round_off(motions.cols());
  std::optional<LinearisedMotion> beams;
  if (!is_rigid() && motions.cols() > 0) beams.emplace(model_, at.state);
  for (Eigen::Index m = 0; m < motions.cols(); ++m) {
    const Eigen::VectorXd motion = motions.col(m);
    round_off[m] = round_off_of_loads(motion);
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double place = std::max(1.0, std::abs(axes_[i].scale * position(at.state, i)));
      round_off[m] += kStiffnessRoundOff * std::abs(curvature(k, k)) * place * motion[k] * motion[k];
    }
    if (!beams) continue;
    Eigen::VectorXcd all = Eigen::VectorXcd::Zero(beams->unknowns());
    all.head(at.motions.rows()) = (at.motions * motion).cast<std::complex<double>>();
    round_off[m] += beams->round_off(beams->expand(all).node_motion);
  }
  return round_off;
}

}  // namespace flexarm
