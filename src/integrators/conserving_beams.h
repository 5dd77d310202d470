#pragma once
/// All beams of a model over a step of the energy-momentum family, in packs of elements of equal order.

#include <array>
#include <tuple>
#include <vector>

#include "elements/conserving_pack.h"
#include "integrators/step_motion.h"
#include "solver/reduced_residual.h"

namespace flexarm {

/// Life of a step: begin points (kept from the last step by accept()), middle functions, then add() until converged.
class ConservingBeams {
 public:
  /// Empty unless the rule is one of the family.
  ConservingBeams(const Model& model, const TimeRule& rule);

  /// True where numerical dissipation or structural damping keeps State::strain_memory.
  bool has_memory() const { return has_memory_; }
  /// Stiffness points of a configuration at the begin.
  void set_begin(const std::vector<NodePose>& begin);
  /// Test functions for the middle of the step, as the velocities at the begin foresee it.
  void set_mid_functions(const StepMotion& step);
  /// Adds forces, damping and translational inertia. `end_memory`: per stiffness point, where has_memory().
  void add(const StepMotion& step, Balance& balance, std::vector<StrainMemory>& end_memory);
  /// The points of the last add() are those at the begin of the next step.
  void accept() { begin_ = 1 - begin_; }

 private:
  /// Elements side by side; the last one fills what the group leaves of its last pack.
  template <int Nodes>
  struct ElementPack {
    static constexpr int kNodes = Nodes;
    int lanes = 0;  // in use
    std::array<std::array<int, Nodes>, Pack::kLanes> nodes;
    std::array<int, Pack::kLanes> first_block, first_stiffness_point;
    ConservingElement<Nodes, Pack> element;
    ElementFunctions<Nodes, Pack> mid_functions;
    std::array<std::array<PointKinematicsT<Pack>, Nodes - 1>, 2> points;  // at the begin and at the end
  };
  template <int Nodes>
  using PackGroup = std::vector<ElementPack<Nodes>>;

  template <int Nodes>
  static BeamNodes<Nodes, Pack> gather(const ElementPack<Nodes>& pack, const StepMotion& step);
  template <int Nodes>
  static void gather(const ElementPack<Nodes>& pack, const std::vector<StrainMemory>& memory,
                     std::array<StrainMemoryT<Pack>, Nodes - 1>& points);
  template <int Nodes>
  static void scatter(const ElementPack<Nodes>& pack, const std::array<StrainMemoryT<Pack>, Nodes - 1>& points,
                      std::vector<StrainMemory>& memory);
  template <int Nodes>
  static void scatter(const ElementPack<Nodes>& pack, const BlockSystem<Nodes, Pack>& system, Balance& balance);

  TimeRule rule_;
  std::tuple<PackGroup<2>, PackGroup<3>, PackGroup<4>, PackGroup<5>> groups_;
  bool has_memory_ = false;
  int begin_ = 0;  // which of ElementPack::points
};

}  // namespace flexarm
