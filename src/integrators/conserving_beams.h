#pragma once
/// All beams and nodes of a model over a step of the energy-momentum family, in packs of elements of equal order.

#include <array>
#include <tuple>
#include <vector>

#include "elements/conserving_pack.h"
#include "integrators/conserving_nodes.h"
#include "integrators/pack_branches.h"
#include "integrators/scheme_family.h"

namespace flexarm {

/// Elements side by side in the lanes of a pack. If elements do not fill the last pack, copies of the last one do.
template <int Nodes>
struct ElementPack {
  static constexpr int kNodes = Nodes;
  int lanes = 0;  // in use
  std::array<std::array<int, Nodes>, Pack::kLanes> nodes;
  std::array<int, Pack::kLanes> first_block, first_stiffness_point;
  ConservingElement<Nodes, Pack> element;
  ElementFunctions<Nodes, Pack> mid_functions;
  CarriedStrains<Nodes, Pack> carried;
  PackBranches<> branches;
  std::array<std::array<PointKinematicsT<Pack>, Nodes - 1>, 2> points;  // at the beginning and at the end
};
template <int Nodes>
using PackGroup = std::vector<ElementPack<Nodes>>;

class ConservingBeams : public SchemeFamily {
 public:
  ConservingBeams(const StepConfiguration& configuration, const StepPrestrains& prestrains);

  void initialise(State& state) override;
  void begin() override;
  void add_forces(Balance& balance) override;
  void add_inertia(Balance& balance) override { nodes_.add(configuration_.motion(), balance); }
  void carry_strains(const double* update) override;
  bool carries_strains() const override { return carries_strains_; }
  double work_of_prestrains() const override;
  NodeState motion_at_end(int node) const override { return flexarm::motion_at_end(configuration_, node); }
  void accept(State& state) override;
  void invalidate() override { holds_begin_points_ = false; }
  bool evaluates_packs() const override { return true; }

 private:
  void set_prestrains();
  void set_begin_points();
  void set_mid_functions();

  template <int Nodes>
  static BeamNodes<Nodes, Pack> gather(const ElementPack<Nodes>& pack, const StepMotion& step);
  template <int Nodes>
  static void gather(const ElementPack<Nodes>& pack, const std::vector<StrainMemory>& memory,
                     std::array<StrainMemoryT<Pack>, Nodes - 1>& points);
  template <int Nodes>
  static void scatter(const ElementPack<Nodes>& pack, const std::array<StrainMemoryT<Pack>, Nodes - 1>& points,
                      std::vector<StrainMemory>& memory);
  template <int Nodes>
  static void scatter(const ElementPack<Nodes>& pack, const BlockSystem<Nodes, Pack>& system, Balance& balance,
                      bool with_tangent);

  const StepConfiguration& configuration_;
  const StepPrestrains& prestrains_;
  TimeRule rule_;
  ConservingNodes nodes_;
  std::tuple<PackGroup<2>, PackGroup<3>, PackGroup<4>, PackGroup<5>> groups_;
  bool has_memory_ = false;               // numerical dissipation or structural damping keep State::strain_memory
  std::vector<StrainMemory> end_memory_;  // per stiffness point, where has_memory_
  bool carries_strains_ = false;
  int begin_ = 0;                    // index into ElementPack::points of the points at the beginning
  bool holds_begin_points_ = false;  // whether these points are known from the last step
};

/// Initial memory of numerical dissipation and structural damping, per stiffness point: the strain rates that follow
/// from the velocities of `state` [1/s, 1/(m s)].
std::vector<StrainMemory> initial_strain_memory(const Model& model, const State& state);

}  // namespace flexarm
