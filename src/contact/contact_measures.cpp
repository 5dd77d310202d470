// What a contact starts with, stores, tells, and is in small motions.
#include <algorithm>
#include <cassert>
#include <limits>

#include "contact/contact_element.h"
#include "joints/penetration.h"
#include "model/state.h"

namespace flexarm {
void ContactElement::start(const State& state, const double*, double* memory) const {
  const SeenStations seen = this->seen(poses_in(state));
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    const int face = seen.face(station, shape, 0);
    const StationPlace place = seen.place(station, shape, face);
    put(start_inside(shape, law_, station.radius - place.rise, place.point(), seen.outwards(station), face), memory);
    memory += PointMemory::kSize;
    return true;
  });
}

double ContactElement::energy(const State& state, const double* memory) const {
  double energy = 0;
  const SeenStations seen = this->seen(poses_in(state));
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    energy += stored_energy(station, shape, memory_at(memory), seen);
    memory += PointMemory::kSize;
    return true;
  });
  return energy;
}

double ContactElement::touch(const ForceMotion& motion, const TouchingPointTaker& take) const {
  const auto pose_of = poses_in(motion.state);
  const NodePose body = pose_of(surface_.node);
  const SeenStations seen = this->seen(pose_of);
  const StationVelocities velocities(side_, surface_, pose_of, motion.velocities);
  const double sign = is_reversed_ ? -1 : 1;
  const double* memory = motion.memory;
  double least = std::numeric_limits<double>::infinity();
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    PointMemory old = memory_at(memory);
    memory += PointMemory::kSize;
    const StationPlace place = seen.place(station, shape, seen.face(station, shape, old.face));
    const double radius = station.radius - place.rise;
    if (place.face != 0) {
      if (!is_over_face(shape, place.face, place.point())) return true;
      old.face = place.face;
    }
    if (old.face == 0) {
      const double gap = shape.distance(place.point()).value - radius;
      least = std::min(least, gap);
      if (gap >= 0) return true;
    }
    const PointTouch local =
        point_touch(shape, law_of(station), radius, place.point(), velocities.at(station, place), old);
    least = std::min(least, local.gap);
    if (local.gap >= 0) return true;
    TouchingPoint point;
    point.position = body.position + body.rotation * (place.point() - station.radius * local.normal);
    point.normal = sign * (body.rotation * local.normal);
    point.push = local.push * point.normal;
    point.friction = sign * (body.rotation * local.friction);
    point.couple = sign * (body.rotation * local.couple);
    if (station.rim > 0)
      point.couple += sign * local.push * (body.rotation * couple_beside(seen.rim(station), local.normal));
    point.gap = local.gap;
    take(point);
    return true;
  });
  return least;
}

template <class Visit>
void ContactElement::for_each_touching(const State& state, const double* memory, const Visit& visit) const {
  const SeenStations seen = this->seen(poses_in(state));
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    const StationPlace place = seen.place(station, shape, seen.face(station, shape, memory_at(memory).face));
    memory += PointMemory::kSize;
    const bool by_face = place.face != 0 && is_over_face(shape, place.face, place.point());
    const SignedDistance distance = (by_face ? beyond_face(shape, place.face) : shape).distance(place.point());
    if (distance.value < station.radius - place.rise) visit(station, place, distance);
    return true;
  });
}

int ContactElement::measures_each() const {
  return 1 + (law_.friction > 0 ? 2 : 0) + (law_.spinning > 0 ? 1 : 0) + (law_.rolling > 0 ? 2 : 0);
}

ForceMeasures ContactElement::measures(const State& state, const double* memory, const int*) const {
  Eigen::Index count = 0;
  for_each_touching(state, memory, [&](const ContactStation&, const StationPlace&, const SignedDistance&) {
    count += measures_each();
  });
  const Eigen::Index columns = 6 * static_cast<Eigen::Index>(reach().size());
  ForceMeasures out{Eigen::MatrixXd::Zero(count, columns), Eigen::MatrixXd::Zero(count, count)};
  const NodePose base = poses_in(state)(surface_.node);
  Eigen::Index row = 0;
  for_each_touching(
      state, memory, [&](const ContactStation& station, const StationPlace& seen, const SignedDistance& distance) {
        const ContactLaw law = law_of(station);
        const Vector3 normal = base.rotation * distance.gradient;
        const Vector3 place = base.rotation * seen.middle;  // from the shapes' node
        const Vector3 across = normal.unitOrthogonal(), third = normal.cross(across);
        // Adds a measure: the relative displacement along an axis, at a point `offset` from the station's middle.
        const auto add = [&](const Vector3& axis, const Vector3& offset, double stiffness) {
          for (int i = 0; i < moving_nodes(); ++i) {
            const Vector3 arm = poses_in(state)(side_.nodes[i]).rotation * station.arm + offset;
            out.rows.block<1, 6>(row, 6 * i) << station.weights[i] * axis.transpose(),
                station.weights[i] * arm.cross(axis).transpose();
          }
          if (surface_.node >= 0)
            out.rows.block<1, 6>(row, columns - 6) << -axis.transpose(), -(place + offset).cross(axis).transpose();
          out.stiffness(row, row) = stiffness;
          ++row;
        };
        const auto add_turn = [&](const Vector3& axis) {
          for (int i = 0; i < moving_nodes(); ++i)
            out.rows.block<1, 3>(row, 6 * i + 3) = station.weights[i] * axis.transpose();
          if (surface_.node >= 0) out.rows.block<1, 3>(row, columns - 3) = -axis.transpose();
          out.stiffness(row, row) = law.turn_grip;
          ++row;
        };
        const Vector3 offset = base.rotation * seen.offset;
        add(normal, offset, contact_push(law, {0, station.radius - seen.rise - distance.value, 0}).slope);
        // Friction acts at the surface, which is below the station's middle by the radius.
        const Vector3 below = offset - station.radius * normal;
        if (law.friction > 0) add(across, below, law.grip), add(third, below, law.grip);
        if (law.spinning > 0) add_turn(normal);
        if (law.rolling > 0) add_turn(across), add_turn(third);
      });
  return out;
}

DamperTensions ContactElement::dampers(const State& state, const double* memory, const Eigen::VectorXd& rates) const {
  const int each = measures_each();
  Eigen::VectorXd slopes = Eigen::VectorXd::Zero(rates.size());
  Eigen::Index row = 0;
  for_each_touching(
      state, memory, [&](const ContactStation& station, const StationPlace& seen, const SignedDistance& distance) {
        // The damping for slow motions, see contact_push().
        const double slope = hardened({station.radius - seen.rise - distance.value, law_.depth}).slope;
        slopes[row] = 2 * law_of(station).stiffness * law_.restitution.damping_of_slow_hits() / law_.frequency * slope;
        row += each;
      });
  assert(row == rates.size());
  return {slopes.cwiseProduct(rates), slopes.asDiagonal()};
}

}  // namespace flexarm
