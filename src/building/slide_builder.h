#pragma once
/// Lines on which something slides, and the sections that slide on them (internal to building/).

#include <vector>

#include "building/mechanism.h"

namespace flexarm {

class SlideBuilder {
 public:
  /// The plan and the mechanism must outlive it.
  SlideBuilder(const ScenePlan& plan, Mechanism& mechanism)
      : plan_(plan), mechanism_(mechanism), model_(mechanism.model) {}

  /// Adds the section that slides along the parent's line; what the joint moves hangs on it.
  /// @throws ModelError
  Attachment add(const scene::JointDescription& joint);
  /// Lets the arc length of the slide made last follow the angle of its joint, both added last.
  void couple(const scene::JointDescription& joint);

 private:
  /// The smooth stretch that contains where a slide on a flexible link starts, over beams welded to it; made once.
  /// Arc lengths count from the link's origin, and are negative before it.
  int slide_line(int link, const scene::SlideDescription& slide);
  int add_line(const SlideLine& line);
  /// True where the section of node `after` is that of node `before` in place and direction.
  bool continues(int before, int after) const;
  /// The links whose beams are fixed tip to origin without a kink, one of them `link`, in order.
  std::vector<int> welded_beams(int link) const;

  const ScenePlan& plan_;
  Mechanism& mechanism_;
  Model& model_;
};

}  // namespace flexarm
