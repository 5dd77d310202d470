#include "analysis/flexible_dead_point.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/linearised_motion.h"
#include "analysis/node_ways.h"
#include "elements/element_configuration.h"
#include "integrators/energies.h"
#include "math/general_vector.h"
#include "model/place.h"

namespace flexarm {
namespace {

/// A small motion [rad, or in units of the length scale]. Its strains are of second order, and still far above
/// round-off.
constexpr double kWay = 1e-5;
/// Drag, relative to the stiffness. It is so small that general forces move mainly what nothing holds.
constexpr double kLittleDrag = 1e-13;
/// A larger drag, which holds free motions while strains are relieved: the stiffness at a dead point, kWay^2, is less.
constexpr double kHoldingDrag = 1e-9;
constexpr int kRelief = 2;
/// Number of general motions that are tried, since one of them may follow a branch by chance.
constexpr int kMotions = 3;
/// A motion is at a dead point if more than kLeft of its strain energy is left after the relief, and more than kStrains
/// times the stiffness times kWay^4. In free motions, kWay^2 of the energy or less is left.
constexpr double kLeft = 1e-2, kStrains = 1e-6;

Model without_prestrains(Model model) {
  std::fill(model.prestrains.begin(), model.prestrains.end(), Prestrain());
  return model;
}

/// The mechanism without loads, which is moved step by step.
class Unloaded {
 public:
  Unloaded(const Model& model, const State& start)
      : model_(model), scheme_(exact_equilibrium()), system_(model, scheme_), state_(start) {}

  const State& state() const { return state_; }
  double strain_energy() const { return energies(model_, scheme_, state_).strain; }
  StepSystem& system() { return system_; }
  /// The forces that balance the strains. Also factorises the tangent for answer().
  Eigen::VectorXd forces(double drag) {
    system_.begin_equilibrium(state_, 0, drag);
    if (!system_.evaluate(true) || !system_.tangent().factorise())
      throw std::runtime_error("the stiffness is not finite");
    return -system_.residual();
  }
  /// The displacements by these forces, one entry per unknown.
  Eigen::VectorXd answer(Eigen::VectorXd forces) {
    if (!system_.tangent().solve(forces)) throw std::runtime_error("the stiffness is not finite");
    return forces;
  }
  /// The general forces without those on multipliers, which would pull loops apart.
  Eigen::VectorXd on_bodies(Eigen::VectorXd general) const {
    for (const int equation : multiplier_equations(model_, system_.degrees_of_freedom())) general[equation] = 0;
    return general;
  }
  void move(const Eigen::VectorXd& motion) {
    system_.update(motion);
    if (!system_.evaluate(false)) throw std::runtime_error("the stiffness is not finite");
    system_.accept(state_);
  }

 private:
  const Model& model_;
  Scheme scheme_;
  StepSystem system_;
  State state_;
};

/// Stiffness of elements against displacements by the length scale and rotations by 1 rad, the mean over all nodes [J].
double typical_stiffness(const Model& model, const State& state) {
  ComplexVector6 unit = ComplexVector6::Ones();
  unit.head<3>() *= model.length_scale;
  const std::vector<ComplexVector6> all(model.nodes.size(), unit);
  return round_off(model, state, all) / kStiffnessRoundOff / static_cast<double>(all.size());
}

std::string most_strained_link(const Model& model, const State& state) {
  double largest = -1;
  std::string name;
  for_each_group(model.beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group.elements)>::value_type::kNodes;
    for (std::size_t e = 0; e < group.elements.size(); ++e) {
      const auto& element = group.elements[e];
      const ElementConfiguration<N> nodes(element, state);
      const LocalRotations<N> local(nodes.orientation);
      double energy = 0;
      for (int k = 0; k < N - 1; ++k) {
        const Vector6 strain = centroid_strain(element, nodes, local, state, k);
        energy += element.stiffness_points[k].weight * strain.dot(element.stiffness_points[k].stiffness * strain);
      }
      if (energy <= largest) continue;
      largest = energy;
      name = model.links[place_of_element(model, state, N - 1, static_cast<int>(e), element.nodes.front()).link].name;
    }
  });
  return name;
}

/// See link_at_dead_point(); for one general motion.
std::string link_strained_in_second_order(const Model& model, const State& start, const Eigen::VectorXd& general) {
  Unloaded mechanism(model, start);
  const double stiffness = typical_stiffness(model, start), before = mechanism.strain_energy();
  const double drag = kLittleDrag * stiffness;
  mechanism.forces(drag);
  // Inverse iteration: what is soft but not free decreases with the square of the drag.
  const Eigen::VectorXd free = mechanism.on_bodies(mechanism.answer(mechanism.on_bodies(general))).normalized();
  const Eigen::VectorXd motion = mechanism.answer(free);
  if (!mechanism.system().tangent().expanded_solution()) return "";  // the tangent is a matrix, not a tree
  const NodeWays ways(model, node_motion_of_solution(mechanism.system()));
  // The product is twice the energy of strains and drag. If nothing is free, strains have by far the most of it.
  if (motion.dot(free) > 2 * drag * ways.sum_of_squares()) return "";
  mechanism.move(kWay / ways.largest() * motion);
  const double strained = mechanism.strain_energy() - before;
  for (int repeat = 0; repeat < kRelief; ++repeat)
    mechanism.move(mechanism.answer(mechanism.forces(kHoldingDrag * stiffness)));
  const double left = mechanism.strain_energy() - before;
  const double least = kStrains * stiffness * std::pow(kWay, 4);
  return left > std::max(kLeft * strained, least) ? most_strained_link(model, mechanism.state()) : "";
}

}  // namespace

std::string link_at_dead_point(const Model& model, const State& start) {
  if (model.stiffness_point_count == 0) return "";
  const Model unstressed = without_prestrains(model);
  const Eigen::Index unknowns = DegreesOfFreedom(model).unknowns;
  for (int k = 0; k < kMotions; ++k) {
    const Eigen::VectorXd general = general_vector(unknowns + k).tail(unknowns);
    std::string link = link_strained_in_second_order(unstressed, start, general);
    if (!link.empty()) return link;
  }
  return "";
}

}  // namespace flexarm
