#pragma once
/// Quantities that both forms of a slider's maps share.

#include <cassert>
#include <optional>

#include "joints/slide_map.h"
#include "joints/slide_variation.h"

namespace flexarm::slide {

using Complex = std::complex<double>;
/// Of complex steps: no cancellation, so as small as it likes.
constexpr double kComplexStep = 1e-30;

/// A line's nodes in one configuration.
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

/// Where a travel begins and ends: what it has at hand, or else found here.
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

/// What the forms of the incremental maps differ in.
struct ContactRule {
  double weight = 0.5;        ///< c, of the end of the step in the nodes' weights
  double arm_product = 0;     ///< a (1 - a), a: of the end in moment arms; where what the arms lack goes into moments
  bool is_in_middle = false;  ///< the contact holds in the middle of the step only
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

/// Sizes the maps for the nodes between two pieces and forgets what they were, but for `moment_master`, whose blocks
/// are all set where there is a tangent.
void set_active(const SlideLine& line, int piece, int other_piece, bool with_tangent, SlideMaps& maps);

}  // namespace flexarm::slide
