#include "integrators/explicit_obstacle.h"

#include <algorithm>

namespace flexarm {

const char* explicit_obstacle(const Model& model) {
  bool has_beams = false;
  for_each_element(model.beams, [&](const auto&) { has_beams = true; });
  if (has_beams) return "flexible links";
  if (!model.slide_lines.empty()) return "sliders";
  if (!model.force_elements.empty()) return "springs, lines, drag or contacts";
  for (const Coordinate& coordinate : model.coordinates) {
    const bool depends = coordinate.motion >= 0 || coordinate.mimicked >= 0;
    if (depends && model.joints[coordinate.joint].kind != JointMapKind::Scalar)
      return "prescribed motions of floating joints";
    if (coordinate.sticks && coordinate.friction > 0) return "dry friction";
    if (coordinate.friction_coefficient > 0) return "friction that depends on the load";
  }
  for (const Actuator& actuator : model.actuators) {
    const Drive& drive = actuator.drive;
    if (!drive.gear && actuator.gyroscope) return "gyroscopic rotors of rigid gears";
    if (!drive.gear && drive.loss > 0) return "losses of rigid gears";
    if (drive.gear && drive.sticks && drive.friction + drive.loss > 0) return "dry friction";
  }
  return nullptr;
}

bool explicit_errors_are_known(const Model& model) {
  const auto has_play = [](const Actuator& actuator) {
    return actuator.drive.gear && actuator.drive.gear->backlash > 0;
  };
  return !explicit_obstacle(model) && std::none_of(model.actuators.begin(), model.actuators.end(), has_play);
}

}  // namespace flexarm
