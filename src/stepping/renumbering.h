#pragma once
/// Where coordinates and links are after links of a simulation came or went.

#include <cstddef>
#include <optional>
#include <vector>

namespace flexarm {
class Simulation;
}

namespace flexarm::node {

/// Indices in another simulation of the coordinates and links that have the same names there.
struct Renumbering {
  using Places = std::vector<std::optional<std::size_t>>;  ///< by the index before; empty: there is none any more

  Renumbering(const Simulation& before, const Simulation& after);

  Places coordinates, links;
};

}  // namespace flexarm::node
