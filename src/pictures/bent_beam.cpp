#include "pictures/bent_beam.h"

#include <Eigen/Geometry>
#include <cmath>

#include "math/pi.h"

namespace flexarm::pictures {

std::vector<Pose> bent_sections(const PictureBeam& beam, const BeamEnd& end) {
  const double length = beam.arc_lengths.back();
  const auto along = [](const Pose& section) { return Vector3(section.orientation * Vector3::UnitX()); };
  const Pose& last = beam.sections.back();
  const Vector3 shift = end.pose.position - last.position;
  Vector3 slope = 1.5 / length * shift;  // of the shift, at the end: that of a cantilever with a force there
  double twist = 0;
  if (end.has_orientation) {
    const Vector3 line = along(last), turned = end.pose.orientation * line;
    slope = turned - line;
    const Quaternion rest = Quaternion::FromTwoVectors(line, turned).conjugate() * end.pose.orientation;
    twist = std::remainder(2 * std::atan2(rest.vec().dot(line), rest.w()), 2 * kPi);
  }
  std::vector<Pose> sections = beam.sections;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const double s = beam.arc_lengths[k] / length;
    Pose& section = sections[k];
    const Vector3 line = along(section);
    section.position += s * s * (3 - 2 * s) * shift + s * s * (s - 1) * length * slope;
    const Vector3 turned = line + 6 * s * (1 - s) / length * shift + s * (3 * s - 2) * slope;
    section.orientation =
        Quaternion::FromTwoVectors(line, turned) * Quaternion(Eigen::AngleAxisd(s * twist, line)) * section.orientation;
  }
  return sections;
}

}  // namespace flexarm::pictures
