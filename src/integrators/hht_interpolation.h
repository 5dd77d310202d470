#pragma once
/// The Hilber-Hughes-Taylor family: forces at t_{n+1+alpha}, in addition to Newmark's rule (Muñoz 2004, sec. 4.2).
///
/// Everything else in the balance must belong to that instant, too, or the family is first order: - Momentum rates in
/// all three forms as the thesis has them for HHT3 only (4.13). With (4.14) the gyroscopic terms
///   would be those of t_{n+1}. - HHT1 interpolates moments conjugate to rotation vectors and turns them back at the
/// rotation of t_{n+1+alpha}. - Forces that joints transmit are those of t_{n+1+alpha}, but slaves are folded by the
/// maps of t_{n+1}. To fold what
///   belongs there, reactions are extrapolated from two steps, (1 - alpha) R_{n+1} + alpha R_n; without joints they
///   vanish.

#include <vector>

#include "elements/endpoint_beam.h"
#include "integrators/balance.h"
#include "integrators/step_configuration.h"

namespace flexarm {

/// Collects internal less external forces at the end of the step, and puts those of t_{n+1+alpha} into the balance.
class HhtInterpolation {
 public:
  /// `total_rotations`: per node, of the trial configuration; HHT1 only.
  HhtInterpolation(const StepConfiguration& configuration, const std::vector<Vector3>& total_rotations);

  /// The trial configuration has changed.
  void begin_evaluation();
  /// The configuration in which forces are evaluated: that at t_{n+1+alpha} in HHT3, otherwise the end of the step.
  const std::vector<NodePose>& configuration() const { return interpolated_; }

  /// Takes an element's forces over, and turns its tangent into that of the interpolated ones.
  template <int Nodes>
  void take(const BeamElement<Nodes>& element, bool with_tangent, ElementSystem<Nodes>& system) {
    for (int i = 0; i < Nodes; ++i) end_forces_[element.nodes[i]] += system.residual.template segment<6>(6 * i);
    system.residual.setZero();  // interpolated for whole nodes
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
  /// The same for a force on a node and its derivative with respect to the node's spin. `of_configuration`: it depends
  /// on configuration(), not on the end.
  void take(int node, const Vector6& force, Eigen::Matrix<double, 6, 3>& rotational, bool of_configuration,
            bool with_tangent);
  /// A force that does not change.
  void take(int node, const Vector3& force) { end_forces_[node].head<3>() += force; }

  /// Adds the forces of t_{n+1+alpha}; all have been taken.
  void add_forces(Balance& balance) const;
  /// Extrapolates what joints transmit; the balance of nodes is complete, and nothing is folded yet.
  void shift_reactions(Balance& balance);
  void accept(State& state) const;

 private:
  /// A moment on a node at t_{n+1+alpha} from those at both ends, its derivative with respect to the one at the end,
  /// and at constant moments with respect to the node's spin.
  struct Moment {
    Vector3 value;
    Matrix3 slope, derivative;
  };
  bool of_kinematics() const { return configuration_.scheme().hht == HhtForm::Kinematics; }
  bool of_rotation_vectors() const { return configuration_.scheme().hht == HhtForm::AdditiveForces; }
  bool has_reactions() const { return !configuration_.state().reactions.empty(); }
  Moment moment(int node, const Vector3& begin, const Vector3& end, bool with_derivative) const;
  Matrix3 moment_slope(int node) const { return moment(node, Vector3::Zero(), Vector3::Zero(), false).slope; }

  const StepConfiguration& configuration_;
  const std::vector<Vector3>& total_rotations_;
  std::vector<NodePose> interpolated_;
  std::vector<Matrix3> interpolated_spins_;  // spin there per spin at the end
  std::vector<Vector6> end_forces_, end_reactions_;
};

}  // namespace flexarm
