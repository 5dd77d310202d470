#include "elements/orders.h"
#include "elements/planar_pack.h"
#include "math/simd.h"

namespace flexarm::planar::packs {

template <int Nodes>
void endpoint_beam(const Element<Nodes, Pack>& element, const RotaryElement<Nodes, Pack>& rotary,
                   const EndpointNodal<Nodes, Pack>& nodes, const EndpointBalance& balance,
                   const EndpointMemory<Nodes, Pack>& begin, bool with_tangent,
                   const std::array<Vector3T<Pack>, Nodes - 1>* carried, EndpointResult<Nodes, Pack>& end,
                   BlockSystem<Nodes, Pack>& system, std::array<Eigen::Matrix<Pack, 4, 1>, Nodes>& inertia) {
  simd::run([&] {
    planar::endpoint_beam<Nodes, Pack>(element, rotary, nodes, balance, begin, with_tangent, carried, end, system,
                                       inertia);
  });
}

template <int Nodes>
void carry_endpoint_strains(const Element<Nodes, Pack>& element,
                            const std::array<PointKinematics<Pack>, Nodes - 1>& points,
                            const std::array<Vector3T<Pack>, Nodes>& update,
                            std::array<Vector3T<Pack>, Nodes - 1>& carried) {
  simd::run([&] { planar::carry_endpoint_strains<Nodes, Pack>(element, points, update, carried); });
}

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes)                                      \
  template decltype(endpoint_beam<Nodes>) endpoint_beam<Nodes>; \
  template decltype(carry_endpoint_strains<Nodes>) carry_endpoint_strains<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm::planar::packs
