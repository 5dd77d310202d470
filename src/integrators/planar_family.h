#pragma once
/// What the families of schemes have in common in steps that are taken in a plane: nodes and packs of elements.
/// (docs/notes/planar.md)

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "elements/planar_point.h"
#include "integrators/beam_family.h"
#include "integrators/gathered.h"
#include "model/plane.h"

namespace flexarm {

/// Adds to the balance in world axes, and to a PlanarTangent in those of the plane.
class PlanarFamily : public BeamFamily {
 public:
  bool carries_strains() const override { return carries_strains_; }
  double work_of_prestrains() const override { return 0; }
  void invalidate() override { holds_begin_points_ = false; }

 protected:
  /// What the node's orientation q is multiplied with for {cosine, sine} of PlanarPose: q . frame, q . (normal frame).
  struct Frame {
    Eigen::Vector4d cosine, sine;
  };
  struct alignas(32) NodeForce {
    double at[4] = {};
  };
  struct Inertia {
    int node;
    double mass, rotary;
  };
  template <int Nodes>
  struct ElementPack {
    static constexpr int kNodes = Nodes;
    int lanes = 0;
    std::array<std::array<int, Nodes>, Pack::kLanes> nodes;
    std::array<int, Pack::kLanes> first_block, first_stiffness_point;
    std::array<Eigen::Matrix<double, 6, 3>, Pack::kLanes> basis;
    planar::Element<Nodes, Pack> element;
  };
  /// Where nodes of a pack stand: positions, and half angles.
  template <int Nodes>
  struct Places {
    std::array<planar::Vector2T<Pack>, Nodes> position;
    std::array<Pack, Nodes> cosine, sine;
  };

  PlanarFamily(const StepConfiguration& configuration, const PlaneOfMotion& plane);

  /// `Packs`: vector of ElementPack<Nodes>, or of what is derived from it.
  template <class Packs, int Nodes>
  void set_packs(const std::vector<BeamElement<Nodes>>& elements, Packs& packs) const;
  PlanarPose pose(std::size_t node, const NodePose& at) const;
  /// Poses at the beginning of the configuration's step.
  void set_begin_poses();
  template <int Nodes>
  Places<Nodes> gather(const ElementPack<Nodes>& pack, const std::vector<PlanarPose>& poses) const;
  template <int Nodes>
  std::array<Vector3T<Pack>, Nodes> gather_update(const ElementPack<Nodes>& pack, const double* update) const;
  /// Forces and tangent of a pack's elements: sums of nodes, and blocks of the balance's tangent.
  template <int Nodes>
  void scatter(const ElementPack<Nodes>& pack, const planar::BlockSystem<Nodes, Pack>& system,
               std::vector<NodeForce>& forces, Balance& balance);
  template <int Nodes>
  void scatter(const ElementPack<Nodes>& pack, const std::array<Eigen::Matrix<Pack, 4, 1>, Nodes>& from,
               std::vector<NodeForce>& to) const;
  Vector6 in_space(const NodeForce& force) const { return plane_.expanded(Eigen::Map<const Vector3>(force.at)); }
  /// Adds the sums of nodes to the balance.
  void hand_over(Balance& balance) const;

  const StepConfiguration& configuration_;
  const PlaneOfMotion& plane_;
  TimeRule rule_;
  std::vector<Frame> frames_;
  std::vector<Vector3> material_normals_;
  std::vector<Inertia> inertias_;
  std::vector<PlanarPose> begin_poses_, end_poses_;
  std::vector<NodeForce> forces_, carried_;
  bool carries_strains_ = false;
  bool holds_begin_points_ = false;
};

/// The planar family of the configuration's scheme, which must have one; both must outlive it.
std::unique_ptr<BeamFamily> make_planar_family(const StepConfiguration& configuration, const PlaneOfMotion& plane);

/// Four numbers of each lane, lane by lane; get(lane) points to them.
template <class Get>
[[gnu::always_inline]] inline std::array<Pack, 4> gathered_four(const Get& get) {
  std::array<Pack, 4> out;
  for (int k = 0; k < 4; ++k) out[k] = gathered([&](int lane) { return get(lane)[k]; });
  return out;
}

template <class Packs, int Nodes>
void PlanarFamily::set_packs(const std::vector<BeamElement<Nodes>>& elements, Packs& packs) const {
  constexpr int lanes = Pack::kLanes;
  const int count = static_cast<int>(elements.size());
  packs.resize((count + lanes - 1) / lanes);
  // Which terms there are is the same for a whole group, so that an element does not feel its neighbours.
  bool is_damped_evenly = true, has_stiffness_damping = false, has_mass_damping = false;
  for (std::size_t p = 0; p < packs.size(); ++p) {
    ElementPack<Nodes>& pack = packs[p];
    const int first = static_cast<int>(p) * lanes;
    pack.lanes = std::min(lanes, count - first);
    for (int lane = 0; lane < lanes; ++lane) {
      const BeamElement<Nodes>& element = elements[std::min(first + lane, count - 1)];
      pack.nodes[lane] = element.nodes;
      pack.first_block[lane] = element.first_block;
      pack.first_stiffness_point[lane] = element.first_stiffness_point;
      pack.basis[lane] = plane_.strain_basis(element.nodes[0]);
      planar::set_lane(pack.element, lane, element, pack.basis[lane]);
    }
    is_damped_evenly = is_damped_evenly && pack.element.is_damped_evenly;
    has_stiffness_damping = has_stiffness_damping || pack.element.has_stiffness_damping;
    has_mass_damping = has_mass_damping || pack.element.has_mass_damping;
  }
  for (ElementPack<Nodes>& pack : packs) {
    pack.element.is_damped_evenly = is_damped_evenly;
    pack.element.has_stiffness_damping = has_stiffness_damping;
    pack.element.has_mass_damping = has_mass_damping;
  }
}

template <int Nodes>
PlanarFamily::Places<Nodes> PlanarFamily::gather(const ElementPack<Nodes>& pack,
                                                 const std::vector<PlanarPose>& poses) const {
  Places<Nodes> places;
  for (int i = 0; i < Nodes; ++i) {
    const auto at = gathered_four([&](int lane) { return &poses[pack.nodes[lane][i]].x; });
    places.position[i] = {at[0], at[1]};
    places.cosine[i] = at[2];
    places.sine[i] = at[3];
  }
  return places;
}

template <int Nodes>
std::array<Vector3T<Pack>, Nodes> PlanarFamily::gather_update(const ElementPack<Nodes>& pack,
                                                              const double* update) const {
  std::array<Vector3T<Pack>, Nodes> updates;
  std::array<Vector3, Pack::kLanes> moved;
  for (int i = 0; i < Nodes; ++i) {
    for (int lane = 0; lane < Pack::kLanes; ++lane)
      moved[lane] = plane_.projected(Eigen::Map<const Vector6>(update + 6 * pack.nodes[lane][i]));
    updates[i] = gathered_vector([&](int lane) -> const Vector3& { return moved[lane]; });
  }
  return updates;
}

template <int Nodes>
void PlanarFamily::scatter(const ElementPack<Nodes>& pack, const std::array<Eigen::Matrix<Pack, 4, 1>, Nodes>& from,
                           std::vector<NodeForce>& to) const {
  std::array<double*, Pack::kLanes> targets;
  for (int i = 0; i < Nodes; ++i) {
    for (int lane = 0; lane < pack.lanes; ++lane) targets[lane] = to[pack.nodes[lane][i]].at;
    add_lanes<4>(from[i].data(), pack.lanes, targets.data());
  }
}

template <int Nodes>
void PlanarFamily::scatter(const ElementPack<Nodes>& pack, const planar::BlockSystem<Nodes, Pack>& system,
                           std::vector<NodeForce>& forces, Balance& balance) {
  scatter<Nodes>(pack, system.residual, forces);
  if (balance.carried) scatter<Nodes>(pack, system.carried, carried_);
  std::array<double*, Pack::kLanes> targets;
  for (int i = 0; i < Nodes && balance.tangent; ++i)
    for (int j = 0; j < Nodes; ++j) {
      for (int lane = 0; lane < pack.lanes; ++lane)
        targets[lane] = balance.tangent->element_block(pack.first_block[lane] + i * Nodes + j);
      add_lanes<12, true>(system.tangent[i][j].data(), pack.lanes, targets.data());
    }
  for (int lane = 0; lane < pack.lanes; ++lane) balance.dissipated += system.dissipated[lane];
}

}  // namespace flexarm
