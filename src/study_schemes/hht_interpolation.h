#pragma once
/// The Hilber-Hughes-Taylor family: forces at t_{n+1+alpha}, in addition to Newmark's rule (Muñoz 2004, sec. 4.2).
///
/// Everything else in the balance must belong to the same instant; otherwise the family has only first order:
/// - Momentum rates are computed in all three forms as in the thesis for HHT3 only (4.13). With (4.14) the gyroscopic
///   terms would belong to t_{n+1}.
/// - HHT1 interpolates the moments that are conjugate to rotation vectors, and transforms them back at the rotation of
///   t_{n+1+alpha}.
/// - Joints transmit the forces of t_{n+1+alpha}, but slaves are folded by the maps of t_{n+1}. So the reactions are
///   extrapolated to t_{n+1} from two steps, (1 - alpha) R_{n+1} + alpha R_n. Without joints the reactions vanish.

#include <vector>

#include "integrators/balance.h"
#include "integrators/step_configuration.h"
#include "study_schemes/element_nodes.h"

namespace flexarm {

/// Collects internal minus external forces at the end of the step, and adds the interpolated forces to the balance.
class HhtInterpolation {
 public:
  /// `total_rotations`: per node, of the trial configuration; used by HHT1 only.
  HhtInterpolation(const StepConfiguration& configuration, const std::vector<Vector3>& total_rotations);

  /// To be called when the trial configuration has changed.
  void begin_evaluation();
  /// The configuration in which forces are evaluated: at t_{n+1+alpha} in HHT3, otherwise at the end of the step.
  const std::vector<NodePose>& configuration() const { return interpolated_; }

  /// Takes over an element's forces, and changes its tangent into that of the interpolated forces.
  template <int Nodes>
  void take(const BeamElement<Nodes>& element, bool with_tangent, ElementSystem<Nodes>& system) {
    for (int i = 0; i < Nodes; ++i) end_forces_[element.nodes[i]] += system.residual.template segment<6>(6 * i);
    system.residual.setZero();  // add_forces() interpolates the sum over each node
    const double factor = 1 + configuration_.scheme().alpha;
    for (int i = 0; i < Nodes && with_tangent; ++i) {
      const int node = element.nodes[i];
      if (of_kinematics()) {
        system.tangent.template middleCols<3>(6 * i) *= factor;
        auto spin = system.tangent.template middleCols<3>(6 * i + 3);
        spin = (spin * interpolated_spins_[node]).eval();
      } else {
        const Matrix3 slope = moment_slope(node);
        system.tangent.template middleRows<3>(6 * i) *= factor;
        system.carried.template segment<3>(6 * i) *= factor;
        system.carried.template segment<3>(6 * i + 3) = (slope * system.carried.template segment<3>(6 * i + 3)).eval();
        auto moment = system.tangent.template middleRows<3>(6 * i + 3);
        moment = (slope * moment).eval();
      }
    }
  }
  /// The same for a force on a node, with its derivative with respect to the node's spin. `of_configuration`: whether
  /// the force depends on configuration(); otherwise it depends on the end of the step.
  void take(int node, const Vector6& force, Eigen::Matrix<double, 6, 3>& rotational, bool of_configuration,
            bool with_tangent);
  /// The same for a constant force.
  void take(int node, const Vector3& force) { end_forces_[node].head<3>() += force; }

  /// Adds the forces at t_{n+1+alpha} to the balance. To be called when all forces were taken.
  void add_forces(Balance& balance) const;
  /// Extrapolates the reactions of joints. To be called when the balance of nodes is complete and before any fold.
  void shift_reactions(Balance& balance);
  void accept(State& state) const;

 private:
  /// A moment on a node at t_{n+1+alpha}; its derivative with respect to the moment at the end (slope); and its
  /// derivative with respect to the node's spin at constant moments.
  struct Moment {
    Vector3 value;
    Matrix3 slope, derivative;
  };
  bool of_kinematics() const { return configuration_.scheme().hht == HhtForm::Kinematics; }
  bool of_rotation_vectors() const { return configuration_.scheme().hht == HhtForm::AdditiveForces; }
  bool has_reactions() const { return !configuration_.state().study.reactions.empty(); }
  Moment moment(int node, const Vector3& begin, const Vector3& end, bool with_derivative) const;
  Matrix3 moment_slope(int node) const { return moment(node, Vector3::Zero(), Vector3::Zero(), false).slope; }

  const StepConfiguration& configuration_;
  const std::vector<Vector3>& total_rotations_;
  std::vector<NodePose> interpolated_;
  std::vector<Matrix3> interpolated_spins_;  // derivative of the spin at t_{n+1+alpha} by the spin at the end
  std::vector<Vector6> end_forces_, end_reactions_;
};

}  // namespace flexarm
