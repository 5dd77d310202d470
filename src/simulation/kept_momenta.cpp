#include "simulation/kept_momenta.h"

#include <algorithm>
#include <cassert>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "math/so3.h"

namespace flexarm {
namespace {

/// The correction is linear in the velocities; repetitions only remove round-off.
constexpr int kRepetitions = 3;

/// The momenta are the sums over the nodes j of b_j v_j, and of c_j x v_j + J_j w_j, as far as their velocities count.
class MomentaOfNodes {
 public:
  MomentaOfNodes(const Model& model, const std::vector<int>& nodes, const State& state)
      : count_(static_cast<int>(nodes.size())),
        weights_(Eigen::VectorXd::Zero(count_)),
        arms_(Eigen::MatrixXd::Zero(3, count_)),
        mass_(Eigen::MatrixXd::Zero(count_, count_)) {
    const auto index_of = [&](int node) {
      const auto found = std::find(nodes.begin(), nodes.end(), node);
      return found == nodes.end() ? -1 : static_cast<int>(found - nodes.begin());
    };
    for_each_element(model.beams, [&](const auto& element) {
      constexpr int N = std::decay_t<decltype(element)>::kNodes;
      for (int j = 0; j < N; ++j) {
        const int column = index_of(element.nodes[j]);
        if (column < 0) continue;
        for (int i = 0; i < N; ++i) {
          const double mass = element.mass(i, j);
          weights_[column] += mass;
          arms_.col(column) += mass * state.nodes[element.nodes[i]].position;
          if (const int row = index_of(element.nodes[i]); row >= 0) mass_(row, column) += mass;
        }
      }
    });
    for (int k = 0; k < count_; ++k) {
      const NodalInertia& inertia = model.inertias[nodes[k]];
      weights_[k] += inertia.mass;
      arms_.col(k) += inertia.mass * state.nodes[nodes[k]].position;
      mass_(k, k) += inertia.mass;
      const Matrix3 turn = state.nodes[nodes[k]].orientation.toRotationMatrix();
      rotary_ += turn * (inertia.rotary + inertia.beam_rotary) * turn.transpose();
    }
    solver_.compute(mass_);
  }

  /// The velocities M^-1 B^T (l, a), as columns. All nodes get the spin a.
  Eigen::MatrixXd velocities(const Vector6& multiplier) const {
    const Vector3 linear = multiplier.head<3>(), angular = multiplier.tail<3>();
    Eigen::MatrixXd impulses(count_, 3);
    for (int k = 0; k < count_; ++k)
      impulses.row(k) = (weights_[k] * linear + angular.cross(Vector3(arms_.col(k)))).transpose();
    return solver_.solve(impulses).transpose();
  }
  /// B M^-1 B^T.
  Matrix6 matrix() const {
    Matrix6 out;
    for (int i = 0; i < 6; ++i) {
      const Vector6 unit = Vector6::Unit(i);
      const Eigen::MatrixXd velocity = velocities(unit);
      Vector6 momenta;
      momenta << velocity * weights_, rotary_ * unit.tail<3>();
      for (int k = 0; k < count_; ++k) momenta.tail<3>() += Vector3(arms_.col(k)).cross(Vector3(velocity.col(k)));
      out.col(i) = momenta;
    }
    return out;
  }

 private:
  int count_;
  Eigen::VectorXd weights_;  // b_j
  Eigen::MatrixXd arms_;     // c_j
  Eigen::MatrixXd mass_;
  Matrix3 rotary_ = Matrix3::Zero();  // sum of J_j, world axes
  Eigen::LDLT<Eigen::MatrixXd> solver_;
};

}  // namespace

void keep_momenta(const Model& model, const Scheme& scheme, const std::vector<int>& nodes, const Momenta& wanted,
                  State& state) {
  assert(scheme.nodal_rotary_inertia);
  if (nodes.empty()) return;
  const MomentaOfNodes sums(model, nodes, state);
  const Eigen::FullPivLU<Matrix6> solver(sums.matrix());
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const Momenta now = momenta(model, scheme, state);
    Vector6 missing;
    missing << wanted.linear - now.linear, wanted.angular - now.angular;
    if (missing.isZero(0)) return;
    const Vector6 multiplier = solver.solve(missing);
    const Eigen::MatrixXd velocity = sums.velocities(multiplier);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      NodeState& node = state.nodes[nodes[k]];
      node.velocity += velocity.col(static_cast<int>(k));
      node.angular_velocity += node.orientation.conjugate() * Vector3(multiplier.tail<3>());
    }
  }
}

}  // namespace flexarm
