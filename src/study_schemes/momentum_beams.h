#pragma once
/// All beams and nodes of a model over a step of the momentum-conserving schemes of the thesis (Muñoz 2004, ch. 6).

#include "integrators/scheme_family.h"
#include "study_schemes/bodies.h"
#include "study_schemes/integration_points.h"
#include "study_schemes/momentum_beam.h"
#include "study_schemes/rotary_inertia.h"

namespace flexarm {

class MomentumBeams : public SchemeFamily {
 public:
  MomentumBeams(const StepConfiguration& configuration, const StepPrestrains& prestrains)
      : configuration_(configuration), points_(configuration, prestrains), bodies_(configuration, points_) {}

  void initialise(State& state) override { points_.reference.initialise(state); }
  void forget_path(State& state) override { points_.reference.forget_path(state); }
  /// Strains are carried only without energy correction, since corrections differentiate the stresses in the tangent.
  void begin() override { points_.begin(configuration_.scheme().correction == EnergyCorrection::None); }
  void add_forces(Balance& balance) override;
  void add_inertia(Balance& balance) override { bodies_.add_inertia(balance); }
  void carry_strains(const double* update) override { points_.carry_strains(configuration_.end(), update); }
  bool carries_strains() const override { return points_.carries_strains(); }
  double work_of_prestrains() const override { return points_.work_of_prestrains(); }
  NodeState motion_at_end(int node) const override { return bodies_.motion_at_end(node); }
  void accept(State& state) override;
  void invalidate() override { points_.invalidate(); }

 private:
  template <int Nodes>
  void add_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_tangent,
                  ElementEnergy<Nodes>* energy, ElementSystem<Nodes>& system);

  const StepConfiguration& configuration_;
  IntegrationPoints points_;
  Bodies bodies_;
};

}  // namespace flexarm
