#pragma once
/// The kernels of planar_beam.h for packs of elements. They are compiled once for each order of elements and use the
/// widest registers of the processor (math/simd.h). `Nodes`: 2 to 5.

#include "elements/maxwell.h"
#include "elements/planar_element.h"
#include "schemes/time_rule.h"

namespace flexarm::planar::packs {

template <int Nodes>
void element_points(const Element<Nodes, Pack>& element, const std::array<Vector2T<Pack>, Nodes>& position,
                    const std::array<Pack, Nodes>& cosine, const std::array<Pack, Nodes>& sine,
                    PointKinematics<Pack>* points);

template <int Nodes>
void beam(const Element<Nodes, Pack>& element, const Pack& slope, const Nodal<Nodes, Pack>& nodes, const TimeRule& rule,
          const PointKinematics<Pack>* begin, const StrainMemory<Pack>* memory, double step, bool with_tangent,
          const CarriedStrains<Nodes, Pack>* carried, PointKinematics<Pack>* end, StrainMemory<Pack>* end_memory,
          BlockSystem<Nodes, Pack>& system, const MaxwellBranches<Pack, 3>& branches = {});

template <int Nodes>
void carry_strains(const Element<Nodes, Pack>& element, const Pack& slope, const Nodal<Nodes, Pack>& nodes,
                   const PointKinematics<Pack>* begin, const std::array<Vector3T<Pack>, Nodes>& update,
                   PointKinematics<Pack>* end, CarriedStrains<Nodes, Pack>& carried);

}  // namespace flexarm::planar::packs
