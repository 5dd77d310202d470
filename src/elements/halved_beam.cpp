#include "elements/halved_beam.h"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>

#include "math/so3.h"

namespace flexarm {
namespace {

/// The iteration ends when the energy decreases by less than this part of it, or after this many steps. Any place is a
/// valid one, so that the exact minimum does not matter.
constexpr double kSmallDecrease = 1e-12;
constexpr int kMostSteps = 60, kMostShortenings = 30;

std::array<Quaternion, 3> orientations(const ElementNodeStates& nodes) {
  return {nodes[0].orientation, nodes[1].orientation, nodes[2].orientation};
}

std::array<Vector3, 3> positions(const ElementNodeStates& nodes) {
  return {nodes[0].position, nodes[1].position, nodes[2].position};
}

/// Sets an orientation, and keeps the spatial vectors that the state has in the node's frame.
void turn(NodeState& node, const Quaternion& orientation) {
  const Quaternion change = orientation.conjugate() * node.orientation;
  node.angular_velocity = change * node.angular_velocity;
  node.orientation = orientation;
}

/// The nodes of an element of a chain.
ElementNodeStates nodes_of(const std::vector<NodeState>& nodes, std::size_t element) {
  return {nodes[2 * element], nodes[2 * element + 1], nodes[2 * element + 2]};
}

/// Gradient of a chain's strain energy by {displacement, spin} of its nodes, and its Gauss-Newton matrix.
struct ChainSystem {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd matrix;

  ChainSystem(const ElementChain& chain, const Vector6& prestrain, const std::vector<NodeState>& nodes)
      : gradient(Eigen::VectorXd::Zero(6 * nodes.size())),
        matrix(Eigen::MatrixXd::Zero(6 * nodes.size(), 6 * nodes.size())) {
    for (std::size_t e = 0; e < chain.size(); ++e) add(*chain[e], prestrain, nodes_of(nodes, e), 12 * e);
  }

 private:
  void add(const BeamElement<3>& element, const Vector6& prestrain, const ElementNodeStates& nodes, std::size_t first) {
    const LocalRotationVariation<3> local{LocalRotations<3>(orientations(nodes))};
    for (const auto& point : element.stiffness_points) {
      GeneralisedShapeFunctions<3> spins;
      const auto rotation = local.evaluate(point.shape, point.derivative, spins);
      const PointKinematics at =
          point_kinematics(rotation, interpolate<3>(point.derivative, positions(nodes)), point.reference_strain);
      const Matrix3 back = at.rotation.transpose(), turned = back * so3::hat(at.tangent);
      Eigen::Matrix<double, 6, 18> variation;
      for (int i = 0; i < 3; ++i)
        variation.middleCols<6>(6 * i) << point.derivative[i] * back, turned * spins.values[i], Matrix3::Zero(),
            back * spins.derivatives[i];
      const Eigen::Matrix<double, 18, 6> stress = point.weight * variation.transpose() * point.stiffness;
      gradient.segment<18>(first) += stress * (at.strain - prestrain);
      matrix.block<18, 18>(first, first) += stress * variation;
    }
  }
};

std::vector<NodeState> moved(std::vector<NodeState> nodes, const Eigen::VectorXd& way) {
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    nodes[i].position += way.segment<3>(6 * (i - 1));
    const Vector3 angle = way.segment<3>(6 * (i - 1) + 3);
    turn(nodes[i], (so3::exp_quaternion(angle) * nodes[i].orientation).normalized());
  }
  return nodes;
}

}  // namespace

NodeState interpolated_node(const ElementNodeStates& nodes, double xi) {
  const ShapeFunctions<3> functions = lagrange<3>(xi);
  const LocalRotations<3> local(orientations(nodes));
  GeneralisedShapeFunctions<3> spins;
  LocalRotationVariation<3>(local).evaluate(functions.values, functions.derivatives, spins);
  NodeState out;
  out.orientation = (so3::exp_quaternion(local.interpolate(functions.values)) * nodes[1].orientation).normalized();
  out.orientation = so3::nearer_of_two(out.orientation, nodes[1].orientation);
  Vector3 spin = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    out.position += functions.values[i] * nodes[i].position;
    out.velocity += functions.values[i] * nodes[i].velocity;
    out.mean_spin += spins.values[i] * nodes[i].mean_spin;
    spin += spins.values[i] * (nodes[i].orientation * nodes[i].angular_velocity);
  }
  out.angular_velocity = out.orientation.conjugate() * spin;
  return out;
}

double strain_energy(const ElementChain& chain, const Vector6& prestrain, const std::vector<NodeState>& nodes) {
  double energy = 0;
  for (std::size_t e = 0; e < chain.size(); ++e) {
    const ElementNodeStates own = nodes_of(nodes, e);
    const LocalRotations<3> local(orientations(own));
    for (const auto& point : chain[e]->stiffness_points) {
      const Vector6 strain = point_kinematics(local.evaluate(point.shape, point.derivative),
                                              interpolate<3>(point.derivative, positions(own)), point.reference_strain)
                                 .strain -
                             prestrain;
      energy += 0.5 * point.weight * strain.dot(point.stiffness * strain);
    }
  }
  return energy;
}

void settle_between(const ElementChain& chain, const Vector6& prestrain, std::vector<NodeState>& nodes) {
  double energy = strain_energy(chain, prestrain, nodes);
  const auto free = static_cast<Eigen::Index>(6 * (nodes.size() - 2));
  for (int step = 0; step < kMostSteps; ++step) {
    const ChainSystem system(chain, prestrain, nodes);
    const Eigen::VectorXd way = system.matrix.block(6, 6, free, free).ldlt().solve(-system.gradient.segment(6, free));
    if (!way.allFinite()) return;
    std::vector<NodeState> trial;
    double lowest = energy, part = 1;
    for (int i = 0; i < kMostShortenings && !(lowest < energy); ++i, part *= 0.5) {
      trial = moved(nodes, part * way);
      lowest = strain_energy(chain, prestrain, trial);
    }
    if (!(lowest < energy)) return;
    nodes = std::move(trial);
    if (energy - lowest <= kSmallDecrease * energy) return;
    energy = lowest;
  }
}

double bending(const ThreeOrientations& nodes, const ThreeOrientations& undeformed) {
  // In the frame of the middle node.
  const auto from_middle = [](const ThreeOrientations& three, int i) {
    return so3::unfolded_log(Quaternion(three[1].conjugate() * three[i]));
  };
  const auto bent = [&](int i) { return (from_middle(nodes, i) - from_middle(undeformed, i)).norm(); };
  return 2 * std::max(bent(0), bent(2));
}

}  // namespace flexarm
