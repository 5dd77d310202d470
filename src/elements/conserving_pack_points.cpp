#include "elements/conserving_pack.h"
#include "elements/conserving_points.h"
#include "elements/orders.h"
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

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes)                                                      \
  template decltype(mid_functions<Nodes>) mid_functions<Nodes>;                 \
  template decltype(stretch_mid_functions<Nodes>) stretch_mid_functions<Nodes>; \
  template decltype(element_points<Nodes>) element_points<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm::packs
