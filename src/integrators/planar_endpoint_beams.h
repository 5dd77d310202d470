#pragma once
/// All beams, and the inertia of all nodes, over a step of Newmark's family in a plane. (docs/notes/planar.md)

#include "elements/planar_endpoint.h"
#include "integrators/planar_family.h"
#include "integrators/rotation_reference.h"

namespace flexarm {

class PlanarEndpointBeams : public PlanarFamily {
 public:
  /// Of a configuration that moves in this plane, by a scheme with StressRule::EndPoint, the local interpolation and
  /// the weak form of spins; both must outlive it.
  PlanarEndpointBeams(const StepConfiguration& configuration, const PlaneOfMotion& plane);

  void begin() override;
  void add_forces(Balance& balance) override;
  /// Of the nodes as well; hands all forces over to the balance.
  void add_inertia(Balance& balance) override;
  void carry_strains(const double* update) override;
  void accept(State& state) override;
  void set_interpolation(HhtInterpolation* interpolation) override { interpolation_ = interpolation; }

 private:
  template <int Nodes>
  struct EndpointPack : ElementPack<Nodes> {
    std::array<int, Pack::kLanes> first_mass_point;
    planar::RotaryElement<Nodes, Pack> rotary;
    planar::EndpointMemory<Nodes, Pack> begin;
    planar::EndpointResult<Nodes, Pack> end;
    std::array<Vector3T<Pack>, Nodes - 1> carried;
  };
  template <int Nodes>
  using Group = std::vector<EndpointPack<Nodes>>;
  /// A node's motion over the step in the plane, {., ., about the normal}.
  struct NodeMotion {
    Vector3 velocity, acceleration;  // at the beginning
    Vector3 rest;                    // the acceleration at the end if nothing moves
  };
  /// What is gathered of a node: four numbers.
  struct alignas(32) NodeRate {
    double ax = 0, ay = 0, turn = 0, turning = 0;  // acceleration at the end, angle over the step, its acceleration
  };
  struct alignas(32) NodeDamping {
    double dx = 0, dy = 0, vx = 0, vy = 0;  // displacement, velocity at t_{n+1+alpha}
  };

  bool interpolates_kinematics() const { return rule_.hht == HhtForm::Kinematics; }
  template <int Nodes>
  void set_begin_points(EndpointPack<Nodes>& pack) const;
  template <int Nodes>
  void remember(EndpointPack<Nodes>& pack) const;
  void set_end();
  template <int Nodes>
  planar::EndpointNodal<Nodes, Pack> gather_motion(const EndpointPack<Nodes>& pack) const;
  void accept_nodes(State& state) const;
  template <int Nodes>
  void accept_points(const EndpointPack<Nodes>& pack, State& state) const;

  HhtInterpolation* interpolation_ = nullptr;
  RotationReference reference_;  // total rotations of HHT1
  planar::EndpointBalance balance_;
  std::tuple<Group<2>, Group<3>, Group<4>, Group<5>> groups_;
  std::vector<NodeMotion> motions_;
  std::vector<NodeRate> rates_;
  std::vector<NodeDamping> damping_;
  std::vector<PlanarPose> interpolated_;  // HHT3: where strains count
  std::vector<NodeForce> internal_;       // what is interpolated in time
  bool has_mass_damping_ = false;
};

}  // namespace flexarm
