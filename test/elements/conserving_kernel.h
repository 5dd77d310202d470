#pragma once
/// Wrapper of the energy-momentum kernel for tests: sets elements into lanes of a pack, and reads systems from them.

#include "elements/conserving_beam.h"
#include "elements/conserving_pack.h"
#include "elements/random_element.h"
#include "elements/tested_step.h"
#include "math/lanes.h"
#include "schemes/scheme.h"

namespace flexarm::test {

/// The rule of a scheme with these options over kStep. Damping has the relaxation time kStep/2. Numerical dissipation
/// has the spectral radius 0.5; order 0 is without.
inline TimeRule time_rule(bool is_corrected, MidFunctions mid, int dissipation_order) {
  TimeRule rule;
  rule.mid_functions = mid;
  rule.correction = is_corrected ? EnergyCorrection::Multiplier : EnergyCorrection::None;
  rule.damping_relaxation = 0.5 * kStep;
  if (dissipation_order > 0) rule.dissipation = numerical_dissipation(dissipation_order, 0.5, kStep);
  return rule;
}

/// Input of the kernel for one element.
template <int Nodes>
struct LaneInput {
  const BeamElement<Nodes>& element;
  const ElementNodes<Nodes>& nodes;
  const ElementFunctions<Nodes>& functions;
  const PointKinematics* begin;
  const StrainMemory* memory;  // may be null
};

/// Input and output of the kernel for the elements of a pack.
template <int Nodes>
struct KernelData {
  ConservingElement<Nodes, Pack> element;
  BeamNodes<Nodes, Pack> nodes;
  ElementFunctions<Nodes, Pack> functions;
  std::array<PointKinematicsT<Pack>, Nodes - 1> begin, end;
  std::array<StrainMemoryT<Pack>, Nodes - 1> memory, end_memory;
  BlockSystem<Nodes, Pack> system;
  CarriedStrains<Nodes, Pack> carried;
  bool is_carried = false;

  KernelData() = default;
  /// Puts one element into all lanes, because the kernel is compiled only for packs.
  explicit KernelData(const LaneInput<Nodes>& input) {
    for (int lane = 0; lane < Pack::kLanes; ++lane) set(lane, input);
  }
  void set(int lane, const LaneInput<Nodes>& input) {
    set_lane(element, lane, input.element);
    for (int i = 0; i < Nodes; ++i) {
      set_lane(nodes.begin[i], lane, input.nodes.begin[i]);
      set_lane(nodes.end[i], lane, input.nodes.end[i]);
      set_lane(nodes.orientation[i].coeffs(), lane, input.nodes.orientation[i].coeffs());
      set_lane(nodes.increment[i], lane, input.nodes.increment[i]);
      set_lane(nodes.velocity[i], lane, input.nodes.velocity[i]);
    }
    for (int k = 0; k < Nodes - 1; ++k) {
      for (int i = 0; i < Nodes; ++i) {
        set_lane(functions[k].values[i], lane, input.functions[k].values[i]);
        set_lane(functions[k].derivatives[i], lane, input.functions[k].derivatives[i]);
      }
      set_lane(begin[k].rotation, lane, input.begin[k].rotation);
      set_lane(begin[k].tangent, lane, input.begin[k].tangent);
      set_lane(begin[k].strain, lane, input.begin[k].strain);
      const StrainMemory none;
      const StrainMemory& from = input.memory ? input.memory[k] : none;
      set_lane(memory[k].average, lane, from.average);
      set_lane(memory[k].rate, lane, from.rate);
      set_lane(memory[k].delayed_rate, lane, from.delayed_rate);
    }
  }
  /// Sets the carried strains of all lanes.
  void carry(const CarriedStrains<Nodes>& strains) {
    is_carried = true;
    carried.has_conjugate = strains.has_conjugate;
    for (int k = 0; k < Nodes - 1; ++k)
      for (int lane = 0; lane < Pack::kLanes; ++lane) {
        set_lane(carried.end[k], lane, strains.end[k]);
        set_lane(carried.conjugate[k], lane, strains.conjugate[k]);
      }
  }
  void evaluate(const TimeRule& rule, double step, bool with_tangent) {
    packs::conserving_beam<Nodes>(element, nodes, rule, functions, begin.data(), memory.data(), step, with_tangent,
                                  is_carried ? &carried : nullptr, end.data(), end_memory.data(), system);
  }
  void get(int lane, bool with_tangent, ElementSystem<Nodes>& out) const {
    out.set_zero();
    out.dissipated = get_lane(system.dissipated, lane);
    for (int i = 0; i < Nodes; ++i) {
      out.residual.template segment<6>(6 * i) = get_lane(system.residual[i], lane);
      if (is_carried) out.carried.template segment<6>(6 * i) = get_lane(system.carried[i], lane);
      for (int j = 0; j < Nodes && with_tangent; ++j)
        out.tangent.template block<6, 6>(6 * i, 6 * j) = get_lane(system.tangent[i][j], lane);
    }
  }
  void get_end(int lane, PointKinematics* points, StrainMemory* memories) const {
    for (int k = 0; k < Nodes - 1; ++k) {
      points[k] = {get_lane(end[k].rotation, lane), get_lane(end[k].tangent, lane), get_lane(end[k].strain, lane)};
      if (memories)
        memories[k] = {get_lane(end_memory[k].average, lane), get_lane(end_memory[k].rate, lane),
                       get_lane(end_memory[k].delayed_rate, lane)};
    }
  }
};

/// Evaluates one element by the kernel, with or without the energy multiplier.
template <int Nodes>
void conserving_beam(bool has_multiplier, const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes,
                     TimeRule rule, const ElementFunctions<Nodes>& functions, const PointKinematics* begin,
                     const StrainMemory* memory, double step, bool with_tangent, PointKinematics* end,
                     StrainMemory* end_memory, ElementSystem<Nodes>& system) {
  rule.correction = has_multiplier ? EnergyCorrection::Multiplier : EnergyCorrection::None;
  KernelData<Nodes> data({element, nodes, functions, begin, memory});
  data.evaluate(rule, step, with_tangent);
  data.get(0, with_tangent, system);
  data.get_end(0, end, end_memory);
}

/// Generalised shape functions of an element with its stretch, half-way from `orientation` to the end by tangent-scaled
/// increments.
template <int Nodes>
ElementFunctions<Nodes> functions_half_way(const BeamElement<Nodes>& element,
                                           const std::array<Quaternion, Nodes>& orientation,
                                           const std::array<Vector3, Nodes>& increments) {
  ConservingElement<Nodes> constants;
  set_lane(constants, 0, element);
  ElementFunctions<Nodes> functions;
  mid_functions<Nodes, double>(constants, orientation, increments, functions);
  stretch_mid_functions<Nodes, double>(increments, functions);
  return functions;
}

/// The same functions at `orientation`.
template <int Nodes>
ElementFunctions<Nodes> functions_at(const BeamElement<Nodes>& element,
                                     const std::array<Quaternion, Nodes>& orientation) {
  std::array<Vector3, Nodes> still;
  still.fill(Vector3::Zero());
  return functions_half_way<Nodes>(element, orientation, still);
}

}  // namespace flexarm::test
