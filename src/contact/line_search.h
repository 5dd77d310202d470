#pragma once
/// Which places of a beam's line are nearest to others' stations, and which nodes may be near in a step.

#include <array>
#include <utility>

#include "contact/closest_point.h"
#include "contact/contact_element.h"

namespace flexarm {

/// Where nodes are: at an end of a step, between both ends as if they went straight, or in a state.
class NodePlaces {
 public:
  explicit NodePlaces(const std::vector<NodePose>& poses) : begin_(&poses) {}
  explicit NodePlaces(const State& state) : state_(&state) {}
  NodePlaces(const std::vector<NodePose>& begin, const std::vector<NodePose>& end, double part)
      : begin_(&begin), end_(&end), part_(part) {}

  Vector3 position(int node) const;
  /// Not between both ends.
  Matrix3 rotation(int node) const;

 private:
  const std::vector<NodePose>*begin_ = nullptr, *end_ = nullptr;
  const State* state_ = nullptr;
  double part_ = 0;
};

/// A station, by its number, and the part of the line that it may touch.
struct LinePair {
  int station = 0;
  LineRange range = {};
  ElementWeights tangent{};  ///< of a beam's station: weights of its nodes, of the derivative by xi
};

/// What touches a line: pairs of stations and parts of it.
struct LineTouch {
  ContactStations side;
  ContactLine line;
  std::vector<LinePair> pairs;
  double spacing = 0;  ///< of a beam's stations, which follow each other [m]
};

/// The nodes on which an element acts in a step; null: all.
struct ListedNodes {
  const int* nodes = nullptr;
  int count = 0;
};

class LineSearch {
 public:
  static constexpr int kMostPairs = 128;
  using Places = std::array<ClosestPoint, kMostPairs>;  ///< of each pair; no element: it is not near
  using Middles = std::array<Vector3, kMostPairs>;

  explicit LineSearch(LineTouch touch);

  const ContactStations& side() const { return touch_.side; }
  const ContactLine& line() const { return touch_.line; }
  const std::vector<LinePair>& pairs() const { return touch_.pairs; }
  const ContactStation& station(const LinePair& pair) const { return side().stations[pair.station]; }
  double radius_of(const LinePair& pair) const { return station(pair).radius + line().radius; }
  /// Of the stations' nodes those that move.
  int moving_nodes() const { return side().nodes[0] < 0 ? 0 : static_cast<int>(side().nodes.size()); }
  bool is_body() const { return moving_nodes() == 1; }
  std::vector<int> reach() const;
  int most_nodes() const { return most_nodes_; }
  bool is_listed(int element, const ListedNodes& listed) const;

  /// Numbers of an element's nodes times what `of(node)` says of them.
  template <class Of>
  Vector3 sum(const ElementWeights& weights, int element, const Of& of) const {
    Vector3 out = Vector3::Zero();
    for (int i = 0; i <= line().order; ++i) out += weights[i] * of(line().elements[element][i]);
    return out;
  }
  Vector3 middle(const ContactStation& station, const NodePlaces& places) const;
  Middles middles(const NodePlaces& places) const;
  /// From a place of the line to a point.
  Vector3 offset(const Vector3& point, const ClosestPoint& place, const NodePlaces& places) const;
  /// The nearest places of all pairs that are nearer than their radii and `margin`. `only`: of those; null: of all.
  using Chosen = std::array<bool, kMostPairs>;
  Places closest(const Middles& middles, double margin, const NodePlaces& places, const ListedNodes& listed,
                 const Chosen* only = nullptr) const;

  /// See ForceElement::find_nodes(): the stations', and those of elements of the line that are near; of many the
  /// nearest.
  int find_nodes(const ForceStart& start, int* nodes) const;
  /// See ForceElement::room().
  ForceRoom room(const ForceStart& start) const;
  /// The largest relative way of what may have touched over a step [m]; < 0: nothing has.
  double way(const ForceStep& step) const;
  /// Between both ends of a step, of a pair that touches at neither.
  bool passes_through(std::size_t index, const ClosestPoint& begin, const ClosestPoint& end, double way,
                      const ForceStep& step) const;

 private:
  struct Cloud;

  ClosestPoint closest(const LinePiece& piece, int element, std::size_t pair, const Vector3& middle) const;
  LinePiece piece(int element, const NodePlaces& places) const;
  Cloud cloud(const NodePlaces& places) const;
  /// Calls visit(element, margin_of(element)) of elements of the line that may be so near to a cloud [m].
  template <class MarginOf, class Visit>
  void for_each_near(const Cloud& cloud, const NodePlaces& places, const MarginOf& margin_of, const Visit& visit) const;
  bool is_any_near(int element, double margin, const NodePlaces& places) const;
  double fastest(const Cloud& cloud, const ForceStart& start) const;

  LineTouch touch_;
  int most_near_ = 0;  ///< elements of the line that may act in a step
  int most_nodes_;
  std::size_t stride_ = 1;     ///< of pairs that stand for all where these may be far
  double between_ = 0;         ///< by which those in between may be nearer [m]
  double largest_radius_ = 0;  ///< of a station and the tube [m]
  double largest_arm_ = 0;     ///< of a station [m]
};

}  // namespace flexarm
