#pragma once
/// Force elements along the line between two points.

#include <array>

#include "joints/coordinate_step.h"
#include "model/force_element.h"
#include "model/state.h"

namespace flexarm {

/// Tension over a step [N], positive where it pulls both points together.
struct LineTension {
  double value = 0;
  double slope = 0;       ///< by the length at the end [N/m]
  double dissipated = 0;  ///< over the step [J]
  double work = 0;        ///< done on the mechanism from outside [J]
};

/// Base of the kinds that pull along the line between two points, or push them apart: they say how the tension follows
/// from the length. Of means over the step with l the mean of both lengths and d that of both distances, the force is
/// tension / l d. Its work is exactly -tension times the change of the length, and it adds to no momentum.
class LineElement : public ForceElement {
 public:
  /// At least one of the points is on a node, and not both on the same.
  LineElement(std::string name, const NodePoint& from, const NodePoint& to);

  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  double energy(const State& state, const double* memory) const final;
  ForceMeasures measures(const State& state, const int* nodes) const final;
  DamperTensions dampers(const State& state, const Eigen::VectorXd& rates) const final;
  /// length [m], and the tension [N] with published velocities
  std::vector<ForceOutput> outputs() const override;
  void put_out(const ForceMotion& motion, std::vector<double>& values) const override;

 protected:
  /// `change`: of the length.
  virtual LineTension tension(const CoordinateStep& change) const = 0;
  /// What is stored at a length [J], and the tension that comes of it [N] with its slope [N/m], as at rest.
  virtual double energy(double length) const = 0;
  virtual LineTension elastic(double length) const = 0;
  /// Of dampers, by the rate of the length: tension [N] and its slope [N s/m].
  virtual LineTension damper(double rate) const = 0;

 private:
  struct Ends;
  /// `nodes`: poses, or a state.
  template <class Nodes>
  Ends ends(const Nodes& nodes) const;
  /// Derivative of the length by {displacement, spin} of the nodes: 6 entries for each.
  Eigen::Matrix<double, 12, 1> gradient(const Ends& ends) const;

  NodePoint child_, parent_;  // the child is on a node
};

}  // namespace flexarm
