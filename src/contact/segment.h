#pragma once
/// The axis of a long cylinder, with which its side touches other shapes at the nearest point. (docs/notes/contact.md
/// 1.2)

#include "contact/shape.h"

namespace flexarm {

/// A segment. Its middle and its axis, a unit vector, are in the frame of the shape's node.
struct Segment {
  Vector3 middle, axis;
  double half;  ///< half of its length [m]

  Vector3 at(double along) const { return middle + along * axis; }
};

/// The surface about the segment is lower at its ends than in the middle by half of this part of its radius. So there
/// is one nearest point also where the segment is parallel to a surface.
constexpr double kBarrel = 1e-3;

/// The point of a segment that is nearest to a shape.
struct NearestOnSegment {
  double along = 0;     ///< from the middle [m]
  double rise = 0;      ///< by how much the surface about the segment is lower there [m]
  double distance = 0;  ///< of the point from the shape, plus `rise` [m]
  bool is_end = false;
};
/// `radius`: of the surface about the segment [m]. The shape is convex.
NearestOnSegment nearest_on(const Segment& segment, double radius, const ContactShape& shape);

}  // namespace flexarm
