#include "integrators/planar_beams.h"

#include <algorithm>

#include "math/simd.h"

namespace flexarm {

PlanarBeams::PlanarBeams(const StepConfiguration& configuration, const PlaneOfMotion& plane)
    : PlanarFamily(configuration, plane), rates_(begin_poses_.size()), has_memory_(rule_.dissipation.any()) {
  const Model& model = configuration.model();
  for_each_group(model.beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group)>::kNodes;
    auto& packs = std::get<Group<N>>(groups_);
    set_packs(group.elements, packs);
    if (!packs.empty() && packs.front().element.has_stiffness_damping) has_memory_ = true;
  });
  if (has_memory_) end_memory_.resize(model.stiffness_point_count);
}

void PlanarBeams::begin() {
  const StepMotion step = configuration_.motion();
  set_begin_poses();
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
      const Places<N> places = PlanarFamily::gather<N>(pack, begin_poses_);
      planar::packs::element_points<N>(pack.element, places.position, places.cosine, places.sine,
                                       pack.points[begin_].data());
    }
  });
}

/// The middle functions are Lagrange's; their stretch, squared, makes their derivatives shorter. See
/// stretch_mid_functions().
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

/// Poses at the end, and the increments.
void PlanarBeams::set_end() {
  const std::vector<NodePose>& end = configuration_.end();
  for (std::size_t i = 0; i < end.size(); ++i) {
    const PlanarPose at = end_poses_[i] = pose(i, end[i]), from = begin_poses_[i];
    rates_[i].increment =
        2 * (at.sine * from.cosine - at.cosine * from.sine) / (at.cosine * from.cosine + at.sine * from.sine);
  }
}

template <int Nodes>
planar::Nodal<Nodes, Pack> PlanarBeams::gather_motion(const ConservingPack<Nodes>& pack) const {
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
void PlanarBeams::gather(const ConservingPack<Nodes>& pack,
                         std::array<planar::StrainMemory<Pack>, Nodes - 1>& memory) const {
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
void PlanarBeams::scatter(const ConservingPack<Nodes>& pack,
                          const std::array<planar::StrainMemory<Pack>, Nodes - 1>& memory) {
  for (int k = 0; k < Nodes - 1; ++k)
    for (int lane = 0; lane < pack.lanes; ++lane) {
      const auto from_plane = [&](const auto& strain) { return Vector6(pack.basis[lane] * get_lane(strain, lane)); };
      end_memory_[pack.first_stiffness_point[lane] + k] = {from_plane(memory[k].average), from_plane(memory[k].rate),
                                                           from_plane(memory[k].delayed_rate)};
    }
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
      std::array<planar::StrainMemory<Pack>, N - 1> memory, new_memory;
      planar::BlockSystem<N, Pack> system;
      for (auto& pack : packs) {
        if (has_memory_) gather<N>(pack, memory);
        planar::packs::beam<N>(pack.element, pack.slope, gather_motion<N>(pack), rule_, pack.points[begin_].data(),
                               has_memory_ ? memory.data() : nullptr, step, balance.tangent != nullptr,
                               balance.carried ? &pack.carried : nullptr, pack.points[1 - begin_].data(),
                               has_memory_ ? new_memory.data() : nullptr, system);
        if (has_memory_) scatter<N>(pack, new_memory);
        PlanarFamily::scatter<N>(pack, system, forces_, balance);
      }
    });
  });
  if (balance.tangent) carries_strains_ = false;
}

/// See ConservingNode.
void PlanarBeams::add_inertia(Balance& balance) {
  const double rate_of_step = 1 / configuration_.step(), factor = rule_.velocity_factor() * rate_of_step;
  for (const Inertia& inertia : inertias_) {
    const PlanarPose &begin = begin_poses_[inertia.node], &end = end_poses_[inertia.node];
    const NodeRate& rate = rates_[inertia.node];
    double* force = forces_[inertia.node].at;
    const double mass = inertia.mass * factor, rotary = inertia.rotary * 2 * rate_of_step;
    force[0] += mass * (rate_of_step * (end.x - begin.x) - rate.vx);
    force[1] += mass * (rate_of_step * (end.y - begin.y) - rate.vy);
    force[2] += rotary * (rate_of_step * rate.increment - rate.turning);
    if (!balance.tangent) continue;
    double* tangent = balance.tangent->diagonal_block(inertia.node);
    tangent[0] += mass * rate_of_step;
    tangent[5] += mass * rate_of_step;
    tangent[10] += rotary * rate_of_step * (1 + 0.25 * rate.increment * rate.increment);
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
  std::copy(end_memory_.begin(), end_memory_.end(), state.strain_memory.begin());
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    NodeState& node = state.nodes[i];
    node.mean_spin = (rates_[i].increment / configuration_.step()) * plane_.normal;
    // Of these round-off would add up from step to step.
    node.velocity -= plane_.normal.dot(node.velocity) * plane_.normal;
    node.angular_velocity = material_normals_[i].dot(node.angular_velocity) * material_normals_[i];
  }
  begin_ = 1 - begin_;  // the points of the end are those at the beginning of the next step
}

}  // namespace flexarm
