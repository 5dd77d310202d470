#pragma once
/// Dry friction over a step: friction in proportion to the force on a joint, and sticking.
///
/// Friction with the coefficient mu changes the coordinate's row left^T g into (left + mu s n)^T g. Here g is the total
/// residual of the slave, n the direction of the normal force, and s in [-1, 1] the direction and share of friction.
/// The friction effort is homogeneous in g. So it is folded like the joint itself, with the full tangent.
/// (docs/notes/joints.md 2)
///
/// The row of a held coordinate is replaced by "increment = known value". The residual of its own row is then the
/// effort that friction has to hold. The branches of the set-valued law are revised between Newton iterations by block
/// principal pivoting (Júdice and Pires, A block principal pivoting algorithm for large-scale strictly monotone linear
/// complementarity problems, Computers & Operations Research 21, 1994). If exchanges of several coordinates at a time
/// do not settle, only one is exchanged at a time.

#include <vector>

#include "integrators/balance.h"
#include "integrators/friction_carrier.h"
#include "integrators/step_configuration.h"
#include "integrators/step_events.h"
#include "joints/coordinate_step.h"

namespace flexarm {

class DryFrictionStep {
 public:
  /// @throws ModelError if there is friction that sticks and the scheme has backward sub-steps, where it would drive.
  explicit DryFrictionStep(StepConfiguration& configuration);

  void begin();
  /// Takes the branches (sticking or direction of slip) of another system with the same joints.
  void stick_as(const DryFrictionStep& other);
  /// To be called in each evaluation before joints add their friction.
  void begin_evaluation();
  /// Returns the friction that does not depend on the force on the joint, of a coordinate with set-valued friction.
  PassiveEffort constant_effort(int coordinate, const CoordinateStep& change);
  /// Changes a joint's row or maps by the friction due to the force on the joint. `g`: residual of the slave.
  void add_normal(int joint, const Vector6& g, FoldMaps& maps, Balance& balance);
  void add_normal(int joint, const Vector6& g, SlideMaps& maps, Balance& balance);
  /// Replaces the rows of held coordinates. To be called when everything is folded.
  void hold(Balance& balance);

  /// Decides again which coordinates stick, after an evaluation at an updated configuration. Returns whether this
  /// changes the equations.
  bool revise();
  /// Whether the tangent that was evaluated last has the present set of sticking coordinates.
  bool tangent_holds() const;
  /// To be called after an update: gives held coordinates exactly their known increments, without round-off.
  void place_held();
  /// Notes when friction stops a coordinate, predicted from its last deceleration, or changes its direction.
  void note_events(FirstEvent& first) const;
  /// Whether a resting coordinate begins to move in this step.
  bool breaks_away() const;
  void accept(State& state) const;
  /// All carriers, with the values of the last evaluation.
  const std::vector<FrictionCarrier>& carriers() const { return carriers_; }

 private:
  void find_carriers();
  double rate_at_begin(const FrictionCarrier& carrier) const;
  double fraction_of_stop(const FrictionCarrier& carrier, double rate) const;
  double direction(int coordinate) const;
  double travel_per_carrier(int coordinate) const;
  /// Whether friction of this joint depends on the force on the joint.
  bool turns_row(int joint) const;
  template <class AddDerivative>
  void turn_row(int joint, const Vector6& g, Eigen::Ref<Vector6> left, const AddDerivative& add_derivative,
                Balance& balance);
  void hold_tangent_row(const Coordinate& coordinate, TangentBackend& tangent) const;

  StepConfiguration& configuration_;
  const Model& model_;
  std::vector<FrictionCarrier> carriers_;
  std::vector<int> carrier_of_;                      // per coordinate: index into carriers_, or -1
  std::vector<double> capacities_;                   // per coordinate: capacity of its friction at the last evaluation
  std::vector<StickSlip::Branch> tangent_branches_;  // per carrier, in the last tangent
  SlideMaps scratch_;
  int revisions_ = 0;  // in this solve
};

}  // namespace flexarm
