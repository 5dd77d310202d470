#include "building/passes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "building/contact_laws.h"
#include "building/model_builder.h"

namespace flexarm {
namespace {

/// Length of a pin or a block if the scene gives none: in plays, or in radii of the pin. Fits of machines have
/// diameters of some 1000 plays, and bearings are about as long as their diameters.
constexpr double kLengthInPlays = 1000, kLengthInRadii = 2;

class Clearance final : public ContactElement {
 public:
  using ContactElement::ContactElement;
  const char* kind() const override { return "clearance"; }
};

/// A pin, ball or block on the child, and the hole in the parent, in frames at the joint with z along its axis.
struct Fit {
  std::vector<Vector3> points;
  std::vector<ContactShape> holes;
  double at_a_time = 1;  ///< number of points that are pressed across the axis if nothing tilts
};

/// The half-space beyond a wall, with a normal that points back.
ContactShape wall(const Vector3& direction, double distance) {
  ContactShape out;
  out.kind = HalfSpace{};
  out.place = {distance * direction, Quaternion::FromTwoVectors(Vector3::UnitZ(), -direction)};
  return out;
}

template <class Shape>
ContactShape hole(const Shape& shape) {
  ContactShape out;
  out.kind = shape;
  out.is_hollow = true;
  return out;
}

Fit fit_of(const scene::ClearanceDescription& clearance) {
  const double play = clearance.radius, in_plays = kLengthInPlays * play;
  const double length =
      clearance.length.value_or(clearance.journal > 0 ? kLengthInRadii * clearance.journal : in_plays);
  const double reach = clearance.journal + play;
  const Vector3 z = Vector3::UnitZ();
  Fit fit;
  if (clearance.joint.kind == scene::JointKind::Spherical) {
    fit.points = {Vector3::Zero()};
    fit.holes.push_back(hole(Ball{reach}));
  } else if (clearance.joint.kind == scene::JointKind::Prismatic) {
    const double across = 0.5 * clearance.width.value_or(length);
    for (int k = 0; k < 8; ++k)
      fit.points.emplace_back(k & 1 ? across : -across, k & 2 ? across : -across, (k & 4 ? 0.5 : -0.5) * length);
    for (const int axis : {0, 1})
      for (const double side : {-1.0, 1.0}) fit.holes.push_back(wall(side * Vector3::Unit(axis), across + play));
    fit.at_a_time = 4;
  } else {
    fit.points = {0.5 * length * z, -0.5 * length * z};
    fit.holes = {hole(Cylinder{reach, std::numeric_limits<double>::infinity()}), wall(z, 0.5 * length + reach),
                 wall(-z, 0.5 * length + reach)};
    fit.at_a_time = 2;
  }
  return fit;
}

/// Rotation of z to an axis, and of x to an axis of the frame if there is one normal to it.
Quaternion axes_along(const Vector3& axis) {
  const Vector3 guess = std::abs(axis.x()) < 0.9 ? Vector3::UnitX() : Vector3::UnitY();
  Matrix3 axes;
  axes.col(0) = (guess - guess.dot(axis) * axis).normalized();
  axes.col(1) = axis.cross(axes.col(0));
  axes.col(2) = axis;
  return Quaternion(axes).normalized();
}

class ClearanceBuilder {
 public:
  ClearanceBuilder(const ScenePlan& plan, const Model& model) : plan_(plan), model_(model) {}

  std::shared_ptr<const ForceElement> place(const scene::ClearanceDescription& clearance) const {
    const scene::JointDescription& joint = clearance.joint;
    const Attachment bearing = frame_of(joint.parent, joint.origin, joint.axis);
    Attachment pin = frame_of(joint.child, joint.child_origin, joint.axis);
    // If the joint closes a loop, its position 0 is the relative pose of its links at the start.
    if (clearance.closes_loop)
      pin.offset.orientation =
          pose_of(pin.node).orientation.conjugate() * pose_of(bearing.node).orientation * bearing.offset.orientation;
    const std::string where = at(clearance.location, "<clearance> of joint '" + joint.name + "'");
    if (pin.node == bearing.node) throw ModelError(where + "both links belong to the same rigid body");
    const Fit fit = fit_of(clearance);
    ContactStations stations{{pin.node}, {}};
    for (const Vector3& point : fit.points) {
      ContactStation station;
      station.arm = pin.offset * point;
      station.radius = clearance.journal;
      stations.stations.push_back(station);
    }
    ContactSurface surface{bearing.node, fit.holes};
    for (ContactShape& shape : surface.shapes) shape.place = bearing.offset * shape.place;
    const double inside = deepest_start(model_, stations, surface);
    if (inside > clearance.radius)
      throw ModelError(fmt::format("{}penetrates by {:.6g} m at the start; expected at most its play, {:.6g} m", where,
                                   inside, clearance.radius));
    return std::make_shared<Clearance>(std::vector{joint.child, joint.parent}, stations, surface,
                                       law_of(clearance, fit.at_a_time, inside), false, joint.name);
  }

 private:
  Attachment frame_of(const std::string& link, const Pose& origin, const Vector3& axis) const {
    Attachment frame = attachment(plan_, model_, link, origin.position);
    frame.offset = frame.offset * origin * Pose{Vector3::Zero(), axes_along(axis.normalized())};
    return frame;
  }

  NodePose pose_of(int node) const { return node < 0 ? NodePose() : model_.nodes[node]; }

  /// Mass of a link's body; of a beam, the mass of the whole beam [kg].
  double mass_of_link(const std::string& name) const {
    const LinkFrame& link = model_.links[plan_.links[name]];
    return link.beam ? link.beam->mass : mass_of_body(model_, link.frame.node);
  }

  ContactLaw law_of(const scene::ClearanceDescription& clearance, double at_a_time, double inside) const {
    LawRequest request{1 / (1 / mass_of_link(clearance.joint.parent) + 1 / mass_of_link(clearance.joint.child)),
                       at_a_time, clearance.contact_time.value_or(plan_.scene.contact_time), clearance.stiffness};
    request.restitution = clearance.restitution;
    request.friction = clearance.friction;
    ContactLaw law = law_of_points(request);
    // A stiffness by the contact time may be soft, so the depth keeps it from giving way by more than the
    // play. A given stiffness is the law.
    if (!clearance.stiffness) law.depth = clearance.radius;
    allow_start(law, clearance.stiffness ? 0 : inside);
    return law;
  }

  const ScenePlan& plan_;
  const Model& model_;
};

}  // namespace

ForceElementList place_clearances(const ScenePlan& plan, const Model& model) {
  ForceElementList placed;
  for (const scene::ClearanceDescription& clearance : plan.scene.clearances)
    placed.push_back(ClearanceBuilder(plan, model).place(clearance));
  return placed;
}

}  // namespace flexarm
