#pragma once
/// Builds lines on which something slides, and the sections that slide on them (internal to building/).

#include <vector>

#include "building/mechanism.h"

namespace flexarm {

class SlideBuilder {
 public:
  /// `plan` and `mechanism` must outlive this object.
  SlideBuilder(const ScenePlan& plan, Mechanism& mechanism)
      : plan_(plan), mechanism_(mechanism), model_(mechanism.model) {}

  /// Adds the section that slides along the parent's line. Returns the frame to which the moved links attach.
  /// @throws ModelError
  Attachment add(const scene::JointDescription& joint);
  /// Makes the arc length of the last slide follow the angle of its joint. The two coordinates must be the last ones.
  void couple(const scene::JointDescription& joint);

 private:
  /// Index of the smooth line on which a slide starts; it may go over beams that are welded to the link. Each line is
  /// made once. Arc lengths count from the link's origin, and are negative before it.
  int slide_line(int link, const scene::SlideDescription& slide);
  int add_line(const SlideLine& line);
  /// Whether the section of node `after` continues that of node `before`, in place and direction.
  bool continues(int before, int after) const;
  /// The links, `link` among them, whose beams are fixed to each other from tip to origin without a kink, in order.
  std::vector<int> welded_beams(int link) const;

  const ScenePlan& plan_;
  Mechanism& mechanism_;
  Model& model_;
};

}  // namespace flexarm
