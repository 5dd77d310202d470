#include "scene/standard_attributes.h"

#include <vector>

#include <urdf_model/model.h>

#include "scene/readers.h"
#include "scene/urdfdom.h"

namespace flexarm::scene {

bool judge_alone(const XmlElement& element, const std::string& elements) {
  const std::vector<std::string> errors = errors_of_urdfdom("<robot name=\"robot\">" + elements + "</robot>");
  if (!errors.empty()) element.warning("programs that use urdfdom cannot read it", quoted(errors.front()));
  return errors.empty();
}

Pose read_pose(const XmlElement& origin) {
  const Vector3 xyz = origin.vector("xyz", Vector3::Zero()), rpy = origin.vector("rpy", Vector3::Zero());
  urdf::Rotation rotation;
  rotation.setFromRPY(rpy.x(), rpy.y(), rpy.z());
  return {xyz, Quaternion(rotation.w, rotation.x, rotation.y, rotation.z).normalized()};
}

Pose read_origin(const XmlElement& element) {
  const std::optional<XmlElement> origin = element.child("origin");
  return origin ? read_pose(*origin) : Pose();
}

double checked_number(const XmlElement& element, const char* child, const char* attribute) {
  const std::optional<XmlElement> found = element.child(child);
  return found ? found->number(attribute, kAnyNumber, 0) : 0;
}

}  // namespace flexarm::scene
