#pragma once
/// All beams, and the inertia of all nodes, over a step of the energy-momentum family in a plane.
/// (docs/notes/planar.md)

#include <array>
#include <tuple>
#include <vector>

#include "elements/planar_pack.h"
#include "integrators/conserving_nodes.h"
#include "integrators/pack_branches.h"
#include "integrators/scheme_family.h"
#include "model/plane.h"

namespace flexarm {

/// Adds residuals in world axes, and tangent blocks to a PlanarTangent in the axes of the plane.
class PlanarBeams : public SchemeFamily {
 public:
  /// The configuration must move in this plane, with a scheme with StressRule::Conjugate. Both objects must outlive
  /// this.
  PlanarBeams(const StepConfiguration& configuration, const PlaneOfMotion& plane);

  void begin() override;
  void add_forces(Balance& balance) override;
  /// Adds the inertia and the damping of nodes. Then hands all forces over to the balance.
  void add_inertia(Balance& balance) override;
  void carry_strains(const double* update) override;
  bool carries_strains() const override { return carries_strains_; }
  NodeState motion_at_end(int node) const override { return flexarm::motion_at_end(configuration_, node); }
  void accept(State& state) override;
  void invalidate() override { holds_begin_points_ = false; }

 private:
  /// Quaternions whose dot products with a node's orientation are {cosine, sine} of PlanarPose: the frame of the node,
  /// and the quaternion product of the plane's normal and this frame.
  struct Frame {
    Eigen::Vector4d cosine, sine;
  };
  struct alignas(32) NodeForce {
    double at[4] = {};
  };
  struct Inertia {
    int node;
    double mass, rotary, damping;
  };
  /// Data of a node that is gathered in addition to its poses; four numbers, like a pose.
  struct alignas(32) NodeRate {
    double increment = 0, vx = 0, vy = 0, turning = 0;
  };
  template <int Nodes>
  struct ElementPack {
    static constexpr int kNodes = Nodes;
    int lanes = 0;
    std::array<std::array<int, Nodes>, Pack::kLanes> nodes;
    std::array<int, Pack::kLanes> first_block, first_stiffness_point;
    std::array<Eigen::Matrix<double, 6, 3>, Pack::kLanes> basis;
    planar::Element<Nodes, Pack> element;
    Pack slope = Pack(1.0);  // ratio of the middle functions' derivatives to those of Lagrange's functions
    planar::CarriedStrains<Nodes, Pack> carried;
    PackBranches<3> branches;
    std::array<std::array<planar::PointKinematics<Pack>, Nodes - 1>, 2> points;  // at the beginning and at the end
  };
  template <int Nodes>
  using Group = std::vector<ElementPack<Nodes>>;
  template <int Nodes>
  using Memory = std::array<planar::StrainMemory<Pack>, Nodes - 1>;

  template <int Nodes>
  void set_packs(const std::vector<BeamElement<Nodes>>& elements, Group<Nodes>& packs) const;
  void set_nodes();
  PlanarPose pose(std::size_t node, const NodePose& at) const;
  void set_end();
  void set_begin_points();
  void set_slopes();
  template <int Nodes>
  planar::Nodal<Nodes, Pack> gather_motion(const ElementPack<Nodes>& pack) const;
  template <int Nodes>
  std::array<Vector3T<Pack>, Nodes> gather_update(const ElementPack<Nodes>& pack, const double* update) const;
  template <int Nodes>
  void gather(const ElementPack<Nodes>& pack, Memory<Nodes>& memory) const;
  template <int Nodes>
  void scatter(const ElementPack<Nodes>& pack, const Memory<Nodes>& memory);
  /// Adds values of a pack's nodes to those of all nodes.
  template <int Nodes>
  void scatter(const ElementPack<Nodes>& pack, const std::array<Eigen::Matrix<Pack, 4, 1>, Nodes>& from,
               std::vector<NodeForce>& to) const;
  /// Adds forces of a pack's elements to the sums of nodes, and their tangent to the balance's tangent.
  template <int Nodes>
  void scatter(const ElementPack<Nodes>& pack, const planar::BlockSystem<Nodes, Pack>& system, Balance& balance);
  /// Adds the sums of nodes to the balance, in world axes.
  void hand_over(Balance& balance) const;

  const StepConfiguration& configuration_;
  const PlaneOfMotion& plane_;
  TimeRule rule_;
  std::vector<Frame> frames_;
  std::vector<Vector3> material_normals_;
  std::vector<Inertia> inertias_;
  std::tuple<Group<2>, Group<3>, Group<4>, Group<5>> groups_;
  std::vector<PlanarPose> begin_poses_, end_poses_;
  std::vector<NodeRate> rates_;
  std::vector<NodeForce> forces_, carried_;
  std::vector<StrainMemory> end_memory_;
  int begin_ = 0;  // index into ElementPack::points of the points at the beginning
  bool has_memory_ = false;
  bool carries_strains_ = false;
  bool holds_begin_points_ = false;
};

}  // namespace flexarm
