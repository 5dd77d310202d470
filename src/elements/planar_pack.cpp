#include "elements/planar_pack.h"

#include "elements/orders.h"
#include "elements/planar_beam.h"
#include "math/simd.h"

namespace flexarm::planar::packs {

template <int Nodes>
void element_points(const Element<Nodes, Pack>& element, const std::array<Vector2T<Pack>, Nodes>& position,
                    const std::array<Pack, Nodes>& cosine, const std::array<Pack, Nodes>& sine,
                    PointKinematics<Pack>* points) {
  simd::run([&] { set_points<Nodes, Pack>(element, position, cosine, sine, points); });
}

template <int Nodes>
void beam(const Element<Nodes, Pack>& element, const Pack& slope, const Nodal<Nodes, Pack>& nodes, const TimeRule& rule,
          const PointKinematics<Pack>* begin, const StrainMemory<Pack>* memory, double step, bool with_tangent,
          const CarriedStrains<Nodes, Pack>* carried, PointKinematics<Pack>* end, StrainMemory<Pack>* end_memory,
          BlockSystem<Nodes, Pack>& system, const MaxwellBranches<Pack, 3>& branches) {
  simd::run([&] {
    planar::beam<Nodes, Pack>(element, slope, nodes, rule, begin, memory, step, with_tangent, carried, end, end_memory,
                              system, branches);
  });
}

template <int Nodes>
void carry_strains(const Element<Nodes, Pack>& element, const Pack& slope, const Nodal<Nodes, Pack>& nodes,
                   const PointKinematics<Pack>* begin, const std::array<Vector3T<Pack>, Nodes>& update,
                   PointKinematics<Pack>* end, CarriedStrains<Nodes, Pack>& carried) {
  simd::run([&] { planar::carry_strains<Nodes, Pack>(element, slope, nodes, begin, update, end, carried); });
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes)                                        \
  template decltype(element_points<Nodes>) element_points<Nodes>; \
  template decltype(beam<Nodes>) beam<Nodes>;                     \
  template decltype(carry_strains<Nodes>) carry_strains<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm::planar::packs
