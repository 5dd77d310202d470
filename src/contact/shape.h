#pragma once
/// Rigid shapes for contact: distances of points from them, their faces, and the points with which they touch others.

#include <memory>
#include <variant>
#include <vector>

#include "contact/polytope.h"
#include "contact/rim.h"

namespace flexarm {

/// The signed distance of a point from a surface (< 0 inside) [m], with its first and second derivatives with respect
/// to the point. The gradient is the outward unit normal. On edges, on axes and in centres it is one of the possible
/// normals.
struct SignedDistance {
  double value = 0;
  Vector3 gradient = Vector3::UnitZ();
  Matrix3 hessian = Matrix3::Zero();
};

// Shapes in their own frames:

struct HalfSpace {};  ///< z < 0
struct Ball {
  double radius = 0;  ///< [m]
};
struct Box {
  Vector3 half = Vector3::Zero();  ///< half edge lengths [m]
};
/// A cylinder with its axis along z.
struct Cylinder {
  double radius = 0, half_length = 0;  ///< [m]
};

/// A tube with its axis along z.
struct Tube {
  double radius = 0, inner_radius = 0, half_length = 0;  ///< [m]
};

/// The convex hull of a mesh.
struct Hull {
  std::shared_ptr<const Polytope> polytope;
};

/// A shape fixed to a node, or to the world.
struct ContactShape {
  std::variant<HalfSpace, Ball, Box, Cylinder, Hull, Tube> kind;
  Pose place;              ///< in the node's frame
  bool is_hollow = false;  ///< inverted: the shape is a hole, and everything around it is solid; has no faces

  /// `point`: in the node's frame [m].
  SignedDistance distance(const Vector3& point) const;
  /// Returns a lower bound of the signed distance [m]. Inside the shape it is exact; outside it is exact except beside
  /// the faces of a hull.
  double gap(const Vector3& point) const;
};

/// Whether a shape has faces: boxes, cylinders and hulls have. They are numbered from 1: of a box +x, -x, +y, -y, +z,
/// -z; of a cylinder its side, +z, -z; 0 means no face. A corner that has entered by a face is pushed out by that face,
/// however near other faces are. This matters if equal boxes lie on each other, since then corners are at edges.
bool has_faces(const ContactShape& shape);
/// Returns the face by which a point enters that moves straight from outside to another place; 0 if it does not enter.
int entered_face(const ContactShape& shape, const Vector3& from, const Vector3& to);
/// Returns the face with the largest signed distance from the point, which is the nearest one if the point is inside.
int nearest_face(const ContactShape& shape, const Vector3& point);
/// Returns the nearest face other than `crossed` that a corner or an edge at `point` can lie on, at most `deepest` away
/// [m]; 0 if there is none. `outwards`: normals of the other body's faces that meet in the corner or edge, in the frame
/// of this shape's node.
int face_to_lie_on(const ContactShape& shape, int crossed, const Vector3& point, const Matrix3& outwards,
                   double deepest);
/// Whether a corner or an edge can lie on a face: the normals of the other body's faces there (`outwards`) point
/// towards this face, so the other body is outside of it.
bool can_lie_on(const ContactShape& shape, int face, const Matrix3& outwards);
/// Whether the projection of a point onto a face lies in the face.
bool is_over_face(const ContactShape& shape, int face, const Vector3& point);
/// Returns the shape that the face would bound if there were no other faces: a half-space, or an infinite cylinder.
ContactShape beyond_face(const ContactShape& shape, int face);

/// Returns the face whose plane is farthest below the lowest point of a rim over it; 0 for a half-space.
int face_below(const ContactShape& shape, const Rim& rim);
/// Returns the unit normal of a flat face, or of a half-space (face 0), outwards.
Vector3 face_normal(const ContactShape& shape, int face);
/// Whether the shape has flat faces only, or is a half-space.
bool is_flat(const ContactShape& shape);

/// Returns the radius of a ball about the shape's origin that contains the shape [m]; infinity for a half-space.
double bounding_radius(const ContactShape& shape);
/// Returns half of the shape's smallest width [m]; infinity for a half-space.
double half_width(const ContactShape& shape);

/// A ball, fixed to a node, with which a shape touches others. Its radius is 0 for corners and points on edges.
struct ContactPoint {
  Vector3 arm = Vector3::Zero();       ///< the ball's middle in the node's frame [m]
  double radius = 0;                   ///< [m]
  Matrix3 outwards = Matrix3::Zero();  ///< columns: normals of the faces that meet there, in the node's frame
  double share = 1;                    ///< of the stiffness of a point
  double rim = 0;                      ///< > 0: the radius of a rim, of which the lowest point touches [m]
  double half = 0;                     ///< > 0: half the length of a segment, of which the nearest point touches [m]
  double curvature = 0;                ///< of the surface along the segment [1/m]
  Vector3 axis = Vector3::UnitZ();     ///< of the rim or segment, in the node's frame
};
/// Returns the contact points of a shape. A ball: itself. A box or hull: its corners, and points on its edges about
/// `spacing` apart [m], at most kMostEdgePoints on each; on longer edges also a segment, rounded by kRoundEdge of the
/// smallest half width. A cylinder: kRimPoints on each rim; if it is longer than wide,
/// also balls along its axis that fill it, and a segment. A tube: as a cylinder, but
/// nothing along its axis, and points on the inner rims for round shapes. A half-space or a hole: none. `on_flat`: they
/// touch flat faces only. Then a cylinder has its rims, and the points carry only a face that lies flat: they are drawn
/// in by kDrawnIn of the radius. They have that part of the stiffness with which the face resists spinning as under a
/// uniform pressure.
std::vector<ContactPoint> contact_points(const ContactShape& shape, double spacing, bool on_flat);
constexpr int kRimPoints = 24, kMostEdgePoints = 7;
constexpr double kDrawnIn = 0.01, kRoundEdge = 0.1;
/// The sides of cylinders, and edges, are lower at their ends than in the middle by half of this part of their radius.
constexpr double kBarrel = 1e-3, kBentEdge = 0.5;
/// So that a segment does not touch where faces lie on each other, it is sunk by this, relative to its radius.
constexpr double kSunkEdge = 0.2;
/// Returns how many of these points touch a plane on which the shape lies: the largest number on one flat face; 1 if
/// the shape has no faces.
int points_at_a_time(const ContactShape& shape, const std::vector<ContactPoint>& points);

}  // namespace flexarm
