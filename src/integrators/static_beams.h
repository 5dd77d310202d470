#pragma once
/// All beams of a model in equilibrium.

#include "elements/node_motion.h"
#include "elements/static_beam.h"
#include "integrators/scheme_family.h"

namespace flexarm {

class StaticBeams : public SchemeFamily {
 public:
  StaticBeams(const StepConfiguration& configuration, const StepPrestrains& prestrains);

  void begin() override;
  void add_forces(Balance& balance) override;
  void carry_strains(const double* update) override;
  bool carries_strains() const override { return carries_strains_; }
  NodeState motion_at_end(int node) const override { return at_rest(configuration_.end()[node]); }
  void accept(State& state) override;
  void invalidate() override {}

 private:
  /// Calls visit(element, its nodes) for all elements.
  template <class Visit>
  void for_each(const std::vector<NodePose>& poses, const Visit& visit) const;

  const StepConfiguration& configuration_;
  const StepPrestrains& prestrains_;
  bool carries_strains_ = false;
  std::vector<Vector6> carried_;  // strains for the next tangent, per stiffness point
};

}  // namespace flexarm
