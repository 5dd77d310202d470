#include "elements/conserving_beam.h"
#include "elements/conserving_pack.h"
#include "elements/conserving_pack_stages.h"
#include "elements/orders.h"
#include "math/simd.h"

namespace flexarm::packs {

template <int Nodes>
void carry_strains(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                   const TimeRule& rule, const ElementFunctions<Nodes, Pack>& functions,
                   const PointKinematicsT<Pack>* begin, const std::array<Vector6T<Pack>, Nodes>& update,
                   PointKinematicsT<Pack>* end, CarriedStrains<Nodes, Pack>& carried) {
  conserving::StepPoints<Nodes, Pack> at;
  set_points<Nodes>(element, nodes, rule, functions, true, end, at);
  simd::run([&] {
    conserving::set_strains<Nodes, Pack>(element, nodes, begin, end, nullptr, at);
    conserving::carry_strains<Nodes, Pack>(element, nodes, at, update, end, carried);
  });
}

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes) template decltype(carry_strains<Nodes>) carry_strains<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm::packs
