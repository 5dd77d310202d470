#pragma once
/// Finds the places of a beam's line that are nearest to the stations of another side, and the nodes that may take part
/// in the contact in a step.

#include <array>
#include <utility>

#include "contact/closest_point.h"
#include "contact/contact_element.h"

namespace flexarm {

/// The positions of nodes: at an end of a step, in between (with straight motions), or in a state.
class NodePlaces {
 public:
  explicit NodePlaces(const std::vector<NodePose>& poses) : begin_(&poses) {}
  explicit NodePlaces(const State& state) : state_(&state) {}
  NodePlaces(const std::vector<NodePose>& begin, const std::vector<NodePose>& end, double part)
      : begin_(&begin), end_(&end), part_(part) {}

  Vector3 position(int node) const;
  /// Not for places between both ends of a step.
  Matrix3 rotation(int node) const;

 private:
  const std::vector<NodePose>*begin_ = nullptr, *end_ = nullptr;
  const State* state_ = nullptr;
  double part_ = 0;
};

/// A station, by its index, and the part of the line that it may touch.
struct LinePair {
  int station = 0;
  LineRange range = {};
  ElementWeights tangent{};  ///< station of a beam: weights of its nodes for the derivative of its position by xi
};

/// The two sides of a contact with a line: stations and the line, and the pairs that may touch.
struct LineTouch {
  ContactStations side;
  ContactLine line;
  std::vector<LinePair> pairs;
  double spacing = 0;  ///< distance between consecutive stations of a beam; 0: a body [m]
};

/// The nodes on which the force element acts in a step; null: all nodes.
struct ListedNodes {
  const int* nodes = nullptr;
  int count = 0;
};

/// Searches nearest places for all pairs of a LineTouch.
class LineSearch {
 public:
  static constexpr int kMostPairs = 128;
  using Places = std::array<ClosestPoint, kMostPairs>;  ///< per pair; element -1: not near
  using Middles = std::array<Vector3, kMostPairs>;

  explicit LineSearch(LineTouch touch);
  /// Returns the size up to which a set of stations touches no more elements of a line than may act in a step [m].
  static double most_size(const ContactLine& line);

  const ContactStations& side() const { return touch_.side; }
  const ContactLine& line() const { return touch_.line; }
  const std::vector<LinePair>& pairs() const { return touch_.pairs; }
  const ContactStation& station(const LinePair& pair) const { return side().stations[pair.station]; }
  double radius_of(const LinePair& pair) const { return station(pair).radius + line().radius; }
  /// Returns the number of the stations' nodes; 0 if these are fixed to the world.
  int moving_nodes() const { return side().nodes[0] < 0 ? 0 : static_cast<int>(side().nodes.size()); }
  bool is_body() const { return moving_nodes() == 1; }
  std::vector<int> reach() const;
  int most_nodes() const { return most_nodes_; }
  bool is_listed(int element, const ListedNodes& listed) const;

  /// Returns the sum of weights[i] * of(node i) over an element's nodes.
  template <class Of>
  Vector3 sum(const ElementWeights& weights, int element, const Of& of) const {
    Vector3 out = Vector3::Zero();
    for (int i = 0; i <= line().order; ++i) out += weights[i] * of(line().elements[element][i]);
    return out;
  }
  Vector3 middle(const ContactStation& station, const NodePlaces& places) const;
  Middles middles(const NodePlaces& places) const;
  /// Returns the vector from a place of the line to a point.
  Vector3 offset(const Vector3& point, const ClosestPoint& place, const NodePlaces& places) const;
  /// Returns the nearest places of all pairs whose distance is below the sum of their radii plus `margin`. `only`:
  /// flags of the pairs to search; null: all.
  using Chosen = std::array<bool, kMostPairs>;
  Places closest(const Middles& middles, double margin, const NodePlaces& places, const ListedNodes& listed,
                 const Chosen* only = nullptr) const;

  /// See ForceElement::find_nodes(). Returns the stations' nodes and those of the elements of the line that are near;
  /// if these are too many, those of the nearest ones.
  int find_nodes(const ForceStart& start, int* nodes) const;
  /// See ForceElement::room().
  ForceRoom room(const ForceStart& start) const;
  /// Returns a bound of the relative motion over a step of all parts that may have touched [m]; < 0 if none can have.
  double way(const ForceStep& step) const;
  /// Whether a pair that touches at neither end of a step touches in between. `way`: see way().
  bool passes_through(std::size_t index, const ClosestPoint& begin, const ClosestPoint& end, double way,
                      const ForceStep& step) const;

 private:
  struct Cloud;

  ClosestPoint closest(const LinePiece& piece, int element, std::size_t pair, const Vector3& middle) const;
  LinePiece piece(int element, const NodePlaces& places) const;
  Cloud cloud(const NodePlaces& places) const;
  /// Calls visit(element, margin) for elements of the line that may be nearer to a cloud than margin =
  /// margin_of(element) [m].
  template <class MarginOf, class Visit>
  void for_each_near(const Cloud& cloud, const NodePlaces& places, const MarginOf& margin_of, const Visit& visit) const;
  bool is_any_near(int element, double margin, const NodePlaces& places) const;
  double least_gap(int element, const NodePlaces& places) const;
  double fastest(const ForceStart& start) const;

  LineTouch touch_;
  int most_near_ = 0;  ///< largest number of elements of the line that act in a step
  int most_nodes_;
  std::size_t stride_ = 1;     ///< is_any_near() tests only every so many pairs
  double between_ = 0;         ///< by how much pairs in between may be nearer [m]
  double largest_radius_ = 0;  ///< largest sum of the radii of a station and the tube [m]
  double largest_arm_ = 0;     ///< largest arm of a station [m]
  /// The stations of a body are in a ball about this point of it, in the frame of its node [m].
  Vector3 middle_arm_ = Vector3::Zero();
  double arm_reach_ = 0;  ///< radius of that ball [m]
};

}  // namespace flexarm
