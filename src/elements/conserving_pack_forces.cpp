#include "elements/conserving_beam.h"
#include "elements/conserving_pack.h"
#include "elements/conserving_pack_stages.h"
#include "elements/orders.h"
#include "math/simd.h"

namespace flexarm::packs {

template <int Nodes>
void conserving_beam(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                     const TimeRule& rule, const ElementFunctions<Nodes, Pack>& functions,
                     const PointKinematicsT<Pack>* begin, const StrainMemoryT<Pack>* memory, double step,
                     bool with_tangent, const CarriedStrains<Nodes, Pack>* carried, PointKinematicsT<Pack>* end,
                     StrainMemoryT<Pack>* end_memory, BlockSystem<Nodes, Pack>& system,
                     const MaxwellBranches<Pack>& branches) {
  conserving::StepPoints<Nodes, Pack> at;
  conserving::EnergyMultiplier<Nodes, Pack> multiplier;
  set_points<Nodes>(element, nodes, rule, functions, with_tangent, end, at);
  simd::run([&] {
    conserving::set_strains<Nodes>(element, nodes, begin, end, carried, at);
    conserving::set_forces<Nodes>(element, nodes, rule, begin, end, memory, step, with_tangent, carried != nullptr,
                                  end_memory, branches, at, multiplier, system);
  });
  if (with_tangent) add_tangent<Nodes>(element, nodes, rule, at, multiplier, system);
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes) template decltype(conserving_beam<Nodes>) conserving_beam<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm::packs
