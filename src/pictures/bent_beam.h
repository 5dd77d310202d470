#pragma once
/// The shape of a beam of which only the ends are known.

#include <vector>

#include "flexarm/math/pose.h"
#include "pictures/picture.h"

namespace flexarm::pictures {

/// Where the end of a beam is, in the link's frame. The orientation turns the undeformed link's axes.
struct BeamEnd {
  Pose pose;
  bool has_orientation = true;
};

/// The sections of a beam whose root stays in the link's frame, in that frame. The line differs from the undeformed one
/// by a cubic of the arc length: what bends a straight beam with a force and a moment at its end, if it bends by
/// little. Without an orientation of the end there is no moment.
std::vector<Pose> bent_sections(const PictureBeam& beam, const BeamEnd& end);

}  // namespace flexarm::pictures
