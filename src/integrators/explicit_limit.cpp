#include "integrators/explicit_limit.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "integrators/explicit_step.h"
#include "joints/joint_stop.h"
#include "math/dense_eigenpairs.h"
#include "schemes/explicit_tableau.h"

namespace flexarm {
namespace {

/// How far a method reaches along a direction of the complex plane: the largest |z| up to which a step of y' = z y does
/// not make y grow.
double reach(const ExplicitTableau& tableau, std::complex<double> direction) {
  constexpr double kRefinement = 0.01, kFurthest = 20, kRoundOff = 1e-6;
  std::vector<std::complex<double>> changes(tableau.weights.size());
  for (double size = kRefinement; size < kFurthest; size += kRefinement) {
    const std::complex<double> z = size * direction;
    std::complex<double> end = 1;
    for (std::size_t s = 0; s < changes.size(); ++s) {
      std::complex<double> stage = 1;
      for (std::size_t r = 0; r < s && r < tableau.stages[s].size(); ++r) stage += tableau.stages[s][r] * changes[r];
      changes[s] = z * stage;
      end += tableau.weights[s] * changes[s];
    }
    if (std::abs(end) > 1 + kRoundOff) return size - kRefinement;
  }
  return kFurthest;
}

/// A spring or damper: on a coordinate, on the rotor behind its elastic gear, or between both.
struct Resistance {
  int coordinate;
  const char* cause;
  double on_link, on_rotor;  // how far it is deflected per unit of these positions
  double size;               // [N m/rad, N m s/rad; N/m, N s/m]
};

/// What acts on the joints, and how easily it moves them.
class StiffParts {
 public:
  StiffParts(const Model& model, const Scheme& scheme, const State& state, double step) : model_(model) {
    ExplicitStep stepper(model, scheme);
    mobility_ = stepper.mobility(state, step);
    rates_.reserve(model.coordinates.size());
    for (const Coordinate& coordinate : model.coordinates) rates_.push_back(stepper.rate_of(coordinate));
  }

  void add(std::vector<Resistance>& to, int coordinate, const char* cause, double on_link, double on_rotor,
           double size) const {
    if (size > 0 && rates_[static_cast<std::size_t>(coordinate)] >= 0)
      to.push_back({coordinate, cause, on_link, on_rotor, size});
  }

  /// Fastest rate [1/s] (of dampers) or its square (of springs) with which these parts move the joints together, and
  /// the one that takes the largest part in it.
  std::pair<double, const Resistance*> fastest(const std::vector<Resistance>& parts) const {
    if (parts.empty() || mobility_.size() == 0) return {0, nullptr};
    const auto count = static_cast<Eigen::Index>(parts.size());
    Eigen::MatrixXd rates(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j <= i; ++j)
        rates(i, j) = std::sqrt(parts[i].size * parts[j].size) * mobility(parts[i], parts[j]);
    if (!rates.allFinite()) return {0, nullptr};
    const SymmetricEigenpairs pairs = symmetric_eigenpairs(rates);
    Eigen::Index most = 0;
    pairs.vectors.col(count - 1).cwiseAbs().maxCoeff(&most);
    return {pairs.values[count - 1], &parts[static_cast<std::size_t>(most)]};
  }

 private:
  /// Acceleration of one deflection by a unit effort in the other.
  double mobility(const Resistance& one, const Resistance& other) const {
    const double links =
        one.on_link * other.on_link *
        mobility_(rates_[static_cast<std::size_t>(one.coordinate)], rates_[static_cast<std::size_t>(other.coordinate)]);
    if (one.coordinate != other.coordinate || one.on_rotor * other.on_rotor == 0) return links;
    const double rotor = model_.actuators[model_.coordinates[one.coordinate].actuator].drive.inertia;
    return links + one.on_rotor * other.on_rotor / rotor;
  }

  const Model& model_;
  Eigen::MatrixXd mobility_;  // of the rates
  std::vector<int> rates_;    // per coordinate; -1: it is held
};

/// Adds what an actuator has to springs and dampers.
void add_actuator(const StiffParts& parts, const Actuator& actuator, std::vector<Resistance>& springs,
                  std::vector<Resistance>& dampers) {
  const int at = actuator.coordinate;
  if (actuator.spring) {
    parts.add(springs, at, "spring", 1, 0, actuator.spring->elasticity.stiffness);
    parts.add(dampers, at, "spring", 1, 0, actuator.spring->elasticity.damping);
  }
  const std::optional<Elasticity>& gear = actuator.drive.gear;
  if (gear) {
    parts.add(springs, at, "gear", -1, 1, gear->stiffness);
    parts.add(dampers, at, "gear", -1, 1, gear->damping);
  }
  if (!actuator.servo || actuator.servo->sample_time > 0) return;  // a sampled servo holds its effort
  const ServoLaw& law = actuator.servo->laws.front();
  parts.add(springs, at, "servo", gear ? 0 : 1, gear ? 1 : 0, law.proportional);
  parts.add(dampers, at, "servo", gear ? 0 : 1, gear ? 1 : 0, law.derivative);
}

}  // namespace

ExplicitLimit explicit_limit(const Model& model, const Scheme& scheme, const State& state, double step) {
  const StiffParts parts(model, scheme, state, step);
  const double of_decay = reach(*scheme.tableau, -1), of_oscillation = reach(*scheme.tableau, {0, 1});
  ExplicitLimit limit;
  const auto judge = [&](const std::vector<Resistance>& springs, const std::vector<Resistance>& dampers) {
    for (const bool is_spring : {false, true}) {
      const auto [rate, part] = parts.fastest(is_spring ? springs : dampers);
      const double longest = is_spring ? of_oscillation / std::sqrt(rate) : of_decay / rate;
      if (part && longest < limit.step) limit = {part->coordinate, part->cause, longest};
    }
  };
  std::vector<Resistance> springs, dampers;
  for (std::size_t i = 0; i < model.coordinates.size(); ++i)
    parts.add(dampers, static_cast<int>(i), "damping", 1, 0, model.coordinates[i].damping);
  for (const Actuator& actuator : model.actuators) add_actuator(parts, actuator, springs, dampers);
  judge(springs, dampers);
  for (std::size_t i = 0; i < model.coordinates.size(); ++i) {  // not all stops are reached at a time
    if (!model.coordinates[i].limit) continue;
    const LimitStop& stop = *model.coordinates[i].limit;
    std::vector<Resistance> stiff, viscous;
    parts.add(stiff, static_cast<int>(i), "stop", 1, 0, stop.stiffness);
    parts.add(viscous, static_cast<int>(i), "stop", 1, 0, stop.damping);
    judge(stiff, viscous);
  }
  return limit;
}

}  // namespace flexarm
