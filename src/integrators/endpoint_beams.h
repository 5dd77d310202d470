#pragma once
/// All beams of a model whose forces act at the end of a step (Newmark family), or in equilibrium (Muñoz 2004, ch. 4).

#include "elements/additive_beam.h"
#include "elements/endpoint_beam.h"
#include "integrators/beam_family.h"
#include "integrators/integration_points.h"

namespace flexarm {

class EndpointBeams : public BeamFamily {
 public:
  EndpointBeams(const StepConfiguration& configuration, const StepPrestrains& prestrains);

  void initialise(State& state) override;
  void forget_path(State& state) override { points_.reference.forget_path(state); }
  void begin() override;
  void add_forces(Balance& balance) override;
  void add_inertia(Balance& balance) override;
  void carry_strains(const double* update) override { points_.carry_strains(configuration_.end(), update); }
  bool carries_strains() const override { return points_.carries_strains(); }
  double work_of_prestrains() const override { return points_.work_of_prestrains(); }
  void accept(State& state) override;
  void invalidate() override { points_.invalidate(); }
  const std::vector<Vector3>& total_rotations() const override { return points_.reference.total_rotations(); }
  void set_interpolation(HhtInterpolation* interpolation) override { interpolation_ = interpolation; }

 private:
  template <int Nodes>
  void add_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_tangent,
                  ElementSystem<Nodes>& system);
  bool is_additive() const { return configuration_.scheme().weak_form == WeakForm::Additive; }
  /// Strains are not carried if they belong to another instant, or if the form has other unknowns.
  bool may_carry() const { return !is_additive() && !interpolates_kinematics(); }
  bool interpolates_kinematics() const { return interpolation_ && configuration_.scheme().hht == HhtForm::Kinematics; }

  const StepConfiguration& configuration_;
  HhtInterpolation* interpolation_ = nullptr;
  IntegrationPoints points_;
  NewmarkRule rule_{};
  std::vector<Vector6> end_strain_rates_;
  std::vector<Vector3> end_momentum_rates_;  // per mass point
};

}  // namespace flexarm
