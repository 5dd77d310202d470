#include "flexarm/simulation/linear_model.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "math/dense_eigenpairs.h"
#include "math/least_squares.h"
#include "math/pi.h"
#include "math/picked.h"
#include "simulation/freed_joints.h"
#include "simulation/inside.h"
#include "simulation/linear_names.h"
#include "simulation/linear_ports.h"
#include "simulation/linear_scaling.h"

namespace flexarm {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = LinearPort::Kind;

/// An imaginary part that is smaller than this part of |pole| is round-off.
constexpr double kReal = 1e-12;
bool is_real(std::complex<double> pole) {
  return std::abs(pole.imag()) <= kReal * std::abs(pole);
}
/// Sizes relative to the largest pole. Poles below kLeastKnown have no correct digits; poles above kAlike have nearly
/// all.
constexpr double kLeastKnown = 1e-12, kAlike = 1e-5;

Reference reference_of(LinearisedAbout about) {
  if (about == LinearisedAbout::Steady) return Reference::Steady;
  return about == LinearisedAbout::Instant ? Reference::Instant : Reference::Rest;
}

std::vector<std::string> left_out(const Model& model, const State& state) {
  std::vector<std::string> effects;
  if (std::any_of(state.wrenches.begin(), state.wrenches.end(),
                  [](const NodalLoad& wrench) { return wrench.pull.damping > 0; }))
    effects.push_back("dampers of springs that pull on links");
  if (model.maxwell_branches > 0) effects.push_back("<maxwell> elements of beams, which have the stiffness at rest");
  for (const Coordinate& coordinate : model.coordinates) {
    if (coordinate.friction != 0 || coordinate.friction_coefficient != 0)
      effects.push_back(fmt::format("friction of joint coordinate '{}'", coordinate.name));
    if (coordinate.actuator < 0) continue;
    const Actuator& actuator = model.actuators[coordinate.actuator];
    if (actuator.drive.friction != 0 || actuator.drive.loss != 0)
      effects.push_back(fmt::format("friction and losses of the drive of '{}'", coordinate.name));
    if (std::isfinite(actuator.drive.velocity_limit))
      effects.push_back(fmt::format("the speed-dependent limit of the motor of '{}'", coordinate.name));
    if (actuator.gyroscope)
      effects.push_back(fmt::format("the momentum of the rotor of '{}' as its axis turns", coordinate.name));
    if (!actuator.servo) continue;
    const Servo& servo = *actuator.servo;
    if (std::any_of(servo.laws.begin(), servo.laws.end(), [](const ServoLaw& law) { return law.integral != 0; }))
      effects.push_back(fmt::format("the integral of the servo of '{}'", coordinate.name));
    if (servo.sample_time > 0 || servo.delay > 0)
      effects.push_back(fmt::format("samples and delay of the servo of '{}'", coordinate.name));
  }
  return effects;
}

/// Indices into y of the coordinates that become states: first the free ones, then those that a motion input drives.
struct Partition {
  std::vector<int> free, moved;
  std::vector<int> states() const {
    std::vector<int> all = free;
    all.insert(all.end(), moved.begin(), moved.end());
    return all;
  }
};

/// Index of a coordinate in y, or -1.
int place_of(int coordinate, const Model& model, const LinearDynamics& dynamics) {
  const auto& scalars = dynamics.scalars();
  const auto place =
      std::find(scalars.begin(), scalars.end(), dynamics.degrees_of_freedom().scalar_of(model.coordinates[coordinate]));
  return place == scalars.end() ? -1 : static_cast<int>(place - scalars.begin());
}

Partition partition(const Model& model, const LinearDynamics& dynamics, const std::vector<LinearPort>& inputs) {
  Partition out;
  std::vector<bool> is_driven(dynamics.size(), false);
  for (std::size_t c = 0; c < model.coordinates.size(); ++c)
    if (const int place = place_of(static_cast<int>(c), model, dynamics);
        place >= 0 && model.coordinates[c].motion >= 0)
      is_driven[place] = true;
  for (int i = 0; i < dynamics.size(); ++i)
    if (!is_driven[i]) out.free.push_back(i);
  for (const LinearPort& input : inputs) {
    if (input.kind != Kind::Motion) continue;
    const int place = place_of(input.coordinate, model, dynamics);
    if (std::find(out.moved.begin(), out.moved.end(), place) != out.moved.end())
      throw std::invalid_argument(fmt::format("input '{}' is given twice", input.name));
    out.moved.push_back(place);
  }
  return out;
}

/// y'' = by_state x + by_input u.
struct Accelerations {
  MatrixXd by_state, by_input;
};

class StateSpace {
 public:
  StateSpace(const LinearModel& model, Partition parts) : model_(model), parts_(std::move(parts)) {}

  Accelerations accelerations(const MatrixXd& forces, const std::vector<LinearPort>& inputs) const {
    const std::vector<int> states = parts_.states();
    const Eigen::Index free = size(parts_.free), moved = size(parts_.moved), count = free + moved;
    // Columns: x, then u. The rows of driven coordinates only contain their accelerations, which are inputs.
    MatrixXd by_motion = MatrixXd::Zero(moved, static_cast<Eigen::Index>(inputs.size()));
    Eigen::Index next = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i)
      if (inputs[i].kind == Kind::Motion) by_motion(next++, static_cast<Eigen::Index>(i)) = 1;
    MatrixXd right(free, 2 * count + by_motion.cols());
    right << -picked(model_.stiffness, parts_.free, states), -picked(model_.damping, parts_.free, states),
        picked_rows(forces, parts_.free) - picked(model_.mass, parts_.free, parts_.moved) * by_motion;
    const MatrixXd solved = square_solution(picked(model_.mass, parts_.free, parts_.free), right);
    if (!solved.allFinite()) throw std::runtime_error("some coordinate moves nothing that has mass");
    Accelerations out{MatrixXd::Zero(count, 2 * count), MatrixXd::Zero(count, by_motion.cols())};
    out.by_state.topRows(free) = solved.leftCols(2 * count);
    out.by_input.topRows(free) = solved.rightCols(by_motion.cols());
    out.by_input.bottomRows(moved) = by_motion;
    return out;
  }

  static Eigen::Index size(const std::vector<int>& places) { return static_cast<Eigen::Index>(places.size()); }

 private:
  const LinearModel& model_;
  Partition parts_;
};

/// An output as a linear function of y, y' and y''. One or two of the rows are zero for most outputs.
struct OutputRows {
  Eigen::RowVectorXd place, rate, acceleration;
};

OutputRows output_rows(const LinearPort& port, const MovingMatrix& motion, Eigen::Index row, const LinearModel& model,
                       int place) {
  const Eigen::RowVectorXd zero = Eigen::RowVectorXd::Zero(motion.value.cols());
  switch (port.kind) {
    case Kind::Position:
    case Kind::Strain:
    case Kind::SectionForce:
      return {motion.value.row(row), zero, zero};
    case Kind::Velocity:
      return {motion.first.row(row), motion.value.row(row), zero};
    case Kind::Acceleration:
      return {motion.second.row(row), 2 * motion.first.row(row), motion.value.row(row)};
    default:
      return {model.stiffness.row(place), model.damping.row(place), model.mass.row(place)};
  }
}

std::vector<std::string> names_of(const std::vector<LinearPort>& ports) {
  std::vector<std::string> names;
  names.reserve(ports.size());
  for (const LinearPort& port : ports) names.push_back(port.name);
  return names;
}

/// The parts of a linear model other than states, inputs and outputs.
LinearModel equations(const Simulation& simulation, const LinearDynamics& dynamics) {
  LinearModel out;
  out.coordinates =
      coordinate_names(model_of(simulation), dynamics.degrees_of_freedom(), dynamics.scalars(), dynamics.rotors());
  out.mass = dynamics.mass();
  out.damping = dynamics.damping();
  out.stiffness = dynamics.stiffness();
  out.stiffness_round_off = dynamics.stiffness_round_off();
  out.residual = dynamics.residual();
  out.left_out = left_out(model_of(simulation), state_of(simulation));
  return out;
}

/// Generalised forces of the inputs on y, one column per input. Columns of motions are zero, since motions are no
/// forces.
MatrixXd forces_of(const std::vector<LinearPort>& inputs, const Simulation& simulation,
                   const LinearDynamics& dynamics) {
  MatrixXd forces = port_motion(simulation, dynamics, inputs).value.transpose();
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (inputs[i].kind == Kind::Motion) forces.col(static_cast<Eigen::Index>(i)).setZero();
  return forces;
}

void set_states(const std::vector<int>& places, const LinearDynamics& dynamics, const Accelerations& accelerations,
                LinearModel& out) {
  const auto count = static_cast<Eigen::Index>(places.size());
  out.positions = static_cast<int>(count);
  for (const int place : places) out.states.push_back(out.coordinates[place]);
  for (const int place : places) out.states.push_back("d/dt " + out.coordinates[place]);
  out.a = MatrixXd::Zero(2 * count, 2 * count);
  out.a.topRightCorner(count, count).setIdentity();
  out.a.bottomRows(count) = accelerations.by_state;
  out.b = MatrixXd::Zero(2 * count, accelerations.by_input.cols());
  out.b.bottomRows(count) = accelerations.by_input;
  out.drift.resize(2 * count);
  out.drift << picked_rows(dynamics.rates(), places), picked_rows(dynamics.accelerations(), places);
}

/// Joins two sets of eigenpairs: from `slow` those smaller than `size`, from `fast` the others. Empty if the result
/// does not have the right number of pairs.
std::optional<Eigenpairs> joined(const Eigenpairs& fast, const Eigenpairs& slow, double size) {
  const auto places = [&](const Eigenpairs& pairs, bool are_slow) {
    std::vector<Eigen::Index> found;
    for (Eigen::Index i = 0; i < pairs.values.size(); ++i)
      if ((std::abs(pairs.values[i]) < size) == are_slow) found.push_back(i);
    return found;
  };
  const std::vector<Eigen::Index> first = places(slow, true), last = places(fast, false);
  if (first.size() + last.size() != static_cast<std::size_t>(fast.values.size())) return std::nullopt;
  Eigenpairs out;
  out.values.resize(fast.values.size());
  out.values << picked_rows(slow.values, first), picked_rows(fast.values, last);
  out.vectors.resize(fast.vectors.rows(), fast.vectors.cols());
  out.vectors << picked_columns(slow.vectors, first), picked_columns(fast.vectors, last);
  return out;
}

/// The eigenvalue solver has an error relative to the largest eigenvalue. If the slow eigenvalues are much smaller,
/// they are computed once more, as the large eigenvalues of (a - shift)^-1.
Eigenpairs eigenpairs_of_all_sizes(const MatrixXd& a) {
  Eigenpairs fast = dense_eigenpairs(a);
  const VectorXd sizes = fast.values.cwiseAbs();
  const double largest = sizes.maxCoeff(), least_known = kLeastKnown * largest;
  double shift = largest;
  for (Eigen::Index i = 0; i < sizes.size(); ++i)
    if (sizes[i] > least_known) shift = std::min(shift, sizes[i]);
  if (!(shift < kAlike * largest)) return fast;
  const MatrixXd identity = MatrixXd::Identity(a.rows(), a.cols());
  const MatrixXd inverse = square_solution(a - shift * identity, identity);
  if (!inverse.allFinite()) return fast;
  Eigenpairs slow = dense_eigenpairs(inverse);
  slow.values = (shift + slow.values.array().inverse()).matrix();
  const double middle = std::sqrt(shift * largest);
  for (const double size : {middle, 2 * middle, 0.5 * middle, 8 * middle, 0.125 * middle})
    if (std::optional<Eigenpairs> both = joined(fast, slow, size)) return *std::move(both);
  return fast;
}

/// Rounds poles to 0 that are 0 within round-off. A motion without stiffness has the poles 0 and -d, where d is its
/// damping per mass. Round-off e of its stiffness per mass makes these the roots of p^2 + d p + e.
class ZeroPoles {
 public:
  ZeroPoles(const LinearModel& model, const ScaledStates& scaled) : zero_(scaled.zero) {
    if (scaled.places.empty()) return;
    mass_ = picked(model.mass, scaled.places, scaled.places);
    damping_ = picked(model.damping, scaled.places, scaled.places);
    if (model.stiffness_round_off.size() > 0)
      round_off_ = picked_rows(model.stiffness_round_off, scaled.places).cwiseSqrt();
    else
      round_off_ = VectorXd::Zero(mass_.rows());
  }
  std::complex<double> rounded(const Pole& pole) const {
    const std::complex<double> value(pole.value.real(), is_real(pole.value) ? 0 : pole.value.imag());
    if (mass_.size() == 0) return value;
    const Eigen::VectorXcd motion = pole.mode.head(mass_.rows());
    const std::complex<double> mass = motion.dot(mass_ * motion), damping = motion.dot(damping_ * motion) / mass;
    const double size = std::abs(value), other = std::abs(value + damping);
    // The larger root is known, unless round-off alone separates the two.
    if (size > other && std::abs(damping) > 0.5 * size) return value;
    const double assembled = round_off_.dot(motion.cwiseAbs());
    return size * other <= zero_ * zero_ + assembled * assembled / std::abs(mass) ? 0 : value;
  }

 private:
  double zero_;
  MatrixXd mass_, damping_;  // of the positions; empty if they are not known
  VectorXd round_off_;       // square root of the round-off of the diagonal of the stiffness
};

}  // namespace

LinearModel linearise(const Simulation& simulation, const LinearRequest& request) {
  const Model& model = model_of(simulation);
  // y contains the coordinates of driven joints, which held joints do not have.
  if (!model.held.empty()) return linearise(with_joints_freed(simulation), request);
  const std::vector<LinearPort> inputs = input_ports(simulation, request.inputs);
  const std::vector<LinearPort> outputs = output_ports(simulation, request.outputs);
  const LinearDynamics dynamics(model, state_of(simulation), scheme_of(simulation), reference_of(request.about),
                                published_rates(simulation));
  LinearModel out = equations(simulation, dynamics);
  out.inputs = names_of(inputs);
  out.outputs = names_of(outputs);
  const Partition parts = partition(model, dynamics, inputs);
  const std::vector<int> places = parts.states();
  const MatrixXd forces = forces_of(inputs, simulation, dynamics);
  const Accelerations accelerations = StateSpace(out, parts).accelerations(forces, inputs);
  set_states(places, dynamics, accelerations, out);

  const MovingMatrix motion = port_motion(simulation, dynamics, outputs);
  out.c.resize(static_cast<Eigen::Index>(outputs.size()), out.a.cols());
  out.d.resize(out.c.rows(), out.b.cols());
  for (Eigen::Index i = 0; i < out.c.rows(); ++i) {
    const LinearPort& port = outputs[static_cast<std::size_t>(i)];
    const int driven = port.kind == Kind::Effort ? place_of(port.coordinate, model, dynamics) : -1;
    const OutputRows rows = output_rows(port, motion, i, out, driven);
    const Eigen::RowVectorXd acceleration = picked_columns(rows.acceleration, places);
    out.c.row(i) << picked_columns(rows.place, places), picked_columns(rows.rate, places);
    out.c.row(i) += acceleration * accelerations.by_state;
    out.d.row(i) = acceleration * accelerations.by_input;
    if (driven >= 0) out.d.row(i) -= forces.row(driven);
  }
  return out;
}

double Pole::frequency() const {
  return std::abs(value.imag()) / (2 * kPi);
}
double Pole::damping_ratio() const {
  return value == 0.0 ? 0 : -value.real() / std::abs(value);
}

std::vector<Pole> poles(const LinearModel& model) {
  std::vector<Pole> out;
  if (model.a.rows() == 0) return out;
  const ScaledStates scaled = scaled_states(model);
  const Eigenpairs pairs = eigenpairs_of_all_sizes(scaled.a);
  const Eigen::MatrixXcd modes = scaled.basis * pairs.vectors;
  const ZeroPoles zeros(model, scaled);
  for (Eigen::Index i = 0; i < pairs.values.size(); ++i) {
    Pole pole{pairs.values[i], 0, modes.col(i)};
    if (pole.value.imag() < 0 && !is_real(pole.value)) continue;
    pole.value = zeros.rounded(pole);
    Eigen::Index state = 0;
    pole.mode.head(model.positions).cwiseAbs().maxCoeff(&state);
    pole.state = static_cast<int>(state);
    pole.mode /= pole.mode[state];
    out.push_back(std::move(pole));
  }
  std::sort(out.begin(), out.end(), [](const Pole& a, const Pole& b) {
    const double size_a = std::abs(a.value), size_b = std::abs(b.value);
    return size_a != size_b ? size_a < size_b : a.value.imag() < b.value.imag();
  });
  return out;
}

}  // namespace flexarm
