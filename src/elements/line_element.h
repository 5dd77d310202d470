#pragma once
/// Base class of force elements that act along the straight line between two points.

#include "joints/coordinate_step.h"
#include "model/force_element.h"
#include "model/state.h"

namespace flexarm {

/// Tension over a step.
struct LineTension {
  double value = 0;       ///< positive if it pulls the points together [N]
  double slope = 0;       ///< derivative with respect to the length at the end [N/m]
  double dissipated = 0;  ///< over the step [J]
  double work = 0;        ///< done on the mechanism from outside [J]
};

/// A force element that pulls two points together, or pushes them apart. Derived classes define the tension as a
/// function of the length. Over a step it acts as LineStep says.
class LineElement : public ForceElement {
 public:
  /// At least one of the points must be on a node, and not both on the same one.
  LineElement(std::string name, const NodePoint& from, const NodePoint& to);

  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  double energy(const State& state, const double* memory) const final;
  ForceMeasures measures(const State& state, const double* memory, const int* nodes) const final;
  DamperTensions dampers(const State& state, const double* memory, const Eigen::VectorXd& rates) const final;
  /// The length [m], and the tension [N] with published velocities.
  std::vector<ForceOutput> outputs() const override;
  void put_out(const ForceMotion& motion, std::vector<double>& values) const override;
  void put_line(const ForceMotion& motion, std::vector<Vector3>& points) const override;
  std::size_t most_line_points() const override { return 2; }

 protected:
  /// Returns the tension over a step. `change`: of the length.
  virtual LineTension tension(const CoordinateStep& change) const = 0;
  /// Returns the stored energy at a length [J].
  virtual double energy(double length) const = 0;
  /// Returns the elastic tension at a length [N] and its slope [N/m].
  virtual LineTension elastic(double length) const = 0;
  /// Returns the tension of dampers at a rate of the length [N], and its slope [N s/m].
  virtual LineTension damper(double rate) const = 0;

 private:
  NodePoint child_, parent_;  // the child is always on a node
};

}  // namespace flexarm
