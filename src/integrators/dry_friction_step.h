#pragma once
/// Dry friction over a step: friction that grows with the force on a joint, and sticking.
///
/// Friction of the coefficient mu turns the coordinate's row left^T g into (left + mu s n)^T g, with the slave's total
/// residual g, the direction n of the force that presses, and the part s in [-1, 1] by which friction acts: its effort
/// is homogeneous in g. So it folds as the joint itself does, with the full tangent. (joints.md 2)
///
/// A coordinate that is held has the row "increment = known" instead of its own, of which the residual is what friction
/// has to hold. Branches of the set-valued law are revised between Newton's iterations: a block principal pivoting
/// (Júdice and Pires, A block principal pivoting algorithm for large-scale strictly monotone linear complementarity
/// problems, Computers & Operations Research 21, 1994), with one exchange at a time where those at once do not settle.

#include <vector>

#include "integrators/balance.h"
#include "integrators/friction_carrier.h"
#include "integrators/step_configuration.h"
#include "integrators/step_events.h"

namespace flexarm {

class DryFrictionStep {
 public:
  /// @throws ModelError if the scheme steps backwards, in which friction that sticks would drive.
  explicit DryFrictionStep(StepConfiguration& configuration);

  void begin();
  /// The same coordinates stick, or slip the same way, as in another system of the same joints.
  void stick_as(const DryFrictionStep& other);
  /// Joints are about to add their friction.
  void begin_evaluation();
  /// Adds friction of constant capacity to the row of a coordinate that moves by `increment` over the step.
  void add_constant(int coordinate, double increment, double& row, Balance& balance);
  /// Turns the row of a joint's coordinate by the friction of the force on the joint; `g`: the slave's residual.
  void add_normal(int joint, const Vector6& g, FoldMaps& maps, Balance& balance);
  void add_normal(int joint, const Vector6& g, SlideMaps& maps, Balance& balance);
  /// Replaces the rows of coordinates that are held; everything is folded.
  void hold(Balance& balance);

  /// After an evaluation at an updated configuration: decides anew which coordinates stick. True if that changes the
  /// equations.
  bool revise();
  /// False if the tangent evaluated last had other coordinates stick.
  bool tangent_holds() const;
  /// After an update: coordinates that are held get the last digits of what it has brought about.
  void place_held();
  /// Notes when friction stops coordinates, as foreseen by their last decelerations, or turns its direction.
  void note_events(FirstEvent& first) const;
  /// True where a coordinate that rested begins to move in the step.
  bool breaks_away() const;
  void accept(State& state) const;
  /// As they are after the last evaluation.
  const std::vector<FrictionCarrier>& carriers() const { return carriers_; }

 private:
  void find_carriers();
  double rate_at_begin(const FrictionCarrier& carrier) const;
  double fraction_of_stop(const FrictionCarrier& carrier, double rate) const;
  double direction(int coordinate) const;
  double travel_per_carrier(int coordinate) const;
  /// The force on the joint presses, and friction grows with it.
  bool turns_row(int joint) const;
  template <class AddDerivative>
  void turn_row(int joint, const Vector6& g, Eigen::Ref<Vector6> left, const AddDerivative& add_derivative,
                Balance& balance);
  void hold_tangent_row(const Coordinate& coordinate, TangentBackend& tangent) const;

  StepConfiguration& configuration_;
  const Model& model_;
  std::vector<FrictionCarrier> carriers_;
  std::vector<int> carrier_of_;                      // per coordinate: index into carriers_, or -1
  std::vector<double> capacities_;                   // per coordinate: of its friction, from the force on the joint
  std::vector<StickSlip::Branch> tangent_branches_;  // per carrier, in the last tangent
  SlideMaps scratch_;
  int revisions_ = 0;  // in this solve
};

}  // namespace flexarm
