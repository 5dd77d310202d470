#pragma once
/// Rigid shapes that may be touched: how far points are from them.

#include <memory>
#include <variant>
#include <vector>

#include "contact/polytope.h"

namespace flexarm {

/// Of a point from a surface [m], < 0 inside, with its first and second derivative by the point. The gradient is the
/// unit normal, outwards; on edges, on axes and in centres one of those that there are.
struct SignedDistance {
  double value = 0;
  Vector3 gradient = Vector3::UnitZ();
  Matrix3 hessian = Matrix3::Zero();
};

/// Shapes in their own frames.
struct HalfSpace {};  ///< below z = 0
struct Ball {
  double radius = 0;  ///< [m]
};
struct Box {
  Vector3 half = Vector3::Zero();  ///< [m]
};
/// Along z.
struct Cylinder {
  double radius = 0, half_length = 0;  ///< [m]
};

/// The convex hull of a mesh.
struct Hull {
  std::shared_ptr<const Polytope> polytope;
};

/// A shape fixed to a node, or to the world.
struct ContactShape {
  std::variant<HalfSpace, Ball, Box, Cylinder, Hull> kind;
  Pose place;              ///< in the node's frame
  bool is_hollow = false;  ///< turned inside out: all but the shape is solid, which is a hole without faces

  /// `point`: in the node's frame [m].
  SignedDistance distance(const Vector3& point) const;
  /// Nothing of the surface is nearer [m]. Inside it is the distance, and of shapes without edges outside as well.
  double gap(const Vector3& point) const;
};

/// Faces of boxes, cylinders and hulls have numbers from 1 on: of a box +x, -x, +y, -y, +z, -z; of a cylinder its side,
/// +z, -z; 0: none. A corner that has come in by a face is pushed out by it, however near others are: corners of equal
/// boxes on each other lie on edges.
bool has_faces(const ContactShape& shape);
/// By which a point comes in that goes straight from outside to another place; 0: it does not.
int entered_face(const ContactShape& shape, const Vector3& from, const Vector3& to);
int nearest_face(const ContactShape& shape, const Vector3& point);
/// That one of the faces besides `crossed` which a corner or an edge at `point` can lie on, no farther from it than
/// `deepest` [m], the nearest of them; 0: none. `outwards`: normals of the other body's faces that meet there, in this
/// one's node's frame.
int face_to_lie_on(const ContactShape& shape, int crossed, const Vector3& point, const Matrix3& outwards,
                   double deepest);
/// Whether a corner or an edge can lie on a face: what is pushed out by it is on the other body's side of it.
bool can_lie_on(const ContactShape& shape, int face, const Matrix3& outwards);
/// Whether a point lies above or below a face, not beside it.
bool is_over_face(const ContactShape& shape, int face, const Vector3& point);
/// What a face bounds, as if there were no others: a half-space, or an endless cylinder.
ContactShape beyond_face(const ContactShape& shape, int face);

/// Half of the least width [m]; infinite of a half-space.
double half_width(const ContactShape& shape);

/// A ball around a point fixed to a node by which a shape touches others: a corner, or the centre of a round one.
struct ContactPoint {
  Vector3 arm = Vector3::Zero();       ///< in the node's frame [m]
  double radius = 0;                   ///< [m]
  Matrix3 outwards = Matrix3::Zero();  ///< columns: normals of the faces that meet there, in the node's frame
};
/// Those of a shape: a ball's middle; corners of a box or a hull, and points on their edges not much farther from each
/// other than `spacing` [m]; `kRimPoints` on each rim of a cylinder, and balls along its axis that fill it, if it is
/// longer than wide. None of a half-space or a hole, which touch nothing themselves.
std::vector<ContactPoint> contact_points(const ContactShape& shape, double spacing);
constexpr int kRimPoints = 24, kMostEdgePoints = 7;
/// How many of these points of a shape touch a plane at a time that it lies on: those of the flat face that has most of
/// them; without faces 1.
int points_at_a_time(const ContactShape& shape, const std::vector<ContactPoint>& points);

}  // namespace flexarm
