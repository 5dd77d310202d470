#include "integrators/conserving_beams.h"

#include <algorithm>
#include <cstdlib>

#include "elements/element_configuration.h"
#include "integrators/gathered.h"
#include "math/simd.h"
#include "solver/interior_condensation.h"

namespace flexarm {
namespace {

/// Groups elements of one order into packs.
template <int Nodes>
PackGroup<Nodes> packs_of(const std::vector<BeamElement<Nodes>>& elements, int branches) {
  constexpr int lanes = Pack::kLanes;
  const int count = static_cast<int>(elements.size());
  PackGroup<Nodes> packs((count + lanes - 1) / lanes);
  // The whole group has the same terms, so that the results of an element do not depend on its neighbours in the pack.
  bool is_uniform = true, is_coupled = false, is_damped_evenly = true;
  bool has_stiffness_damping = false, has_mass_damping = false;
  for (std::size_t p = 0; p < packs.size(); ++p) {
    auto& pack = packs[p];
    const int first = static_cast<int>(p) * lanes;
    pack.lanes = std::min(lanes, count - first);
    for (int lane = 0; lane < lanes; ++lane) {
      const auto& element = elements[std::min(first + lane, count - 1)];
      pack.nodes[lane] = element.nodes;
      pack.first_block[lane] = element.first_block;
      pack.first_stiffness_point[lane] = element.first_stiffness_point;
      set_lane(pack.element, lane, element);
      pack.branches.set(lane, element.maxwell, element.first_stiffness_point, branches, Nodes - 1);
    }
    is_uniform = is_uniform && pack.element.is_uniform;
    for (const auto& section : pack.element.sections) is_coupled = is_coupled || section.is_coupled;
    is_damped_evenly = is_damped_evenly && pack.element.is_damped_evenly;
    has_stiffness_damping = has_stiffness_damping || pack.element.has_stiffness_damping;
    has_mass_damping = has_mass_damping || pack.element.has_mass_damping;
  }
  for (auto& pack : packs) {
    pack.element.is_uniform = is_uniform;
    for (auto& section : pack.element.sections) section.is_coupled = is_coupled;
    pack.element.is_damped_evenly = is_damped_evenly;
    pack.element.has_stiffness_damping = has_stiffness_damping;
    pack.element.has_mass_damping = has_mass_damping;
  }
  return packs;
}

/// The system in which a pack is evaluated: that of the condensation if there is one.
template <int Nodes>
BlockSystem<Nodes, Pack>& system_of(std::size_t pack, InteriorCondensation* condensation,
                                    BlockSystem<Nodes, Pack>& scattered) {
  if constexpr (Nodes > 2) {
    if (condensation) return condensation->system<Nodes>(pack);
  }
  return scattered;
}

}  // namespace

ConservingBeams::ConservingBeams(const StepConfiguration& configuration, const StepPrestrains& prestrains)
    : configuration_(configuration),
      prestrains_(prestrains),
      rule_(configuration.scheme()),
      nodes_(configuration.model(), rule_),
      has_memory_(rule_.dissipation.any()) {
  for_each_group(configuration.model().beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group.elements)>::value_type::kNodes;
    auto& packs = std::get<PackGroup<N>>(groups_);
    packs = packs_of(group.elements, configuration.model().maxwell_branches);
    if (!packs.empty() && packs.front().element.has_stiffness_damping) has_memory_ = true;
  });
  if (has_memory_) end_memory_.resize(configuration.model().stiffness_point_count);
}

void ConservingBeams::initialise(State& state) {
  for (NodeState& node : state.nodes) node.mean_spin = node.orientation * node.angular_velocity;
  if (has_memory_) state.strain_memory = initial_strain_memory(configuration_.model(), state);
}

void ConservingBeams::begin() {
  if (!holds_begin_points_) {
    if (!configuration_.model().prestrains.empty()) set_prestrains();
    set_begin_points();
  }
  holds_begin_points_ = true;
  set_mid_functions();
  const StepMotion step = configuration_.motion();
  for_each_group(groups_, [&](auto& packs) {
    for (auto& pack : packs) {
      pack.branches.begin(step.state, step.step, [](int, const Vector6& strain) -> const Vector6& { return strain; });
      for (std::size_t k = 0; k < pack.carried.end.size(); ++k) pack.carried.end[k] = pack.points[begin_][k].strain;
      pack.carried.has_conjugate = false;
    }
  });
  carries_strains_ = configuration_.model().stiffness_point_count > 0;
}

/// Adds the prestrains to the reference strains of the packs.
void ConservingBeams::set_prestrains() {
  for_each_group(configuration_.model().beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group)>::kNodes;
    for (std::size_t e = 0; e < group.elements.size(); ++e) {
      const auto& element = group.elements[e];
      ElementPack<N>& pack = std::get<PackGroup<N>>(groups_)[e / Pack::kLanes];
      for (int k = 0; k < N - 1; ++k) {
        const Vector6 reference = element.stiffness_points[k].reference_strain + prestrains_.of_step(element.prestrain);
        set_lane(pack.element.points[k].reference_strain, static_cast<int>(e % Pack::kLanes), reference);
      }
    }
  });
}

double ConservingBeams::work_of_prestrains() const {
  double work = 0;
  for_each_group(configuration_.model().beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group)>::kNodes;
    for (std::size_t e = 0; e < group.elements.size(); ++e) {
      const ElementPack<N>& pack = std::get<PackGroup<N>>(groups_)[e / Pack::kLanes];
      const auto strain = [&](int end, int k) -> Vector6 {
        return get_lane(pack.points[end][k].strain, static_cast<int>(e % Pack::kLanes));
      };
      for (int k = 0; k < N - 1; ++k)
        work += prestrains_.work(group.elements[e], k, strain(begin_, k), strain(1 - begin_, k));
    }
  });
  return work;
}

void ConservingBeams::accept(State& state) {
  advance_nodes(configuration_, state);
  std::copy(end_memory_.begin(), end_memory_.end(), state.strain_memory.begin());
  const StepMotion step = configuration_.motion();
  for (std::size_t i = 0; i < state.nodes.size(); ++i) state.nodes[i].mean_spin = step.increments[i] / step.step;
  for_each_group(groups_, [&](auto& packs) {
    for (const auto& pack : packs)
      pack.branches.accept(pack.lanes, state, [](int, const Vector6& strain) { return strain; });
  });
  begin_ = 1 - begin_;  // points at the end of this step are points at the beginning of the next one
}

template <int Nodes>
BeamNodes<Nodes, Pack> ConservingBeams::gather(const ElementPack<Nodes>& pack, const StepMotion& step) {
  BeamNodes<Nodes, Pack> nodes;
  for (int i = 0; i < Nodes; ++i) {
    const auto node = [&](int lane) { return pack.nodes[lane][i]; };
    nodes.begin[i] = gathered_vector([&](int lane) -> const Vector3& { return step.begin[node(lane)].position; });
    nodes.end[i] = gathered_vector([&](int lane) -> const Vector3& { return step.end[node(lane)].position; });
    nodes.orientation[i] =
        gathered_quaternion([&](int lane) -> const Quaternion& { return step.end[node(lane)].orientation; });
    nodes.increment[i] = gathered_vector([&](int lane) -> const Vector3& { return step.increments[node(lane)]; });
    nodes.velocity[i] =
        gathered_vector([&](int lane) -> const Vector3& { return step.state.nodes[node(lane)].velocity; });
  }
  return nodes;
}

template <int Nodes>
void ConservingBeams::gather(const ElementPack<Nodes>& pack, const std::vector<StrainMemory>& memory,
                             std::array<StrainMemoryT<Pack>, Nodes - 1>& points) {
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto from = [&](int lane) -> const StrainMemory& { return memory[pack.first_stiffness_point[lane] + k]; };
    points[k].average = gathered_vector<6>([&](int lane) -> const Vector6& { return from(lane).average; });
    points[k].rate = gathered_vector<6>([&](int lane) -> const Vector6& { return from(lane).rate; });
    points[k].delayed_rate = gathered_vector<6>([&](int lane) -> const Vector6& { return from(lane).delayed_rate; });
  }
}

template <int Nodes>
void ConservingBeams::scatter(const ElementPack<Nodes>& pack, const std::array<StrainMemoryT<Pack>, Nodes - 1>& points,
                              std::vector<StrainMemory>& memory) {
  for (int k = 0; k < Nodes - 1; ++k)
    for (int lane = 0; lane < pack.lanes; ++lane)
      memory[pack.first_stiffness_point[lane] + k] = {get_lane(points[k].average, lane), get_lane(points[k].rate, lane),
                                                      get_lane(points[k].delayed_rate, lane)};
}

template <int Nodes>
void ConservingBeams::scatter(const ElementPack<Nodes>& pack, const BlockSystem<Nodes, Pack>& system, Balance& balance,
                              bool with_tangent) {
  std::array<double*, Pack::kLanes> targets;
  for (int i = 0; i < Nodes; ++i) {
    for (int lane = 0; lane < pack.lanes; ++lane) targets[lane] = balance.residual.at(pack.nodes[lane][i]);
    add_lanes<6>(system.residual[i].data(), pack.lanes, targets.data());
    if (balance.carried) {
      for (int lane = 0; lane < pack.lanes; ++lane) targets[lane] = balance.carried->at(pack.nodes[lane][i]);
      add_lanes<6>(system.carried[i].data(), pack.lanes, targets.data());
    }
    for (int j = 0; j < Nodes && with_tangent; ++j) {
      for (int lane = 0; lane < pack.lanes; ++lane)
        targets[lane] = balance.tangent->element_block(pack.first_block[lane] + i * Nodes + j);
      if (balance.tangent->keeps_elements_apart())
        add_lanes<36, true>(system.tangent[i][j].data(), pack.lanes, targets.data());
      else
        add_lanes<36>(system.tangent[i][j].data(), pack.lanes, targets.data());
    }
  }
}

void ConservingBeams::set_begin_points() {
  const std::vector<NodePose>& begin = configuration_.begin();
  for_each_group(groups_, [&](auto& packs) {
    constexpr int N = std::decay_t<decltype(packs)>::value_type::kNodes;
    simd::run([&] {
      for (auto& pack : packs) {
        std::array<Vector3T<Pack>, N> position;
        std::array<QuaternionT<Pack>, N> orientation;
        for (int i = 0; i < N; ++i) {
          const auto pose = [&](int lane) -> const NodePose& { return begin[pack.nodes[lane][i]]; };
          position[i] = gathered_vector([&](int lane) -> const Vector3& { return pose(lane).position; });
          orientation[i] = gathered_quaternion([&](int lane) -> const Quaternion& { return pose(lane).orientation; });
        }
        packs::element_points<N>(pack.element, position, orientation, pack.points[begin_].data());
      }
    });
  });
}

/// Sets the test functions for the middle of the step, which is predicted from the motion of the last step.
void ConservingBeams::set_mid_functions() {
  const StepMotion step = configuration_.motion();
  // MidFunctions::Explicit uses predicted functions, which do not depend on the unknowns, so that the tangent stays
  // simple. MidFunctions::Symmetric averages the functions of both ends; here, these are the functions at the
  // beginning.
  const Pack foreseen_time(rule_.mid_functions == MidFunctions::Explicit ? step.step : 0.0);
  const bool is_stretched = rule_.correction == EnergyCorrection::Multiplier;
  for_each_group(groups_, [&](auto& packs) {
    constexpr int N = std::decay_t<decltype(packs)>::value_type::kNodes;
    simd::run([&] {
      for (auto& pack : packs) {
        std::array<QuaternionT<Pack>, N> orientation;
        std::array<Vector3T<Pack>, N> foreseen;
        for (int i = 0; i < N; ++i) {
          const auto node = [&](int lane) { return pack.nodes[lane][i]; };
          foreseen[i] = foreseen_time * gathered_vector([&](int lane) -> const Vector3& {
                          return step.state.nodes[node(lane)].mean_spin;
                        });
          orientation[i] =
              gathered_quaternion([&](int lane) -> const Quaternion& { return step.begin[node(lane)].orientation; });
        }
        packs::mid_functions<N>(pack.element, orientation, foreseen, pack.mid_functions);
        if (is_stretched) packs::stretch_mid_functions<N>(foreseen, pack.mid_functions);
      }
    });
  });
}

void ConservingBeams::carry_strains(const double* update) {
  const StepMotion step = configuration_.motion();
  for_each_group(groups_, [&](auto& packs) {
    constexpr int N = std::decay_t<decltype(packs)>::value_type::kNodes;
    simd::run([&] {
      for (auto& pack : packs) {
        std::array<Vector6T<Pack>, N> moved;
        for (int i = 0; i < N; ++i)
          moved[i] =
              gathered_vector<6>([&](int lane) { return Eigen::Map<const Vector6>(update + 6 * pack.nodes[lane][i]); });
        packs::carry_strains<N>(pack.element, gather<N>(pack, step), rule_, pack.mid_functions,
                                pack.points[begin_].data(), moved, pack.points[1 - begin_].data(), pack.carried);
      }
    });
  });
  carries_strains_ = configuration_.model().stiffness_point_count > 0;
}

void ConservingBeams::add_forces(Balance& balance) {
  const StepMotion step = configuration_.motion();
  double dissipated = 0;
  for_each_group(groups_, [&](auto& packs) {
    if (packs.empty()) return;  // saves the construction of the arrays below
    constexpr int N = std::decay_t<decltype(packs)>::value_type::kNodes;
    InteriorCondensation* condensation = N > 2 && balance.tangent ? balance.tangent->condensation() : nullptr;
    simd::run([&] {
      std::array<StrainMemoryT<Pack>, N - 1> memory, new_memory;
      BlockSystem<N, Pack> scattered;
      for (std::size_t p = 0; p < packs.size(); ++p) {
        ElementPack<N>& pack = packs[p];
        BlockSystem<N, Pack>& system = system_of(p, condensation, scattered);
        if (has_memory_) gather<N>(pack, step.state.strain_memory, memory);
        packs::conserving_beam<N>(pack.element, gather<N>(pack, step), rule_, pack.mid_functions,
                                  pack.points[begin_].data(), has_memory_ ? memory.data() : nullptr, step.step,
                                  balance.tangent != nullptr, balance.carried ? &pack.carried : nullptr,
                                  pack.points[1 - begin_].data(), has_memory_ ? new_memory.data() : nullptr, system,
                                  pack.branches.of_step());
        if (has_memory_) scatter<N>(pack, new_memory, end_memory_);
        scatter<N>(pack, system, balance, balance.tangent && !condensation);
        for (int lane = 0; lane < pack.lanes; ++lane) dissipated += system.dissipated[lane];
      }
    });
  });
  balance.dissipated += dissipated;
  if (balance.tangent) carries_strains_ = false;
}

std::vector<StrainMemory> initial_strain_memory(const Model& model, const State& state) {
  std::vector<StrainMemory> memories(model.stiffness_point_count);
  for_each_element(model.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const ElementConfiguration<N> nodes(element, state);
    const LocalRotationVariation<N> local{LocalRotations<N>(nodes.orientation)};
    for (int k = 0; k < N - 1; ++k) {
      const auto& constants = element.stiffness_points[k];
      GeneralisedShapeFunctions<N> functions;
      const PointKinematics point =
          point_kinematics(local.evaluate(constants.shape, constants.derivative, functions),
                           interpolate<N>(constants.derivative, nodes.position), constants.reference_strain);
      Eigen::Matrix<double, 9, 1> rate = Eigen::Matrix<double, 9, 1>::Zero();  // of {r', spin, spin'}
      rate.head<3>() = interpolate<N>(constants.derivative, nodes.velocity);
      for (int i = 0; i < N; ++i) {
        rate.segment<3>(3) += functions.values[i] * nodes.spin[i];
        rate.tail<3>() += functions.derivatives[i] * nodes.spin[i];
      }
      StrainMemory& memory = memories[element.first_stiffness_point + k];
      memory.rate = memory.delayed_rate = strain_derivative(point) * rate;
    }
  });
  return memories;
}

}  // namespace flexarm
