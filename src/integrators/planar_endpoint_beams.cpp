#include "integrators/planar_endpoint_beams.h"

#include <cmath>

#include "elements/nodal_inertia.h"
#include "elements/planar_pack.h"
#include "math/simd.h"

namespace flexarm {

PlanarEndpointBeams::PlanarEndpointBeams(const StepConfiguration& configuration, const PlaneOfMotion& plane)
    : PlanarFamily(configuration, plane),
      reference_(configuration.model(), configuration.scheme()),
      motions_(begin_poses_.size()),
      rates_(begin_poses_.size()),
      damping_(begin_poses_.size()),
      interpolated_(begin_poses_.size()),
      internal_(begin_poses_.size()) {
  if (rule_.hht != HhtForm::None) balance_.internal_slope = 1 + rule_.alpha;
  balance_.interpolates_damping = !interpolates_kinematics();
  for_each_group(configuration.model().beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group)>::kNodes;
    auto& packs = std::get<Group<N>>(groups_);
    set_packs(group.elements, packs);
    const int last = static_cast<int>(group.elements.size()) - 1;
    for (std::size_t p = 0; p < packs.size(); ++p)
      for (int lane = 0; lane < Pack::kLanes; ++lane) {
        const BeamElement<N>& element = group.elements[std::min(static_cast<int>(p) * Pack::kLanes + lane, last)];
        packs[p].first_mass_point[lane] = element.first_mass_point;
        planar::set_lane(packs[p].rotary, lane, element, material_normals_[element.nodes[0]]);
      }
    if (!packs.empty() && packs.front().element.has_mass_damping) has_mass_damping_ = true;
  });
}

// ---------------------------------------------------------------- the beginning

void PlanarEndpointBeams::begin() {
  balance_.rule = newmark_rule(rule_, configuration_.step());
  reference_.begin(configuration_.state());
  set_begin_poses();
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const NodeState& node = configuration_.state().nodes[i];
    const Vector3& normal = material_normals_[i];
    NodeMotion& motion = motions_[i];
    motion.velocity << plane_.in_plane(node.velocity), normal.dot(node.angular_velocity);
    motion.acceleration << plane_.in_plane(node.acceleration), normal.dot(node.angular_acceleration);
    motion.rest = balance_.rule.acceleration(Vector3::Zero(), motion.velocity, motion.acceleration);
  }
  for_each_group(groups_, [&](auto& packs) {
    for (auto& pack : packs) {
      if (!holds_begin_points_) set_begin_points(pack);
      remember(pack);
      for (std::size_t k = 0; k < pack.carried.size(); ++k) pack.carried[k] = pack.begin.points[k].strain;
    }
  });
  holds_begin_points_ = true;
  carries_strains_ = !interpolates_kinematics() && configuration_.model().stiffness_point_count > 0;
}

template <int Nodes>
void PlanarEndpointBeams::set_begin_points(EndpointPack<Nodes>& pack) const {
  const Places<Nodes> places = gather<Nodes>(pack, begin_poses_);
  planar::packs::element_points<Nodes>(pack.element, places.position, places.cosine, places.sine,
                                       pack.begin.points.data());
}

template <int Nodes>
void PlanarEndpointBeams::remember(EndpointPack<Nodes>& pack) const {
  const State& state = configuration_.state();
  for (int lane = 0; lane < Pack::kLanes; ++lane) {
    const Vector3& normal = material_normals_[pack.nodes[lane][0]];
    for (int k = 0; k < Nodes; ++k) {
      const MassPointState& point = state.mass_points[pack.first_mass_point[lane] + k];
      pack.begin.rotary[k].set(lane, balance_.rule.acceleration<double>(0, normal.dot(point.angular_velocity),
                                                                        normal.dot(point.angular_acceleration)));
    }
    for (int k = 0; k < Nodes - 1 && pack.element.has_stiffness_damping; ++k)
      set_lane(pack.begin.strain_rates[k], lane,
               Vector3(pack.basis[lane].transpose() * state.strain_rates[pack.first_stiffness_point[lane] + k]));
  }
}

// ---------------------------------------------------------------- forces

void PlanarEndpointBeams::set_end() {
  const NewmarkRule& rule = balance_.rule;
  const double slope = rule.acceleration_slope();
  for (std::size_t i = 0; i < end_poses_.size(); ++i) {
    const PlanarPose at = end_poses_[i] = pose(i, configuration_.end()[i]), from = begin_poses_[i];
    const double turn = 2 * std::atan((at.sine * from.cosine - at.cosine * from.sine) /
                                      (at.cosine * from.cosine + at.sine * from.sine));
    const Vector3 moved(at.x - from.x, at.y - from.y, turn);
    const Vector3 acceleration = motions_[i].rest + slope * moved;
    rates_[i] = {acceleration[0], acceleration[1], turn, acceleration[2]};
    if (interpolation_) interpolated_[i] = pose(i, interpolation_->configuration()[i]);
    if (!has_mass_damping_) continue;
    const Vector3 velocity = rule.velocity(motions_[i].velocity, motions_[i].acceleration, acceleration),
                  damped = (1 + rule.alpha) * velocity - rule.alpha * motions_[i].velocity;
    damping_[i] = {moved[0], moved[1], damped[0], damped[1]};
  }
}

template <int Nodes>
planar::EndpointNodal<Nodes, Pack> PlanarEndpointBeams::gather_motion(const EndpointPack<Nodes>& pack) const {
  const Places<Nodes> places = gather<Nodes>(pack, interpolation_ ? interpolated_ : end_poses_);
  planar::EndpointNodal<Nodes, Pack> nodes;
  nodes.position = places.position;
  nodes.cosine = places.cosine;
  nodes.sine = places.sine;
  for (int i = 0; i < Nodes; ++i) {
    const auto rate = gathered_four([&](int lane) { return &rates_[pack.nodes[lane][i]].ax; });
    nodes.acceleration[i] = {rate[0], rate[1]};
    nodes.turn[i] = rate[2];
    if (!pack.element.has_mass_damping) continue;
    const auto damping = gathered_four([&](int lane) { return &damping_[pack.nodes[lane][i]].dx; });
    nodes.displacement[i] = {damping[0], damping[1]};
    nodes.damped_velocity[i] = {damping[2], damping[3]};
  }
  return nodes;
}

void PlanarEndpointBeams::add_forces(Balance& balance) {
  set_end();
  std::fill(forces_.begin(), forces_.end(), NodeForce());
  if (interpolation_) std::fill(internal_.begin(), internal_.end(), NodeForce());
  if (balance.carried) std::fill(carried_.begin(), carried_.end(), NodeForce());
  for_each_group(groups_, [&](auto& packs) {
    if (packs.empty()) return;
    constexpr int N = std::decay_t<decltype(packs)>::value_type::kNodes;
    simd::run([&] {
      planar::BlockSystem<N, Pack> system;
      std::array<Eigen::Matrix<Pack, 4, 1>, N> inertia;
      for (auto& pack : packs) {
        planar::packs::endpoint_beam<N>(pack.element, pack.rotary, gather_motion<N>(pack), balance_, pack.begin,
                                        balance.tangent != nullptr, balance.carried ? &pack.carried : nullptr, pack.end,
                                        system, inertia);
        scatter<N>(pack, system, interpolation_ ? internal_ : forces_, balance);
        scatter<N>(pack, inertia, forces_);
      }
    });
  });
  for (std::size_t i = 0; i < internal_.size() && interpolation_; ++i)
    interpolation_->take(static_cast<int>(i), in_space(internal_[i]));
  if (balance.tangent) carries_strains_ = false;
}

void PlanarEndpointBeams::add_inertia(Balance& balance) {
  const double slope = balance_.rule.acceleration_slope();
  for (const Inertia& inertia : inertias_) {
    const NodeRate& rate = rates_[inertia.node];
    double* force = forces_[inertia.node].at;
    force[0] += inertia.mass * rate.ax;
    force[1] += inertia.mass * rate.ay;
    force[2] += inertia.rotary * rate.turning;
    if (!balance.tangent) continue;
    double* tangent = balance.tangent->diagonal_block(inertia.node);
    tangent[0] += inertia.mass * slope;
    tangent[5] += inertia.mass * slope;
    tangent[10] += inertia.rotary * slope;
  }
  hand_over(balance);
}

void PlanarEndpointBeams::carry_strains(const double* update) {
  if (interpolates_kinematics()) return;
  for_each_group(groups_, [&](auto& packs) {
    constexpr int N = std::decay_t<decltype(packs)>::value_type::kNodes;
    for (auto& pack : packs)
      planar::packs::carry_endpoint_strains<N>(pack.element, pack.end.points, gather_update<N>(pack, update),
                                               pack.carried);
  });
  carries_strains_ = configuration_.model().stiffness_point_count > 0;
}

// ---------------------------------------------------------------- the end

void PlanarEndpointBeams::accept(State& state) {
  reference_.set_trial(configuration_.end());
  reference_.accept(state);
  accept_nodes(state);
  for_each_group(groups_, [&](auto& packs) {
    for (auto& pack : packs) {
      accept_points(pack, state);
      pack.begin.points = pack.end.points;
    }
  });
  if (interpolates_kinematics()) invalidate();  // those at hand belong to t_{n+1+alpha}
}

void PlanarEndpointBeams::accept_nodes(State& state) const {
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    NodeState& node = state.nodes[i];
    const NodeMotion& motion = motions_[i];
    const NodeRate& rate = rates_[i];
    const Vector3 acceleration(rate.ax, rate.ay, rate.turning),
        velocity = balance_.rule.velocity(motion.velocity, motion.acceleration, acceleration);
    const Vector3& normal = material_normals_[i];
    node.velocity = velocity[0] * plane_.first + velocity[1] * plane_.second;
    node.angular_velocity = velocity[2] * normal;
    node.acceleration = acceleration[0] * plane_.first + acceleration[1] * plane_.second;
    node.angular_acceleration = acceleration[2] * normal;
  }
  if (!interpolation_) return;
  const auto of_nodes = state.momentum_rates.begin() + configuration_.model().mass_point_count;
  for (const Inertia& inertia : inertias_)
    of_nodes[inertia.node] = inertia.rotary * rates_[inertia.node].turning * plane_.normal;
}

template <int Nodes>
void PlanarEndpointBeams::accept_points(const EndpointPack<Nodes>& pack, State& state) const {
  const NewmarkRule& rule = balance_.rule;
  for (int lane = 0; lane < pack.lanes; ++lane) {
    const Vector3& normal = material_normals_[pack.nodes[lane][0]];
    for (int k = 0; k < Nodes; ++k) {
      MassPointState& point = state.mass_points[pack.first_mass_point[lane] + k];
      const double acceleration = pack.end.rotary[k][lane];
      point.angular_velocity = rule.velocity<double>(normal.dot(point.angular_velocity),
                                                     normal.dot(point.angular_acceleration), acceleration) *
                               normal;
      point.angular_acceleration = acceleration * normal;
      if (interpolation_)
        state.momentum_rates[pack.first_mass_point[lane] + k] =
            pack.rotary.inertia[k][lane] * acceleration * plane_.normal;
    }
    for (int k = 0; k < Nodes - 1 && pack.element.has_stiffness_damping; ++k)
      state.strain_rates[pack.first_stiffness_point[lane] + k] =
          pack.basis[lane] * get_lane(pack.end.strain_rates[k], lane);
  }
}

}  // namespace flexarm
