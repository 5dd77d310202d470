#include "integrators/element_pack.h"

#include <algorithm>

#include "elements/orders.h"

namespace flexarm {

template <int Nodes>
PackGroup<Nodes> packs_of(const std::vector<BeamElement<Nodes>>& elements) {
  constexpr int lanes = Pack::kLanes;
  const int count = static_cast<int>(elements.size());
  PackGroup<Nodes> packs((count + lanes - 1) / lanes);
  // Which terms there are is the same for a whole group, so that an element does not feel its neighbours.
  bool is_uniform = true, is_coupled = false, is_damped_evenly = true;
  bool has_stiffness_damping = false, has_mass_damping = false;
  for (std::size_t p = 0; p < packs.size(); ++p) {
    auto& pack = packs[p];
    const int first = static_cast<int>(p) * lanes;
    pack.lanes = std::min(lanes, count - first);
    for (int lane = 0; lane < lanes; ++lane) {
      const auto& element = elements[std::min(first + lane, count - 1)];
      pack.nodes[lane] = element.nodes;
      pack.first_block[lane] = element.first_block;
      pack.first_stiffness_point[lane] = element.first_stiffness_point;
      set_lane(pack.element, lane, element);
    }
    is_uniform = is_uniform && pack.element.is_uniform;
    for (const auto& section : pack.element.sections) is_coupled = is_coupled || section.is_coupled;
    is_damped_evenly = is_damped_evenly && pack.element.is_damped_evenly;
    has_stiffness_damping = has_stiffness_damping || pack.element.has_stiffness_damping;
    has_mass_damping = has_mass_damping || pack.element.has_mass_damping;
  }
  for (auto& pack : packs) {
    pack.element.is_uniform = is_uniform;
    for (auto& section : pack.element.sections) section.is_coupled = is_coupled;
    pack.element.is_damped_evenly = is_damped_evenly;
    pack.element.has_stiffness_damping = has_stiffness_damping;
    pack.element.has_mass_damping = has_mass_damping;
  }
  return packs;
}

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes) template decltype(packs_of<Nodes>) packs_of<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
