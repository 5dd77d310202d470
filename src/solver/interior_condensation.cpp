#include "solver/interior_condensation.h"

#include <algorithm>
#include <cassert>

#include "math/lanes.h"
#include "math/simd.h"
#include "solver/front_lanes.h"

namespace flexarm {
namespace {

using Mask = Pack::Mask;

/// The node that an interior scalar belongs to.
constexpr int node_of(int scalar) {
  return 1 + scalar / 6;
}
template <int Nodes>
constexpr int end_node(int end) {
  return end == 0 ? 0 : Nodes - 1;
}

/// The four blocks of the end nodes of one lane, 36 numbers each.
template <int Nodes>
[[gnu::always_inline]] inline double* ends_of(CondensedPack<Nodes>& pack, int lane) {
  static_assert(sizeof(Matrix6T<Pack>) == 4 * 36 * sizeof(double));
  return reinterpret_cast<double*>(pack.system.tangent[end_node<Nodes>(lane / 2)][end_node<Nodes>(lane % 2)].data());
}

/// For each lane, the address of the numbers of a node; nodes are `distance` apart in memory.
template <int Nodes, class Number>
[[gnu::always_inline]] inline std::array<Number*, Pack::kLanes> of_node(const CondensedPack<Nodes>& pack, int node,
                                                                        Number* first, std::size_t distance) {
  std::array<Number*, Pack::kLanes> places;
  for (int lane = 0; lane < Pack::kLanes; ++lane) places[lane] = first + distance * pack.nodes[lane][node];
  return places;
}

/// A copy of A_ii for the factorisation. The pack keeps its own, since it may have to be left whole.
template <int Nodes>
using Factors = std::array<std::array<Pack, 6 * (Nodes - 2)>, 6 * (Nodes - 2)>;

/// Copies A_ii, and adds the other contributions to the diagonal blocks of its nodes.
template <int Nodes>
[[gnu::always_inline]] inline void gather(const CondensedPack<Nodes>& pack, const double* diagonals,
                                          Factors<Nodes>& rows) {
  for (int i = 1; i < Nodes - 1; ++i)
    for (int j = 1; j < Nodes - 1; ++j) {
      Matrix6T<Pack> block = pack.system.tangent[i][j];
      if (i == j) {
        Matrix6T<Pack> diagonal;
        load_lanes<36>(of_node(pack, i, diagonals, 36).data(), diagonal.data());
        block += diagonal;
      }
      for (int r = 0; r < 6; ++r)
        for (int c = 0; c < 6; ++c) rows[6 * (i - 1) + r][6 * (j - 1) + c] = block(r, c);
    }
}

/// L U factorisation with pivots on the diagonal. Returns the lanes in which it is as stable as with a pivot search, by
/// the criterion of ElementFront.
template <std::size_t n>
[[gnu::always_inline]] inline Mask factorise(std::array<std::array<Pack, n>, n>& rows) {
  Pack entries[n];
  for (std::size_t k = 0; k < n; ++k) entries[k] = rows[k][k];
  Mask is_stable = {-1, -1, -1, -1};
  for (std::size_t k = 0; k < n; ++k) {
    const Pack::Vector pivot = rows[k][k].values(), twice = 2 * entries[k].values();
    is_stable &= (pivot >= kSmallestPivot) & (pivot <= twice) & (pivot <= kLargestPivot);
    const Pack reciprocal = Pack(1.0) / rows[k][k];
    for (std::size_t i = k + 1; i < n; ++i) {
      const Pack multiplier = rows[i][k] * reciprocal;
      for (std::size_t j = k + 1; j < n; ++j) rows[i][j] -= multiplier * rows[k][j];
      rows[i][k] = multiplier;
    }
    rows[k][k] = reciprocal;
  }
  return is_stable;
}

/// x <- A_ii^-1 x, for n unknowns; factor(i, k): an entry of the factors.
template <int n, class Factor>
[[gnu::always_inline]] inline void solve(const Factor& factor, Pack* x) {
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) x[i] -= factor(i, k) * x[k];
  for (int k = n - 1; k >= 0; --k) {
    x[k] = x[k] * factor(k, k);
    for (int i = 0; i < k; ++i) x[i] -= factor(i, k) * x[k];
  }
}

/// Replaces A_ie by X, and A_ii by its factors.
template <int Nodes>
[[gnu::always_inline]] inline void keep_factors(const Factors<Nodes>& rows, CondensedPack<Nodes>& pack) {
  constexpr int n = 6 * (Nodes - 2);
  auto& tangent = pack.system.tangent;
  for (const int end : {0, Nodes - 1})
    for (int c = 0; c < 6; ++c) {
      Pack x[n];
      for (int k = 0; k < n; ++k) x[k] = tangent[node_of(k)][end](k % 6, c);
      solve<n>([&](int i, int k) -> const Pack& { return rows[i][k]; }, x);
      for (int k = 0; k < n; ++k) tangent[node_of(k)][end](k % 6, c) = x[k];
    }
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) tangent[node_of(i)][node_of(k)](i % 6, k % 6) = rows[i][k];
}

/// Computes A_ee - A_ei X, and stores it lane by lane in place of A_ee.
template <int Nodes>
[[gnu::always_inline]] inline void eliminate(CondensedPack<Nodes>& pack) {
  constexpr int n = 6 * (Nodes - 2);
  auto& tangent = pack.system.tangent;
  Matrix6T<Pack> left[4];
  for (int block = 0; block < 4; ++block) {
    const int e = end_node<Nodes>(block / 2), f = end_node<Nodes>(block % 2);
    for (int c = 0; c < 6; ++c) {
      Pack sums[6];
      for (int r = 0; r < 6; ++r) sums[r] = tangent[e][f](r, c);
      for (int k = 0; k < n; ++k) {
        const Pack solved = tangent[node_of(k)][f](k % 6, c);
        for (int r = 0; r < 6; ++r) sums[r] -= tangent[e][node_of(k)](r, k % 6) * solved;
      }
      for (int r = 0; r < 6; ++r) left[block](r, c) = sums[r];
    }
  }
  for (int block = 0; block < 4; ++block) {
    std::array<double*, Pack::kLanes> targets;
    for (int lane = 0; lane < Pack::kLanes; ++lane) targets[lane] = ends_of(pack, lane) + 36 * block;
    add_lanes<36, true>(left[block].data(), Pack::kLanes, targets.data());
  }
}

/// Writes all blocks of the pack to the memory of the elements.
template <int Nodes>
[[gnu::always_inline]] inline void write_whole(const CondensedPack<Nodes>& pack, double* blocks) {
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j) {
      std::array<double*, Pack::kLanes> targets;
      for (int lane = 0; lane < Pack::kLanes; ++lane)
        targets[lane] = blocks + 36 * (static_cast<std::size_t>(pack.first_block[lane]) + Nodes * i + j);
      add_lanes<36, true>(pack.system.tangent[i][j].data(), pack.lanes, targets.data());
    }
}

/// Condenses a pack. Returns false if a lane needs a pivot search; the tangent is then unchanged.
template <int Nodes>
[[gnu::always_inline]] inline bool condense(CondensedPack<Nodes>& pack, const double* diagonals) {
  Factors<Nodes> rows;
  gather(pack, diagonals, rows);
  const Mask is_stable = factorise(rows);
  if ((is_stable[0] & is_stable[1] & is_stable[2] & is_stable[3]) == 0) return false;
  keep_factors(rows, pack);
  eliminate(pack);
  return true;
}

/// Loads the values of the interior nodes, for all lanes.
template <int Nodes>
[[gnu::always_inline]] inline void get_interior(const CondensedPack<Nodes>& pack, const double* values,
                                                Pack* interior) {
  for (int i = 1; i < Nodes - 1; ++i) load_lanes<6>(of_node(pack, i, values, 6).data(), interior + 6 * (i - 1));
}
template <int Nodes>
[[gnu::always_inline]] inline void set_interior(const CondensedPack<Nodes>& pack, const Pack* interior,
                                                double* values) {
  for (int i = 1; i < Nodes - 1; ++i)
    add_lanes<6, true>(interior + 6 * (i - 1), pack.lanes, of_node(pack, i, values, 6).data());
}

template <int Nodes>
[[gnu::always_inline]] inline void forward_pack(const CondensedPack<Nodes>& pack, double* values) {
  constexpr int n = 6 * (Nodes - 2);
  const auto& tangent = pack.system.tangent;
  Pack interior[n];
  get_interior(pack, values, interior);
  solve<n>([&](int i, int k) -> const Pack& { return tangent[node_of(i)][node_of(k)](i % 6, k % 6); }, interior);
  set_interior(pack, interior, values);
  for (const int end : {0, Nodes - 1}) {
    Pack change[6];
    for (int r = 0; r < 6; ++r) change[r] = Pack(0.0);
    for (int k = 0; k < n; ++k)
      for (int r = 0; r < 6; ++r) change[r] -= tangent[end][node_of(k)](r, k % 6) * interior[k];
    add_lanes<6>(change, pack.lanes, of_node(pack, end, values, 6).data());
  }
}

template <int Nodes>
[[gnu::always_inline]] inline void backward_pack(const CondensedPack<Nodes>& pack, double* values) {
  constexpr int n = 6 * (Nodes - 2);
  Pack interior[n];
  get_interior(pack, values, interior);
  for (const int end : {0, Nodes - 1}) {
    Pack moved[6];
    load_lanes<6>(of_node(pack, end, values, 6).data(), moved);
    for (int c = 0; c < 6; ++c)
      for (int k = 0; k < n; ++k) interior[k] -= pack.system.tangent[node_of(k)][end](k % 6, c) * moved[c];
  }
  set_interior(pack, interior, values);
}

}  // namespace

InteriorCondensation::InteriorCondensation(const Model& model, const TreeOrder& order)
    : order_(order), places_(order.parts().size()) {
  std::vector<int> part_of_block;
  for (std::size_t p = 0; p < order.parts().size(); ++p) {
    const TreePart& part = order.parts()[p];
    if (part.joint >= 0) continue;
    part_of_block.resize(std::max(part_of_block.size(), part.first_block + 1), -1);
    part_of_block[part.first_block] = static_cast<int>(p);
  }
  for_each_group(model.beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group.elements)>::value_type::kNodes;
    if constexpr (N > 2) {
      auto& packs = std::get<std::vector<CondensedPack<N>>>(groups_);
      const std::size_t count = group.elements.size();
      packs.resize((count + Pack::kLanes - 1) / Pack::kLanes);
      for (std::size_t p = 0; p < packs.size(); ++p) {
        packs[p].lanes = static_cast<int>(std::min<std::size_t>(Pack::kLanes, count - Pack::kLanes * p));
        for (int lane = 0; lane < Pack::kLanes; ++lane) {
          const auto& element = group.elements[std::min(Pack::kLanes * p + lane, count - 1)];
          packs[p].nodes[lane] = element.nodes;
          packs[p].first_block[lane] = element.first_block;
          packs[p].parts[lane] = part_of_block[element.first_block];
          if (lane < packs[p].lanes) places_[packs[p].parts[lane]] = {static_cast<int>(p), lane};
        }
      }
    }
  });
}

void InteriorCondensation::begin() {
  for_each_group(groups_, [](auto& packs) {
    for (auto& pack : packs) pack.is_ready = false;
  });
}

template <int Nodes>
bool InteriorCondensation::keeps_interiors(const CondensedPack<Nodes>& pack) const {
  return std::all_of(pack.parts.begin(), pack.parts.end(), [&](int p) { return order_.parts()[p].keeps_interior; });
}

template <int Nodes>
double* InteriorCondensation::prepare(const Place& place, TreeBlocks& blocks, double* values) {
  assert(place.pack >= 0 && "an element's part");
  CondensedPack<Nodes>& pack = std::get<std::vector<CondensedPack<Nodes>>>(groups_)[place.pack];
  if (!pack.is_ready) {
    pack.is_ready = true;
    const bool may_be_condensed = keeps_interiors(pack);
    simd::run([&] {
      pack.is_condensed = may_be_condensed && condense(pack, blocks.diagonals.data());
      if (!pack.is_condensed)
        write_whole(pack, blocks.elements.data());
      else if (values)
        forward_pack(pack, values);
    });
  }
  return pack.is_condensed ? ends_of(pack, place.lane) : nullptr;
}

double* InteriorCondensation::prepare(int part, TreeBlocks& blocks, double* values) {
  switch (order_.parts()[part].node_count) {
    case 3:
      return prepare<3>(places_[part], blocks, values);
    case 4:
      return prepare<4>(places_[part], blocks, values);
    case 5:
      return prepare<5>(places_[part], blocks, values);
    default:
      return nullptr;
  }
}

void InteriorCondensation::forward(double* values) const {
  for_each_group(groups_, [&](const auto& packs) {
    simd::run([&] {
      for (const auto& pack : packs)
        if (pack.is_condensed) forward_pack(pack, values);
    });
  });
}

void InteriorCondensation::backward(double* values) const {
  for_each_group(groups_, [&](const auto& packs) {
    simd::run([&] {
      for (const auto& pack : packs)
        if (pack.is_condensed) backward_pack(pack, values);
    });
  });
}

}  // namespace flexarm
