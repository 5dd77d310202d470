#pragma once
/// The force element of contact between the contact points of a body, or of a beam element, and the line of a beam.

#include "contact/line_forces.h"
#include "contact/line_search.h"

namespace flexarm {

/// Contact of balls with a tube around the line. In each pair, the ball of a station touches the nearest place of its
/// part of the line. The nearest place may move from one element of the line to the next without any jump.
class LineContact : public ForceElement {
 public:
  /// `links`: names of the two sides. The first has the stations and the second the line, unless `is_reversed`.
  /// `crossing`: for the stations of a beam, determines how much stiffer they are if the lines cross than if they are
  /// parallel: by the factor sqrt(1 + crossing^2 sin^2(angle)), see docs/notes/contact.md 6; 0: not stiffer.
  LineContact(std::vector<std::string> links, LineTouch touch, const ContactLaw& law, double crossing = 0,
              bool is_reversed = false);

  const char* kind() const override { return "contact"; }
  std::vector<std::string> links() const override { return links_; }
  int most_nodes() const override { return search_.most_nodes(); }
  /// See LineSearch::find_nodes().
  int find_nodes(const ForceStart& start, int* nodes) const override { return search_.find_nodes(start, nodes); }
  ForceRoom room(const ForceStart& start) const override { return search_.room(start); }
  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  bool needs_halves(const ForceStep& step, const int* nodes, int count) const override;
  void put_penetrations(const ForceStep& step, const int* nodes, int count,
                        const PenetrationTaker& take) const override;
  bool hits() const override { return true; }
  double energy(const State& state, const double* memory) const override;
  ForceMeasures measures(const State& state, const double* memory, const int* nodes) const override;
  DamperTensions dampers(const State& state, const double* memory, const Eigen::VectorXd& rates) const override;
  int memory_size() const override { return LineMemory::kSize * static_cast<int>(search_.pairs().size()); }
  void start(const State& state, const double* functions, double* memory) const override;
  double touch(const ForceMotion& motion, const TouchingPointTaker& take) const override;
  /// The law for parallel lines.
  TouchLaw touch_law() const override {
    return {search_.pairs().size(),
            law_of(search_.pairs()[0], 0).stiffness,
            law_.restitution.of_slow_hits(),
            law_.friction,
            0,
            0,
            law_.restitution.of_fast_hits()};
  }
  bool suits_all_schemes() const override { return false; }

  /// Returns the deepest penetration of all pairs; 0 if none touches [m].
  double deepest(const std::vector<NodePose>& poses) const;

 private:
  struct Passage;
  template <class Visit>
  void for_each_passage(const ForceStep& step, const Visit& visit) const;
  /// Returns the law of one pair. `stiffening`: see LineMemory::stiffening.
  ContactLaw law_of(const LinePair& pair, double stiffening) const;
  /// Returns the stiffening of a pair that begins to touch at a place.
  double stiffening(const LinePair& pair, const ClosestPoint& place, const NodePlaces& places) const;
  /// Returns the velocity of a station's middle minus that of a place of the line [m/s].
  Vector3 velocity(const LinePair& pair, const LineWeights& weights, int element, const NodePlaces& places,
                   const std::vector<Vector6>& velocities) const;
  double rate(const LinePair& pair, const ClosestPoint& place, const NodePlaces& places,
              const std::vector<Vector6>& velocities) const;
  double foreseen(const LinePair& pair, const ClosestPoint& begin, const ForceStep& step) const;
  /// Computes the forces of a pair with these nearest places at the beginning and the end of the step.
  LineActing acting(std::size_t index, const ClosestPoint& begin, const ClosestPoint& end, const ForceStep& step,
                    const ListedNodes& listed, bool with_slope) const;
  /// Returns the nodes on which the element acts in small motions.
  std::vector<int> nodes_at(const State& state) const;
  /// Calls visit(pair, nearest place, vector from this place to the station's middle) for each pair that touches with
  /// listed nodes.
  template <class Visit>
  void for_each_touching(const NodePlaces& now, const ListedNodes& listed, const Visit& visit) const;

  std::vector<std::string> links_;
  LineSearch search_;
  ContactLaw law_;
  double crossing_;
  bool is_reversed_;
};

}  // namespace flexarm
