#pragma once
/// Definitions of conserving_pack.h, for the units that compile them.

#include "elements/conserving_beam.h"
#include "elements/conserving_pack.h"
#include "math/simd.h"

namespace flexarm::packs {

template <int Nodes>
void mid_functions(const ConservingElement<Nodes, Pack>& element,
                   const std::array<QuaternionT<Pack>, Nodes>& orientation,
                   const std::array<Vector3T<Pack>, Nodes>& foreseen, ElementFunctions<Nodes, Pack>& functions) {
  simd::run([&] { flexarm::mid_functions<Nodes, Pack>(element, orientation, foreseen, functions); });
}

template <int Nodes>
void stretch_mid_functions(const std::array<Vector3T<Pack>, Nodes>& foreseen,
                           ElementFunctions<Nodes, Pack>& functions) {
  simd::run([&] { flexarm::stretch_mid_functions<Nodes, Pack>(foreseen, functions); });
}

template <int Nodes>
void element_points(const ConservingElement<Nodes, Pack>& element, const std::array<Vector3T<Pack>, Nodes>& position,
                    const std::array<QuaternionT<Pack>, Nodes>& orientation, PointKinematicsT<Pack>* points) {
  simd::run([&] { flexarm::element_points<Nodes, Pack>(element, position, orientation, points); });
}

template <int Nodes>
void conserving_beam(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                     const TimeRule& rule, const ElementFunctions<Nodes, Pack>& functions,
                     const PointKinematicsT<Pack>* begin, const StrainMemoryT<Pack>* memory, double step,
                     bool with_tangent, const CarriedStrains<Nodes, Pack>* carried, PointKinematicsT<Pack>* end,
                     StrainMemoryT<Pack>* end_memory, BlockSystem<Nodes, Pack>& system) {
  simd::run([&] {
    flexarm::conserving_beam<Nodes, Pack>(element, nodes, rule, functions, begin, memory, step, with_tangent, carried,
                                          end, end_memory, system);
  });
}

template <int Nodes>
void carry_strains(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                   const TimeRule& rule, const ElementFunctions<Nodes, Pack>& functions,
                   const PointKinematicsT<Pack>* begin, const std::array<Vector6T<Pack>, Nodes>& update,
                   PointKinematicsT<Pack>* end, CarriedStrains<Nodes, Pack>& carried) {
  simd::run([&] { flexarm::carry_strains<Nodes, Pack>(element, nodes, rule, functions, begin, update, end, carried); });
}

}  // namespace flexarm::packs
