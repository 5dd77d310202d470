#include "integrators/planar_beams.h"

#include <algorithm>

#include "integrators/gathered.h"
#include "math/simd.h"

namespace flexarm {
namespace {

/// Gathers four numbers per lane; get(lane) points to them.
template <class Get>
[[gnu::always_inline]] inline std::array<Pack, 4> gathered_four(const Get& get) {
  std::array<Pack, 4> out;
  for (int k = 0; k < 4; ++k) out[k] = gathered([&](int lane) { return get(lane)[k]; });
  return out;
}

}  // namespace

PlanarBeams::PlanarBeams(const StepConfiguration& configuration, const PlaneOfMotion& plane)
    : configuration_(configuration),
      plane_(plane),
      rule_(configuration.scheme()),
      begin_poses_(configuration.model().nodes.size()),
      end_poses_(begin_poses_.size()),
      rates_(begin_poses_.size()),
      forces_(begin_poses_.size()),
      carried_(begin_poses_.size()),
      has_memory_(rule_.dissipation.any()) {
  set_nodes();
  for_each_group(configuration.model().beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group)>::kNodes;
    auto& packs = std::get<Group<N>>(groups_);
    set_packs<N>(group.elements, packs);
    if (!packs.empty() && packs.front().element.has_stiffness_damping) has_memory_ = true;
  });
  if (has_memory_) end_memory_.resize(configuration.model().stiffness_point_count);
}

template <int Nodes>
void PlanarBeams::set_packs(const std::vector<BeamElement<Nodes>>& elements, Group<Nodes>& packs) const {
  constexpr int lanes = Pack::kLanes;
  const int count = static_cast<int>(elements.size());
  packs.resize((count + lanes - 1) / lanes);
  // The whole group has the same terms, so that the results of an element do not depend on its neighbours in the pack.
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
      pack.branches.set(lane, element.maxwell, element.first_stiffness_point, configuration_.model().maxwell_branches,
                        Nodes - 1);
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

void PlanarBeams::set_nodes() {
  const Model& model = configuration_.model();
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const Quaternion& frame = plane_.frames[i];
    frames_.push_back(
        {frame.coeffs(), (Quaternion(0, plane_.normal.x(), plane_.normal.y(), plane_.normal.z()) * frame).coeffs()});
    const Vector3 normal = plane_.material_normal(static_cast<int>(i));
    material_normals_.push_back(normal);
    const NodalInertia& inertia = model.inertias[i];
    Matrix3 rotary = inertia.rotary;
    if (rule_.nodal_rotary_inertia) rotary += inertia.beam_rotary;
    const double damping = normal.dot(inertia.rotary_damping * normal);
    if (inertia.mass != 0 || !rotary.isZero(0) || damping != 0)
      inertias_.push_back({static_cast<int>(i), inertia.mass, normal.dot(rotary * normal), damping});
  }
}

PlanarPose PlanarBeams::pose(std::size_t node, const NodePose& at) const {
  const Frame& frame = frames_[node];
  const auto& q = at.orientation.coeffs();
  return {plane_.first.dot(at.position), plane_.second.dot(at.position), q.dot(frame.cosine), q.dot(frame.sine)};
}

void PlanarBeams::begin() {
  const StepMotion step = configuration_.motion();
  for (std::size_t i = 0; i < begin_poses_.size(); ++i) begin_poses_[i] = pose(i, configuration_.begin()[i]);
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    const NodeState& node = step.state.nodes[i];
    rates_[i] = {0, plane_.first.dot(node.velocity), plane_.second.dot(node.velocity),
                 material_normals_[i].dot(node.angular_velocity)};
  }
  if (!holds_begin_points_) set_begin_points();
  holds_begin_points_ = true;
  set_slopes();
  for_each_group(groups_, [&](auto& packs) {
    for (auto& pack : packs) {
      pack.branches.begin(step.state, step.step, [&](int lane, const Vector6& strain) {
        return Vector3(pack.basis[lane].transpose() * strain);
      });
      for (std::size_t k = 0; k < pack.carried.end.size(); ++k) pack.carried.end[k] = pack.points[begin_][k].strain;
      pack.carried.has_conjugate = false;
    }
  });
  carries_strains_ = configuration_.model().stiffness_point_count > 0;
}

void PlanarBeams::set_begin_points() {
  for_each_group(groups_, [&](auto& packs) {
    constexpr int N = std::decay_t<decltype(packs)>::value_type::kNodes;
    for (auto& pack : packs) {
      std::array<planar::Vector2T<Pack>, N> position;
      std::array<Pack, N> cosine, sine;
      for (int i = 0; i < N; ++i) {
        const auto at = gathered_four([&](int lane) { return &begin_poses_[pack.nodes[lane][i]].x; });
        position[i] = {at[0], at[1]};
        cosine[i] = at[2];
        sine[i] = at[3];
      }
      planar::packs::element_points<N>(pack.element, position, cosine, sine, pack.points[begin_].data());
    }
  });
}

/// Sets the ratio of the middle functions' derivatives to those of Lagrange's functions. In the plane the values are
/// Lagrange's; the stretch applies to the derivatives alone, twice. See stretch_mid_functions().
void PlanarBeams::set_slopes() {
  if (rule_.correction != EnergyCorrection::Multiplier || rule_.mid_functions != MidFunctions::Explicit) return;
  const StepMotion step = configuration_.motion();
  for_each_group(groups_, [&](auto& packs) {
    constexpr int N = std::decay_t<decltype(packs)>::value_type::kNodes;
    for (auto& pack : packs) {
      for (int lane = 0; lane < Pack::kLanes; ++lane) {
        double sum = 0;
        for (int i = 0; i < N; ++i) sum += plane_.normal.dot(step.state.nodes[pack.nodes[lane][i]].mean_spin);
        const double mean = step.step * sum / N;
        pack.slope.set(lane, 1 / (1 + 0.25 * mean * mean));
      }
    }
  });
}

/// Computes the poses at the end of the step, and the rotation increments.
void PlanarBeams::set_end() {
  const std::vector<NodePose>& end = configuration_.end();
  for (std::size_t i = 0; i < end.size(); ++i) {
    const PlanarPose at = end_poses_[i] = pose(i, end[i]), from = begin_poses_[i];
    rates_[i].increment =
        2 * (at.sine * from.cosine - at.cosine * from.sine) / (at.cosine * from.cosine + at.sine * from.sine);
  }
}

template <int Nodes>
planar::Nodal<Nodes, Pack> PlanarBeams::gather_motion(const ElementPack<Nodes>& pack) const {
  planar::Nodal<Nodes, Pack> nodes;
  for (int i = 0; i < Nodes; ++i) {
    const auto begin = gathered_four([&](int lane) { return &begin_poses_[pack.nodes[lane][i]].x; });
    const auto end = gathered_four([&](int lane) { return &end_poses_[pack.nodes[lane][i]].x; });
    const auto rate = gathered_four([&](int lane) { return &rates_[pack.nodes[lane][i]].increment; });
    nodes.begin[i] = {begin[0], begin[1]};
    nodes.end[i] = {end[0], end[1]};
    nodes.cosine[i] = end[2];
    nodes.sine[i] = end[3];
    nodes.increment[i] = rate[0];
    nodes.velocity[i] = {rate[1], rate[2]};
  }
  return nodes;
}

template <int Nodes>
std::array<Vector3T<Pack>, Nodes> PlanarBeams::gather_update(const ElementPack<Nodes>& pack,
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
void PlanarBeams::gather(const ElementPack<Nodes>& pack, Memory<Nodes>& memory) const {
  for (int k = 0; k < Nodes - 1; ++k)
    for (int lane = 0; lane < Pack::kLanes; ++lane) {
      const StrainMemory& from = configuration_.state().strain_memory[pack.first_stiffness_point[lane] + k];
      const auto to_plane = [&](const Vector6& strain) { return Vector3(pack.basis[lane].transpose() * strain); };
      set_lane(memory[k].average, lane, to_plane(from.average));
      set_lane(memory[k].rate, lane, to_plane(from.rate));
      set_lane(memory[k].delayed_rate, lane, to_plane(from.delayed_rate));
    }
}

template <int Nodes>
void PlanarBeams::scatter(const ElementPack<Nodes>& pack, const Memory<Nodes>& memory) {
  for (int k = 0; k < Nodes - 1; ++k)
    for (int lane = 0; lane < pack.lanes; ++lane) {
      const auto from_plane = [&](const auto& strain) { return Vector6(pack.basis[lane] * get_lane(strain, lane)); };
      end_memory_[pack.first_stiffness_point[lane] + k] = {from_plane(memory[k].average), from_plane(memory[k].rate),
                                                           from_plane(memory[k].delayed_rate)};
    }
}

template <int Nodes>
void PlanarBeams::scatter(const ElementPack<Nodes>& pack, const std::array<Eigen::Matrix<Pack, 4, 1>, Nodes>& from,
                          std::vector<NodeForce>& to) const {
  std::array<double*, Pack::kLanes> targets = {};  // initialised for compilers that warn about unused lanes
  for (int i = 0; i < Nodes; ++i) {
    for (int lane = 0; lane < pack.lanes; ++lane) targets[lane] = to[pack.nodes[lane][i]].at;
    add_lanes<4>(from[i].data(), pack.lanes, targets.data());
  }
}

template <int Nodes>
void PlanarBeams::scatter(const ElementPack<Nodes>& pack, const planar::BlockSystem<Nodes, Pack>& system,
                          Balance& balance) {
  scatter<Nodes>(pack, system.residual, forces_);
  if (balance.carried) scatter<Nodes>(pack, system.carried, carried_);
  std::array<double*, Pack::kLanes> targets = {};
  for (int i = 0; i < Nodes && balance.tangent; ++i)
    for (int j = 0; j < Nodes; ++j) {
      for (int lane = 0; lane < pack.lanes; ++lane)
        targets[lane] = balance.tangent->element_block(pack.first_block[lane] + i * Nodes + j);
      add_lanes<12, true>(system.tangent[i][j].data(), pack.lanes, targets.data());
    }
  for (int lane = 0; lane < pack.lanes; ++lane) balance.dissipated += system.dissipated[lane];
}

void PlanarBeams::add_forces(Balance& balance) {
  const double step = configuration_.step();
  set_end();
  std::fill(forces_.begin(), forces_.end(), NodeForce());
  if (balance.carried) std::fill(carried_.begin(), carried_.end(), NodeForce());
  for_each_group(groups_, [&](auto& packs) {
    if (packs.empty()) return;
    constexpr int N = std::decay_t<decltype(packs)>::value_type::kNodes;
    simd::run([&] {
      Memory<N> memory, new_memory;
      planar::BlockSystem<N, Pack> system;
      for (auto& pack : packs) {
        if (has_memory_) gather<N>(pack, memory);
        planar::packs::beam<N>(pack.element, pack.slope, gather_motion<N>(pack), rule_, pack.points[begin_].data(),
                               has_memory_ ? memory.data() : nullptr, step, balance.tangent != nullptr,
                               balance.carried ? &pack.carried : nullptr, pack.points[1 - begin_].data(),
                               has_memory_ ? new_memory.data() : nullptr, system, pack.branches.of_step());
        if (has_memory_) scatter<N>(pack, new_memory);
        scatter<N>(pack, system, balance);
      }
    });
  });
  if (balance.tangent) carries_strains_ = false;
}

void PlanarBeams::hand_over(Balance& balance) const {
  const auto in_space = [&](const NodeForce& force) { return plane_.expanded(Eigen::Map<const Vector3>(force.at)); };
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    const int node = static_cast<int>(i);
    balance.residual.node(node) += in_space(forces_[i]);
    if (balance.carried) balance.carried->node(node) += in_space(carried_[i]);
  }
}

/// The same equations as in ConservingNode and NodeDamping.
void PlanarBeams::add_inertia(Balance& balance) {
  const double rate_of_step = 1 / configuration_.step(), factor = rule_.velocity_factor() * rate_of_step;
  for (const Inertia& inertia : inertias_) {
    const PlanarPose &begin = begin_poses_[inertia.node], &end = end_poses_[inertia.node];
    const NodeRate& rate = rates_[inertia.node];
    double* force = forces_[inertia.node].at;
    const double mass = inertia.mass * factor, rotary = inertia.rotary * 2 * rate_of_step;
    force[0] += mass * (rate_of_step * (end.x - begin.x) - rate.vx);
    force[1] += mass * (rate_of_step * (end.y - begin.y) - rate.vy);
    const double damping = inertia.damping * rate_of_step;
    force[2] += rotary * (rate_of_step * rate.increment - rate.turning) + damping * rate.increment;
    balance.dissipated += damping * rate.increment * rate.increment;
    if (!balance.tangent) continue;
    double* tangent = balance.tangent->diagonal_block(inertia.node);
    tangent[0] += mass * rate_of_step;
    tangent[5] += mass * rate_of_step;
    tangent[10] += (rotary * rate_of_step + damping) * (1 + 0.25 * rate.increment * rate.increment);
  }
  hand_over(balance);
}

void PlanarBeams::carry_strains(const double* update) {
  for_each_group(groups_, [&](auto& packs) {
    constexpr int N = std::decay_t<decltype(packs)>::value_type::kNodes;
    for (auto& pack : packs) {
      planar::packs::carry_strains<N>(pack.element, pack.slope, gather_motion<N>(pack), pack.points[begin_].data(),
                                      gather_update<N>(pack, update), pack.points[1 - begin_].data(), pack.carried);
    }
  });
  carries_strains_ = configuration_.model().stiffness_point_count > 0;
}

void PlanarBeams::accept(State& state) {
  advance_nodes(configuration_, state);
  std::copy(end_memory_.begin(), end_memory_.end(), state.strain_memory.begin());
  for_each_group(groups_, [&](const auto& packs) {
    for (const auto& pack : packs)
      pack.branches.accept(pack.lanes, state,
                           [&](int lane, const Vector3& strain) { return Vector6(pack.basis[lane] * strain); });
  });
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    NodeState& node = state.nodes[i];
    node.mean_spin = (rates_[i].increment / configuration_.step()) * plane_.normal;
    // Velocities out of the plane are round-off, which would add up from step to step.
    node.velocity -= plane_.normal.dot(node.velocity) * plane_.normal;
    node.angular_velocity = material_normals_[i].dot(node.angular_velocity) * material_normals_[i];
  }
  begin_ = 1 - begin_;  // points at the end of this step are points at the beginning of the next one
}

}  // namespace flexarm
