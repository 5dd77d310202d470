#pragma once
/// A flexible centreline on which something slides: its elements in order, with one arc length over all of them.

#include <algorithm>
#include <vector>

namespace flexarm {

/// One element of the line, between the arc lengths `begin` and `end` of the undeformed line [m].
struct SlidePiece {
  int first_node = 0;  ///< index into SlideLine::nodes of its first node
  int node_count = 2;
  double begin = 0, end = 0;
  double length() const { return end - begin; }
  int end_node() const { return first_node + node_count; }  ///< one past its last node
};

/// How the contact of a slider is carried over a step (Muñoz 2004, Tables 9.3, 9.5; joints.md 4.4, 4.5). None but the
/// first is exact in all of contact, work and momenta.
enum class SlideStep {
  SmEm,         ///< exact contact, momentum and work, over any border
  MidContact,   ///< SM1-NTa: contact in the middle of the step, exact momentum; within an element
  EndContact,   ///< SM1-NTb: contact at the end, exact work; within an element
  EnterMid,     ///< SM1-Ta: from one element into another one, exact momentum, off the line at the end
  EnterEnd,     ///< SM1-Tb, and with M2 SM2-Tb: the same, on the line, exact work
  BeginWeights  ///< SM2-NT: with weights of the beginning, for M2: exact contact, momentum and work; within an element
};

/// Its choice within an element and over borders.
struct SlideAlgorithm {
  SlideStep within = SlideStep::SmEm, across = SlideStep::SmEm;
};

/// Consecutive nodes of a line, [first, end).
struct NodeRange {
  int first, end;
};

/// A smooth stretch of it: a kink ends the line. Nodes follow each other; neighbouring elements share one.
struct SlideLine {
  /// Elements that a step may touch; a longer way is taken in shorter steps.
  static constexpr int kMostPieces = 3;

  /// Way beyond its ends that a section may lie, relative to the element there.
  static constexpr double kLargestOvershoot = 0.1;

  std::vector<int> nodes;  ///< of the model
  std::vector<SlidePiece> pieces;
  bool smooth = false;  ///< C1: the tangents of line and frame are continuous over borders (beyond.md 2)

  double begin() const { return pieces.front().begin; }
  double end() const { return pieces.back().end; }
  /// Index of the piece that contains the arc length; the end pieces beyond the ends.
  int piece_at(double arc_length) const {
    const auto after = std::upper_bound(pieces.begin() + 1, pieces.end(), arc_length,
                                        [](double x, const SlidePiece& piece) { return x < piece.begin; });
    return static_cast<int>(after - pieces.begin()) - 1;
  }
  /// Nodes on which sections between two pieces, first <= last, depend: a smooth line's on their neighbours', too.
  NodeRange support(int first, int last) const {
    const int reach = smooth ? 1 : 0, most = static_cast<int>(pieces.size()) - 1;
    return {pieces[std::max(first - reach, 0)].first_node, pieces[std::min(last + reach, most)].end_node()};
  }
  /// Most nodes on which the sections of a step depend.
  std::size_t most_active_nodes() const {
    const int count = static_cast<int>(pieces.size());
    int most = 0;
    for (int p = 0; p < count; ++p) {
      const NodeRange active = support(p, std::min(p + kMostPieces, count) - 1);
      most = std::max(most, active.end - active.first);
    }
    return static_cast<std::size_t>(most);
  }
  /// How far it lies beyond the ends, relative to the length of the element there; 0 on the line.
  double overshoot(double arc_length) const {
    const SlidePiece& piece = arc_length < begin() ? pieces.front() : pieces.back();
    return std::max({0.0, begin() - arc_length, arc_length - end()}) / piece.length();
  }
};

}  // namespace flexarm
