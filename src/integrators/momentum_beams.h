#pragma once
/// All beams of a model over a step of the momentum-conserving schemes of the thesis (Muñoz 2004, ch. 6).

#include "elements/momentum_beam.h"
#include "elements/rotary_inertia.h"
#include "integrators/beam_family.h"
#include "integrators/integration_points.h"

namespace flexarm {

class MomentumBeams : public BeamFamily {
 public:
  MomentumBeams(const StepConfiguration& configuration, const StepPrestrains& prestrains)
      : configuration_(configuration), points_(configuration, prestrains) {}

  void initialise(State& state) override { points_.reference.initialise(state); }
  void forget_path(State& state) override { points_.reference.forget_path(state); }
  /// Strains are carried only without energy correction, since corrections differentiate the stresses in the tangent.
  void begin() override { points_.begin(configuration_.scheme().correction == EnergyCorrection::None); }
  void add_forces(Balance& balance) override;
  void carry_strains(const double* update) override { points_.carry_strains(configuration_.end(), update); }
  bool carries_strains() const override { return points_.carries_strains(); }
  double work_of_prestrains() const override { return points_.work_of_prestrains(); }
  void accept(State& state) override;
  void invalidate() override { points_.invalidate(); }

 private:
  template <int Nodes>
  void add_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_tangent,
                  ElementEnergy<Nodes>* energy, ElementSystem<Nodes>& system);

  const StepConfiguration& configuration_;
  IntegrationPoints points_;
};

}  // namespace flexarm
