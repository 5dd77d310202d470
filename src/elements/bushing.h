#pragma once
/// A bushing: six stiffnesses and dampings between two frames. (docs/notes/joints.md, "Bushings")

#include "model/force_element.h"

namespace flexarm {

/// Its measures are e = {u, p}: the way u from the point of `from` to that of `to`, along the axes of `from`, less that
/// at the start; and the rotation p of the axes of `to` in those of `from`, as a vector of the length 2 tan(angle/2).
/// The forces have the potential e . stiffness e / 2. Over a step of a conserving scheme their work is exactly the
/// change of that potential, and they change no momentum.
class Bushing : public ForceElement {
 public:
  struct Law {
    Matrix6 stiffness = Matrix6::Zero();  ///< symmetric, positive semidefinite [N/m, N, N m/rad]
    Matrix6 damping = Matrix6::Zero();    ///< the same [N s/m, N s, N m s/rad]
    Vector3 rest = Vector3::Zero();       ///< the way at the start, along the axes of `from` [m]
  };

  /// `from`, `to`: the two frames. Their axes, of `orientation`, are in the same directions where nothing is turned. At
  /// least one of them moves.
  Bushing(std::string name, const NodePoint& from, const NodePoint& to, const Law& law);

  const char* kind() const override { return "bushing"; }
  std::string description() const override;
  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  double energy(const State& state, const double* memory) const override;
  ForceMeasures measures(const State& state, const double* memory, const int* nodes) const override;
  DamperTensions dampers(const State& state, const double* memory, const Eigen::VectorXd& rates) const override;
  /// The measures, then force and moment on `to`, along the axes of `from`. (The moments are those on p.)
  std::vector<ForceOutput> outputs() const override;
  void put_out(const ForceMotion& motion, std::vector<double>& values) const override;
  void put_line(const ForceMotion& motion, std::vector<Vector3>& points) const override;
  std::size_t most_line_points() const override { return 2; }

 private:
  NodePoint from_, to_;
  Law law_;
};

}  // namespace flexarm
