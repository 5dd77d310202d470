// Which points of rims and segments touch over a step. (docs/notes/contact.md 1.2)
#include <cmath>

#include "contact/contact_step.h"

namespace flexarm {

bool ContactElement::may_touch(const ContactStation& station, const ContactShape& shape, const Seen& seen) {
  const Vector3 begin = seen.begin.middle(station), end = seen.end.middle(station);
  const double way = (end - begin).norm();
  if (station.half == 0) return shape.gap(begin) - station.reach() <= way;
  const double turn = (seen.end.segment(station).axis - seen.begin.segment(station).axis).norm();
  return seen.begin.least_gap(station, shape) <= way + station.half * turn;
}

PointMotion ContactElement::motion_of(const ContactStation& station, const ContactShape& shape, int remembered,
                                      const Seen& seen) const {
  PointMotion out;
  out.face = seen.begin.face(station, shape, remembered);
  const StationPlace begin = seen.begin.place(station, shape, out.face), end = seen.end.place(station, shape, out.face);
  out.begin = begin.middle, out.begin_offset = begin.offset;
  out.end = end.middle, out.end_offset = end.offset;
  out.begin_excess = -begin.rise, out.end_excess = -end.rise;
  out.begin_velocity = seen.velocities.at(station, begin);
  out.outwards = seen.begin.outwards(station);
  return out;
}

ContactElement::Tilt ContactElement::tilt(const ContactStation& station, const ContactShape& shape,
                                          const PointMotion& motion, const Frames& frames,
                                          const ForceStep& step) const {
  Tilt out;
  const Vector3 normal = face_normal(shape, motion.face);
  const Vector3 begin_axis = poses_in(step.begin)(side_.nodes[0]).rotation * station.axis;
  out.end_axis = poses_in(step.end)(side_.nodes[0]).rotation * station.axis;
  out.end_normal = frames.base_end.rotation * normal;
  out.axis = frames.weight * out.end_axis + (1 - frames.weight) * begin_axis;
  out.normal = frames.axes * normal;
  const double end = out.end_axis.dot(out.end_normal);
  out.lever = rim_lever(station.rim, step.at_end ? end : begin_axis.dot(frames.base_begin.rotation * normal), end);
  if (step.at_end) out.lever.slope *= 2;  // the lever is symmetric in both cosines
  out.by_spin =
      lowest_point_by_spin({motion.end, frames.base_end.rotation.transpose() * out.end_axis, station.rim}, normal);
  return out;
}

ContactElement::Slide ContactElement::slide(const ContactStation& station, const ContactShape& shape,
                                            const ForceStep& step, const Seen& seen) const {
  Slide out;
  out.station = station;
  out.station.half = 0;
  const Segment begin = seen.begin.segment(station), end = seen.end.segment(station);
  const NearestOnSegment first = nearest_on(begin, shape);
  const double way = (end.middle - begin.middle).norm() + station.half * (end.axis - begin.axis).norm();
  out.is_away = first.distance - station.radius > way || !std::isfinite(first.distance);
  if (out.is_away) return out;
  const NearestOnSegment last = nearest_on(end, shape);
  const bool is_instant = step.at_end || step.duration == 0;
  const double along = is_instant ? last.along : midway(station, shape, step.duration, seen);
  out.station.arm += along * station.axis;
  const SignedDistance felt = shape.distance(end.at(along)), nearest = shape.distance(end.at(last.along));
  out.begin_excess = shape.distance(begin.at(along)).value - first.distance;
  out.end_excess = felt.value - last.distance;
  out.axis = end.axis, out.begin_axis = begin.axis;
  const Eigen::RowVector3d turned = (end.axis.cross(nearest.gradient)).transpose();  // of nearest.gradient . axis
  const double curvature = station.curvature;
  if (!is_instant) {
    out.by_seen = (felt.gradient - nearest.gradient).transpose();
    out.by_spin = (along - last.along) * turned;
  } else if (!last.is_end) {
    const Eigen::RowVector3d bent = end.axis.transpose() * nearest.hessian;
    const double rise = bent.dot(end.axis) + curvature;
    out.along_by_seen = -bent / rise;
    out.along_by_spin = -turned / rise;
    // The excess is minus the rise of the surface there.
    out.by_seen = -curvature * along * out.along_by_seen;
    out.by_spin = -curvature * along * out.along_by_spin;
  }
  return out;
}

/// The place along a segment that is nearest in the middle of a step, by the velocities at its beginning [m].
double ContactElement::midway(const ContactStation& station, const ContactShape& shape, double duration,
                              const Seen& seen) {
  Segment segment = seen.begin.segment(station);
  const Vector3 middle = seen.velocities.at(station, {segment.middle}),
                end = seen.velocities.at(station, {segment.middle, segment.axis});
  segment.middle += 0.5 * duration * middle;
  segment.axis = (segment.axis + 0.5 * duration * (end - middle)).normalized();
  return nearest_on(segment, shape).along;
}

}  // namespace flexarm
