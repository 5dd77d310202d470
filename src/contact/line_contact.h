#pragma once
/// Contact of what one body has to touch with, or an element of a beam, and a beam's smooth line: a force element.

#include "contact/line_forces.h"
#include "contact/line_search.h"

namespace flexarm {

/// Each pair: the ball of the station with what is nearest of its part of the line. Where the nearest place goes from
/// one element of the line to the next, nothing else changes.
class LineContact : public ForceElement {
 public:
  /// `links`: names of the link with the stations, and of the one with the line; `is_reversed`: the other way round.
  /// `crossing`: by how much stiffer than alongside a beam's stations are where the lines cross at right angles, see
  /// docs/notes/contact.md 6.
  LineContact(std::vector<std::string> links, LineTouch touch, const ContactLaw& law, double crossing = 0,
              bool is_reversed = false);

  const char* kind() const override { return "contact"; }
  std::vector<std::string> links() const override { return links_; }
  int most_nodes() const override { return search_.most_nodes(); }
  /// Of the stations, and of those elements of the line that are near, nearest first where there are many.
  int find_nodes(const ForceStart& start, int* nodes) const override { return search_.find_nodes(start, nodes); }
  ForceRoom room(const ForceStart& start) const override { return search_.room(start); }
  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  bool needs_halves(const ForceStep& step, const int* nodes, int count) const override;
  bool hits() const override { return true; }
  double energy(const State& state, const double* memory) const override;
  ForceMeasures measures(const State& state, const int* nodes) const override;
  DamperTensions dampers(const State& state, const Eigen::VectorXd& rates) const override;
  int memory_size() const override { return LineMemory::kSize * static_cast<int>(search_.pairs().size()); }
  void start(const State& state, double* memory) const override;
  double touch(const ForceMotion& motion, const TouchingPointTaker& take) const override;
  /// Alongside, not where lines cross.
  TouchLaw touch_law() const override {
    return {search_.pairs().size(), law_of(search_.pairs()[0], 0).stiffness, law_.restitution, law_.friction};
  }
  bool suits_all_schemes() const override { return false; }

  /// Deepest penetration of all pairs; 0: none touches [m].
  double deepest(const std::vector<NodePose>& poses) const;

 private:
  /// Of one pair. `stiffening`: as it is remembered; 0: it has not touched until now.
  ContactLaw law_of(const LinePair& pair, double stiffening) const;
  /// Of a pair that begins to touch at a place.
  double stiffening(const LinePair& pair, const ClosestPoint& place, const NodePlaces& places) const;
  /// Velocity of a pair's middle less that of a place of the line [m/s].
  Vector3 velocity(const LinePair& pair, const LineWeights& weights, int element, const NodePlaces& places,
                   const std::vector<Vector6>& velocities) const;
  double rate(const LinePair& pair, const ClosestPoint& place, const NodePlaces& places,
              const std::vector<Vector6>& velocities) const;
  double foreseen(const LinePair& pair, const ClosestPoint& begin, const ForceStep& step) const;
  /// A pair whose nearest places at both ends of the step are these.
  LineActing acting(std::size_t index, const ClosestPoint& begin, const ClosestPoint& end, const ForceStep& step,
                    const ListedNodes& listed, bool with_slope) const;
  /// Calls visit(pair, nearest place) of those that touch.
  template <class Visit>
  void for_each_touching(const NodePlaces& now, const Visit& visit) const;

  std::vector<std::string> links_;
  LineSearch search_;
  ContactLaw law_;
  double crossing_;
  bool is_reversed_;
};

}  // namespace flexarm
