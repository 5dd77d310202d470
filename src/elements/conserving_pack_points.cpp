#include "elements/conserving_beam.h"
#include "elements/conserving_pack.h"
#include "elements/conserving_pack_stages.h"
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

template <int Nodes>
void set_points(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                const TimeRule& rule, const ElementFunctions<Nodes, Pack>& functions, bool with_variation,
                PointKinematicsT<Pack>* end, conserving::StepPoints<Nodes, Pack>& at) {
  simd::run([&] { conserving::set_points<Nodes, Pack>(element, nodes, rule, functions, with_variation, end, at); });
}

template <int Nodes>
void carry_strains(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                   const TimeRule& rule, const ElementFunctions<Nodes, Pack>& functions,
                   const PointKinematicsT<Pack>* begin, const std::array<Vector6T<Pack>, Nodes>& update,
                   PointKinematicsT<Pack>* end, CarriedStrains<Nodes, Pack>& carried) {
  conserving::StepPoints<Nodes, Pack> at;
  const CarriedStrains<Nodes, Pack>* none = nullptr;
  set_points<Nodes>(element, nodes, rule, functions, true, end, at);
  simd::run([&] {
    conserving::set_strains<Nodes>(element, nodes, begin, end, none, at);
    conserving::carry_strains<Nodes, Pack>(element, nodes, at, update, end, carried);
  });
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes)                                                      \
  template decltype(mid_functions<Nodes>) mid_functions<Nodes>;                 \
  template decltype(stretch_mid_functions<Nodes>) stretch_mid_functions<Nodes>; \
  template decltype(element_points<Nodes>) element_points<Nodes>;               \
  template decltype(set_points<Nodes>) set_points<Nodes>;                       \
  template decltype(carry_strains<Nodes>) carry_strains<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm::packs
