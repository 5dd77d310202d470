#pragma once
/// All beams, and the inertia of all nodes, over a step of the energy-momentum family in a plane.
/// (docs/notes/planar.md)

#include "elements/planar_pack.h"
#include "integrators/planar_family.h"

namespace flexarm {

class PlanarBeams : public PlanarFamily {
 public:
  /// Of a configuration that moves in this plane, by a scheme with StressRule::Conjugate; both must outlive it.
  PlanarBeams(const StepConfiguration& configuration, const PlaneOfMotion& plane);

  void begin() override;
  void add_forces(Balance& balance) override;
  /// Of the nodes; hands all forces over to the balance.
  void add_inertia(Balance& balance) override;
  void carry_strains(const double* update) override;
  void accept(State& state) override;

 private:
  /// What is gathered of a node beside its poses: four numbers, as those.
  struct alignas(32) NodeRate {
    double increment = 0, vx = 0, vy = 0, turning = 0;
  };
  template <int Nodes>
  struct ConservingPack : ElementPack<Nodes> {
    Pack slope = Pack(1.0);  // of the middle functions' derivatives over Lagrange's
    planar::CarriedStrains<Nodes, Pack> carried;
    std::array<std::array<planar::PointKinematics<Pack>, Nodes - 1>, 2> points;  // at the beginning and at the end
  };
  template <int Nodes>
  using Group = std::vector<ConservingPack<Nodes>>;

  void set_end();
  void set_begin_points();
  void set_slopes();
  template <int Nodes>
  planar::Nodal<Nodes, Pack> gather_motion(const ConservingPack<Nodes>& pack) const;
  template <int Nodes>
  void gather(const ConservingPack<Nodes>& pack, std::array<planar::StrainMemory<Pack>, Nodes - 1>& memory) const;
  template <int Nodes>
  void scatter(const ConservingPack<Nodes>& pack, const std::array<planar::StrainMemory<Pack>, Nodes - 1>& memory);

  std::tuple<Group<2>, Group<3>, Group<4>, Group<5>> groups_;
  std::vector<NodeRate> rates_;
  bool has_memory_ = false;
  std::vector<StrainMemory> end_memory_;
  int begin_ = 0;  // which of ConservingPack::points
};

}  // namespace flexarm
