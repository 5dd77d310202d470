#pragma once
/// All beams and nodes of a model whose forces act at the end of a step (Newmark family), or in equilibrium with the
/// interpolations and the weak form that only these schemes have (Muñoz 2004, ch. 4).

#include <memory>

#include "integrators/scheme_family.h"
#include "study_schemes/bodies.h"
#include "study_schemes/hht_interpolation.h"
#include "study_schemes/integration_points.h"

namespace flexarm {

class NewmarkBeams : public SchemeFamily {
 public:
  NewmarkBeams(const StepConfiguration& configuration, const StepPrestrains& prestrains);

  void initialise(State& state) override;
  void forget_path(State& state) override { points_.reference.forget_path(state); }
  void begin() override;
  void add_forces(Balance& balance) override;
  void add_loads(const NodalForces& loads, Balance& balance) override;
  void add_inertia(Balance& balance) override;
  void carry_strains(const double* update) override { points_.carry_strains(configuration_.end(), update); }
  bool carries_strains() const override { return points_.carries_strains(); }
  double work_of_prestrains() const override { return points_.work_of_prestrains(); }
  NodeState motion_at_end(int node) const override;
  void accept(State& state) override;
  void invalidate() override { points_.invalidate(); }

 private:
  template <int Nodes>
  void add_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_tangent,
                  ElementSystem<Nodes>& system);
  void add_element_inertia(Balance& balance);
  /// Adds a force on a node, with its derivative by the node's spin, at the instant at which the balance holds.
  /// `of_configuration`: see HhtInterpolation::take().
  void add_nodal(int node, const Vector6& force, Eigen::Matrix<double, 6, 3> rotational, bool of_configuration,
                 Balance& balance);
  bool is_static() const { return configuration_.scheme().is_static; }
  bool is_additive() const { return configuration_.scheme().weak_form == WeakForm::Additive; }
  /// Strains are not carried if they belong to another instant, or if the form has other unknowns.
  bool may_carry() const { return !is_additive() && !interpolates_kinematics(); }
  bool interpolates_kinematics() const { return interpolation_ && configuration_.scheme().hht == HhtForm::Kinematics; }

  const StepConfiguration& configuration_;
  IntegrationPoints points_;
  Bodies bodies_;
  std::unique_ptr<HhtInterpolation> interpolation_;  // null unless forces are interpolated in time
  NewmarkRule rule_{};
  std::vector<Vector6> end_strain_rates_;
  std::vector<Vector3> end_momentum_rates_;  // per mass point
};

}  // namespace flexarm
