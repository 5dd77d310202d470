#pragma once
/// Contact of what one body has to touch with, or an element of a beam, and a beam's smooth line: a force element.

#include <array>

#include "contact/closest_point.h"
#include "contact/contact_element.h"
#include "contact/line_point.h"

namespace flexarm {

/// A station, by its number, and the part of the line that it may touch.
struct LinePair {
  int station = 0;
  LineRange range = {};
};

/// Each pair: the ball of the station with what is nearest of its part of the line. Where the nearest place goes from
/// one element of the line to the next, nothing else changes.
class LineContact : public ForceElement {
 public:
  static constexpr int kMostPairs = 64;

  /// `links`: names of the link with the stations, and of the one with the line.
  LineContact(std::vector<std::string> links, ContactStations side, ContactLine line, std::vector<LinePair> pairs,
              const ContactLaw& law);

  const char* kind() const override { return "contact"; }
  std::vector<std::string> links() const override { return links_; }
  std::string description() const override;
  int most_nodes() const override;
  /// Of the stations, and of those elements of the line that are near, nearest first where there are many.
  int find_nodes(const ForceStart& start, int* nodes) const override;
  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  bool needs_halves(const ForceStep& step, const int* nodes, int count) const override;
  bool hits() const override { return true; }
  double energy(const State& state, const double* memory) const override;
  ForceMeasures measures(const State& state, const int* nodes) const override;
  DamperTensions dampers(const State& state, const Eigen::VectorXd& rates) const override;
  int memory_size() const override { return LineMemory::kSize * static_cast<int>(pairs_.size()); }
  bool suits_all_schemes() const override { return false; }

  /// Deepest penetration of all pairs; 0: none touches [m].
  double deepest(const std::vector<NodePose>& poses) const;

 private:
  using Places = std::array<ClosestPoint, kMostPairs>;
  using Middles = std::array<Vector3, kMostPairs>;
  /// The nodes on which it acts in a step; null: all.
  struct Listed {
    const int* nodes = nullptr;
    int count = 0;
  };
  struct Cloud;
  struct Acting;

  int moving_nodes() const { return side_.nodes[0] < 0 ? 0 : static_cast<int>(side_.nodes.size()); }
  double radius_of(const LinePair& pair) const { return side_.stations[pair.station].radius + line_.radius; }
  ContactLaw law_of(const LinePair& pair) const;
  bool is_listed(int element, const Listed& listed) const;
  template <class PositionOf>
  LinePiece piece(int element, const PositionOf& position_of) const;
  template <class PoseOf>
  Middles middles(const PoseOf& pose_of) const;
  Cloud cloud(const Middles& middles) const;
  /// Calls visit(element, margin_of(element)) of elements of the line that may be so near to a cloud [m].
  template <class PositionOf, class MarginOf, class Visit>
  void for_each_near(const Cloud& cloud, const PositionOf& position_of, const MarginOf& margin_of,
                     const Visit& visit) const;
  /// Of a point from a place of the line.
  template <class PositionOf>
  Vector3 offset(const Vector3& point, const ClosestPoint& place, const PositionOf& position_of) const;
  /// The nearest places of all pairs that are nearer than the radii and `margin`; others have no element.
  template <class PositionOf>
  Places closest(const Middles& middles, double margin, const PositionOf& position_of, const Listed& listed) const;
  /// Velocity of a pair's middle less that of a place of the line [m/s].
  Vector3 velocity(const LinePair& pair, const LineWeights& weights, int element, const ForceStep& step) const;
  double begin_rate(const LinePair& pair, const ClosestPoint& begin, const ForceStep& step) const;
  double foreseen(const LinePair& pair, const ClosestPoint& begin, const Vector3& middle, const ForceStep& step) const;
  /// A pair whose nearest places at both ends of the step are these.
  Acting acting(std::size_t index, const ClosestPoint& begin, const ClosestPoint& end, const ForceStep& step,
                const Listed& listed, bool with_slope) const;
  void add(const Acting& acting, ForceAction& action) const;
  void add_tangent(const Acting& acting, ForceAction& action) const;
  void add_push_at_end(const Acting& acting, ForceAction& action) const;
  /// Between both ends of a step, of a pair that touches at neither. `way`: no more is moved [m].
  bool passes_through(std::size_t index, const ClosestPoint& begin, const ClosestPoint& end, double way,
                      const ForceStep& step) const;
  /// Calls visit(pair, nearest place) of those that touch.
  template <class Visit>
  void for_each_touching(const State& state, const Visit& visit) const;

  std::vector<std::string> links_;
  ContactStations side_;
  ContactLine line_;
  std::vector<LinePair> pairs_;
  ContactLaw law_;
  double largest_radius_ = 0;  ///< of a station and the tube [m]
};

}  // namespace flexarm
