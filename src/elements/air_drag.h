#pragma once
/// The drag of air, or another fluid at rest, on a link.

#include <string>
#include <vector>

#include "model/force_element.h"

namespace flexarm {

/// A place at which drag acts, and its resistance. The force is -|u| sum_i resistance_i u_i e_i, with the components
/// u_i of the place's velocity along its axes e_i. The speed |u| counts only axes with resistance: along a slender
/// beam, air meets nothing, and the drag across it depends on the velocity across it.
struct DragPlace {
  NodePoint point;     ///< its axes are those of `orientation`
  Vector3 resistance;  ///< half the density times coefficient and area that flow along each axis meets [kg/m]
};

/// Quadratic drag on places of a link. Its work over a step of a conserving scheme is exact: the force follows from the
/// mean velocity of the place, and never does positive work.
class AirDrag : public ForceElement {
 public:
  /// `places`: each on another node.
  AirDrag(std::string link, std::vector<DragPlace> places);

  const char* kind() const override { return "drag"; }
  const ForcePieces& pieces() const override { return pieces_; }
  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  double energy(const State&, const double*) const override { return 0; }
  /// Displacements along the axes of each place. They have no stiffness.
  ForceMeasures measures(const State& state, const double* memory, const int* nodes) const override;
  DamperTensions dampers(const State& state, const double* memory, const Eigen::VectorXd& rates) const override;
  /// The whole force, world axes [N].
  std::vector<ForceOutput> outputs() const override { return {{"fx", "N"}, {"fy", "N"}, {"fz", "N"}}; }
  void put_out(const ForceMotion& motion, std::vector<double>& values) const override;

 private:
  std::vector<DragPlace> places_;
  ForcePieces pieces_;
};

}  // namespace flexarm
