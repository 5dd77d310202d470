#pragma once
/// What a contact of bodies finds over a step: both sides, a station, a tilted rim, a segment along which it slides
/// (internal to contact/).

#include "contact/contact_element.h"

namespace flexarm {

/// Data of both sides over a step: means over the step, or values at its end, as the scheme requires. "Base" is the
/// node of the shapes. Rotation increments (turns) are tangent-scaled.
struct ContactElement::Frames {
  double weight;  // weight of the end in means
  NodePose base_begin, base_end;
  Matrix3 axes;  // axes of the shapes
  std::array<Vector3, ContactStation::kMostNodes> turns;
  Vector3 base_turn = Vector3::Zero();
};

/// A station over a step, in world axes.
struct ContactElement::Placed {
  Vector3 arm = Vector3::Zero(), end_arm = Vector3::Zero();  // from its only node; zero for a beam
  Vector3 base_arm, end_base_arm;                            // from the shapes' node
  Vector3 turn;                                              // rotation increment minus that of the shapes
};

/// A rim over a step. Its lowest point moves if it tilts. (docs/notes/contact.md 1.2)
struct ContactElement::Tilt {
  Vector3 axis, end_axis;      // of the rim, world axes, over the step and at the end
  Vector3 normal, end_normal;  // of the face, likewise
  RimLever lever;              // of the push, about `axis` x `normal`
  Matrix3 by_spin;             // of the offset at the end, all in the frame of the shapes

  /// Derivative of the end's cosine between axis and normal with respect to a spin of the rim, world axes.
  Eigen::RowVector3d cosine_by_spin() const { return end_axis.cross(end_normal).transpose(); }
};

/// A segment over a step. It touches at a point that is fixed to it over the step, near to the nearest ones of both
/// ends. By how much these are nearer is the excess. (docs/notes/contact.md 1.2)
struct ContactElement::Slide {
  bool is_away = false;    // no contact is possible in this step
  ContactStation station;  // that point
  double begin_excess = 0, end_excess = 0;
  Vector3 axis, begin_axis;  // of the segment at the end and at the beginning, in the shapes' frame
  // Derivatives of the excess at the end, and of the place along the segment, with respect to the point's position and
  // the segment's spin, in the frame of the shapes.
  Eigen::RowVector3d by_seen = Eigen::RowVector3d::Zero(), by_spin = by_seen;
  Eigen::RowVector3d along_by_seen = by_seen, along_by_spin = by_seen;
};

/// How the point that touches moves against the body. Null: it is no rim, no segment.
struct ContactElement::Moving {
  const Tilt* tilt;
  const Slide* slide;
};

}  // namespace flexarm
