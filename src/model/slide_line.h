#pragma once
/// Data of a flexible centreline on which a slider moves: its elements in order, and one arc length along all of them.

#include <algorithm>
#include <vector>

namespace flexarm {

/// One element of the line, between the arc lengths `begin` and `end` of the undeformed line [m].
struct SlidePiece {
  int first_node = 0;  ///< index of its first node in SlideLine::nodes
  int node_count = 2;
  double begin = 0, end = 0;
  double length() const { return end - begin; }
  int end_node() const { return first_node + node_count; }  ///< one past its last node
};

/// How a step treats the contact between slider and line (Muñoz 2004, Tables 9.3, 9.5; joints.md 4.4, 4.5). "Exact
/// contact": the slider is on the line at both ends of the step. Only SmEm is exact in contact, work and momenta for
/// all schemes and over element borders.
enum class SlideStep {
  SmEm,         ///< exact contact, momentum and work, over any border
  MidContact,   ///< SM1-NTa: contact in the middle of the step, exact momentum; within an element
  EndContact,   ///< SM1-NTb: contact at the end, exact work; within an element
  EnterMid,     ///< SM1-Ta: from one element into another, exact momentum; off the line at the end
  EnterEnd,     ///< SM1-Tb, with scheme M2 SM2-Tb: from one element into another, exact work; on the line at the end
  BeginWeights  ///< SM2-NT, for scheme M2: weights of the beginning; exact contact, momentum, work; within an element
};

/// The treatment of steps within an element, and of steps across borders of elements.
struct SlideAlgorithm {
  SlideStep within = SlideStep::SmEm, across = SlideStep::SmEm;
};

/// Consecutive nodes of a line, [first, end).
struct NodeRange {
  int first, end;
};

/// A stretch of the centreline without kinks; a kink ends the line. Nodes are in order along it; neighbouring elements
/// share a node.
struct SlideLine {
  /// Largest number of elements that a step may touch. If the slider goes farther, the step is halved.
  static constexpr int kMostPieces = 3;

  /// How far a section may lie beyond the ends of the line, relative to the length of the element there.
  static constexpr double kLargestOvershoot = 0.1;

  std::vector<int> nodes;  ///< indices into Model::nodes
  std::vector<SlidePiece> pieces;
  bool smooth = false;  ///< C1: the derivatives of position and frame are continuous across borders (beyond.md 2)

  double begin() const { return pieces.front().begin; }
  double end() const { return pieces.back().end; }
  /// Returns the index of the piece that contains the arc length. Beyond an end, returns the piece at that end.
  int piece_at(double arc_length) const {
    const auto after = std::upper_bound(pieces.begin() + 1, pieces.end(), arc_length,
                                        [](double x, const SlidePiece& piece) { return x < piece.begin; });
    return static_cast<int>(after - pieces.begin()) - 1;
  }
  /// Returns the nodes on which sections in the pieces `first` to `last` depend. On a smooth line these include the
  /// nodes of the neighbouring pieces.
  NodeRange support(int first, int last) const {
    const int reach = smooth ? 1 : 0, most = static_cast<int>(pieces.size()) - 1;
    return {pieces[std::max(first - reach, 0)].first_node, pieces[std::min(last + reach, most)].end_node()};
  }
  /// Returns the largest number of nodes on which the sections of one step depend.
  std::size_t most_active_nodes() const {
    const int count = static_cast<int>(pieces.size());
    int most = 0;
    for (int p = 0; p < count; ++p) {
      const NodeRange active = support(p, std::min(p + kMostPieces, count) - 1);
      most = std::max(most, active.end - active.first);
    }
    return static_cast<std::size_t>(most);
  }
  /// Returns how far an arc length is beyond the ends, relative to the length of the element there; 0 on the line.
  double overshoot(double arc_length) const {
    const SlidePiece& piece = arc_length < begin() ? pieces.front() : pieces.back();
    return std::max({0.0, begin() - arc_length, arc_length - end()}) / piece.length();
  }
};

}  // namespace flexarm
