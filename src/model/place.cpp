#include "model/place.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <optional>

#include "model/carried_origin.h"

namespace flexarm {

using Place = StepResult::Place;

Place place_of_element(const Model& model, const State& state, int order, int index, int node) {
  assert(node >= 0 && static_cast<std::size_t>(node) < state.nodes.size());
  Place place;
  place.position = world_origin(model, state) + state.nodes[node].position;
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    const std::optional<BeamLink>& beam = model.links[link].beam;
    if (!beam || beam->order != order) continue;
    const auto found = std::find(beam->elements.begin(), beam->elements.end(), index);
    if (found == beam->elements.end()) continue;
    place.link = static_cast<int>(link);
    place.element = beam->parts[found - beam->elements.begin()].element;
  }
  return place;
}

Place place_of_node(const Model& model, const State& state, int node) {
  assert(node >= 0 && static_cast<std::size_t>(node) < state.nodes.size());
  Place place;
  for_each_group(model.beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group.elements)>::value_type::kNodes;
    for (std::size_t e = 0; e < group.elements.size() && place.link < 0; ++e) {
      const auto& nodes = group.elements[e].nodes;
      if (std::find(nodes.begin(), nodes.end(), node) != nodes.end())
        place = place_of_element(model, state, N - 1, static_cast<int>(e), node);
    }
  });
  if (place.link >= 0) return place;
  place.position = world_origin(model, state) + state.nodes[node].position;
  for (std::size_t link = 0; link < model.links.size() && place.link < 0; ++link)
    if (model.links[link].frame.node == node) place.link = static_cast<int>(link);
  return place;
}

Place place_of_joint(const Model& model, const State& state, int joint, int component) {
  Place place = place_of_node(model, state, model.joints[joint].slave);
  for (std::size_t i = 0; i < model.coordinates.size(); ++i)
    if (model.coordinates[i].joint == joint && model.coordinates[i].component == component)
      place.coordinate = static_cast<int>(i);
  return place;
}

Place place_of_loop(const Model& model, const State& state, int loop) {
  assert(loop >= 0 && static_cast<std::size_t>(loop) < model.closures.size());
  Place place;
  place.position = world_origin(model, state) + state.nodes[model.closures[loop].child].position;
  place.loop = loop;
  return place;
}

Place place_of_force_element(const Model& model, const State& state, int element) {
  Place place;
  place.force_element = element;
  const std::vector<int>& reach = model.force_elements[element]->reach();
  if (!reach.empty()) place.position = world_origin(model, state) + state.nodes[reach.front()].position;
  return place;
}

}  // namespace flexarm
