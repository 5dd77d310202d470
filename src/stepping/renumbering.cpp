#include "renumbering.h"

#include <map>
#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {
namespace {

Renumbering::Places places_of(const std::vector<std::string>& before, const std::vector<std::string>& after) {
  std::map<std::string, std::size_t> indices;
  for (std::size_t i = 0; i < after.size(); ++i) indices[after[i]] = i;
  Renumbering::Places places;
  places.reserve(before.size());
  for (const std::string& name : before) {
    const auto found = indices.find(name);
    places.push_back(found == indices.end() ? std::nullopt : std::optional(found->second));
  }
  return places;
}

}  // namespace

Renumbering::Renumbering(const Simulation& before, const Simulation& after)
    : coordinates(places_of(before.coordinate_names(), after.coordinate_names())),
      links(places_of(before.link_names(), after.link_names())) {}

}  // namespace flexarm::node
