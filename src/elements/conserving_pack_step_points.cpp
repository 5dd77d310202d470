#include "elements/conserving_pack_stages.h"
#include "elements/conserving_points.h"
#include "elements/orders.h"
#include "math/simd.h"

namespace flexarm::packs {

template <int Nodes>
void set_points(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                const TimeRule& rule, const ElementFunctions<Nodes, Pack>& functions, bool with_variation,
                PointKinematicsT<Pack>* end, conserving::StepPoints<Nodes, Pack>& at) {
  simd::run([&] { conserving::set_points<Nodes, Pack>(element, nodes, rule, functions, with_variation, end, at); });
}

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes) template decltype(set_points<Nodes>) set_points<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm::packs
