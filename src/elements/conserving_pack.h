#pragma once
/// The kernels of conserving_beam.h and conserving_tangent.h for packs of elements. They are compiled once for each
/// order of elements and use the widest registers of the processor (math/simd.h). `Nodes`: 2 to 5.

#include "elements/beam_point.h"
#include "elements/conserving_element.h"
#include "elements/maxwell.h"
#include "schemes/time_rule.h"

namespace flexarm::packs {

template <int Nodes>
void mid_functions(const ConservingElement<Nodes, Pack>& element,
                   const std::array<QuaternionT<Pack>, Nodes>& orientation,
                   const std::array<Vector3T<Pack>, Nodes>& foreseen, ElementFunctions<Nodes, Pack>& functions);

template <int Nodes>
void stretch_mid_functions(const std::array<Vector3T<Pack>, Nodes>& foreseen, ElementFunctions<Nodes, Pack>& functions);

template <int Nodes>
void element_points(const ConservingElement<Nodes, Pack>& element, const std::array<Vector3T<Pack>, Nodes>& position,
                    const std::array<QuaternionT<Pack>, Nodes>& orientation, PointKinematicsT<Pack>* points);

template <int Nodes>
void conserving_beam(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                     const TimeRule& rule, const ElementFunctions<Nodes, Pack>& functions,
                     const PointKinematicsT<Pack>* begin, const StrainMemoryT<Pack>* memory, double step,
                     bool with_tangent, const CarriedStrains<Nodes, Pack>* carried, PointKinematicsT<Pack>* end,
                     StrainMemoryT<Pack>* end_memory, BlockSystem<Nodes, Pack>& system,
                     const MaxwellBranches<Pack>& branches = {});

template <int Nodes>
void carry_strains(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                   const TimeRule& rule, const ElementFunctions<Nodes, Pack>& functions,
                   const PointKinematicsT<Pack>* begin, const std::array<Vector6T<Pack>, Nodes>& update,
                   PointKinematicsT<Pack>* end, CarriedStrains<Nodes, Pack>& carried);

}  // namespace flexarm::packs
