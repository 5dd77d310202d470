#pragma once
/// The axis of a long cylinder, with which its side touches other shapes at the nearest point. (docs/notes/contact.md
/// 1.2)

#include "contact/shape.h"

namespace flexarm {

/// A segment. Its middle and its axis, a unit vector, are in the frame of the shape's node.
struct Segment {
  Vector3 middle, axis;
  double half;       ///< half of its length [m]
  double curvature;  ///< of the surface along it, see NearestOnSegment [1/m]

  Vector3 at(double along) const { return middle + along * axis; }
};

/// The point of a segment that is nearest to a shape. The surface about the segment is curved a little, like a
/// barrel's. So there is one nearest point also where the segment is parallel to a surface.
struct NearestOnSegment {
  double along = 0;     ///< from the middle [m]
  double rise = 0;      ///< by how much the surface is lower there than in the middle [m]
  double distance = 0;  ///< of the point from the shape, plus `rise` [m]
  bool is_end = false;
};
/// The shape is convex.
NearestOnSegment nearest_on(const Segment& segment, const ContactShape& shape);

}  // namespace flexarm
