#pragma once
/// Internals that slide_map.cpp and slide_increment.cpp share.

#include <cassert>
#include <optional>

#include "joints/slide_map.h"
#include "joints/slide_variation.h"

namespace flexarm::slide {

using Complex = std::complex<double>;
/// Length of complex steps. There is no cancellation, so it can be tiny.
constexpr double kComplexStep = 1e-30;

/// Gives the poses of a line's nodes in one configuration.
struct LineNodes {
  const SlideLine& line;
  const std::vector<NodePose>& nodes;  ///< of the model

  PoseT<double> operator()(int i) const {
    assert(i >= 0 && static_cast<std::size_t>(i) < line.nodes.size());
    assert(static_cast<std::size_t>(line.nodes[i]) < nodes.size() && "poses of all nodes of the model");
    const NodePose& node = nodes[line.nodes[i]];
    return {node.position, node.orientation};
  }
};

/// The same for sections at complex arc lengths.
struct ComplexLineNodes {
  const SlideLine& line;
  const std::vector<NodePose>& nodes;

  PoseT<Complex> operator()(int i) const {
    const NodePose& node = nodes[line.nodes[i]];
    return {node.position.cast<Complex>(), node.orientation.cast<Complex>()};
  }
};

/// The places where a travel begins and ends: those that the travel has, or else computed here.
class TravelPlaces {
 public:
  explicit TravelPlaces(const SlideTravel& travel)
      : begin_(travel.begin_place ? travel.begin_place
                                  : &found_begin_.emplace(slide_place(travel.line, travel.begin, travel.from))),
        end_(travel.end_place ? travel.end_place
                              : &found_end_.emplace(slide_place(travel.line, travel.end, travel.to))) {}
  TravelPlaces(const TravelPlaces&) = delete;
  TravelPlaces& operator=(const TravelPlaces&) = delete;

  const Place& begin() const { return *begin_; }
  const Place& end() const { return *end_; }

 private:
  std::optional<Place> found_begin_, found_end_;
  const Place *begin_, *end_;
};

/// The parameters in which the forms of the incremental maps differ.
struct ContactRule {
  double weight = 0.5;        ///< c: weight of the end of the step in the nodes' weights
  double arm_product = 0;     ///< SmEm: a (1 - a), with the weight a of the end in moment arms; else 0
  bool is_in_middle = false;  ///< the contact holds only in the middle of the step
};

inline ContactRule contact_rule(SlideStep step, double arm_weight) {
  switch (step) {
    case SlideStep::MidContact:
      return {0.5, 0, true};
    case SlideStep::EndContact:
      return {0.5, 0, false};
    case SlideStep::EnterMid:
      return {1.0, 0, true};
    case SlideStep::EnterEnd:
      return {1.0, 0, false};
    case SlideStep::BeginWeights:
      return {0.0, 0, false};
    case SlideStep::SmEm:
      break;
  }
  return {arm_weight, arm_weight * (1 - arm_weight), false};
}

/// Resizes the maps for the nodes of two pieces and those between them, and sets them to zero. `moment_master` is only
/// resized, since every tangent sets all of its blocks.
void set_active(const SlideLine& line, int piece, int other_piece, bool with_tangent, SlideMaps& maps);

}  // namespace flexarm::slide
