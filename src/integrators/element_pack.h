#pragma once
/// Elements of the energy-momentum family side by side.

#include <vector>

#include "elements/conserving_pack.h"

namespace flexarm {

/// Elements side by side; the last one fills what the group leaves of its last pack.
template <int Nodes>
struct ElementPack {
  static constexpr int kNodes = Nodes;
  int lanes = 0;  // in use
  std::array<std::array<int, Nodes>, Pack::kLanes> nodes;
  std::array<int, Pack::kLanes> first_block, first_stiffness_point;
  ConservingElement<Nodes, Pack> element;
  ElementFunctions<Nodes, Pack> mid_functions;
  CarriedStrains<Nodes, Pack> carried;
  std::array<std::array<PointKinematicsT<Pack>, Nodes - 1>, 2> points;  // at the beginning and at the end
};
template <int Nodes>
using PackGroup = std::vector<ElementPack<Nodes>>;

/// Packs of elements of one order.
template <int Nodes>
PackGroup<Nodes> packs_of(const std::vector<BeamElement<Nodes>>& elements);

}  // namespace flexarm
