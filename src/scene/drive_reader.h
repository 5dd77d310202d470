#pragma once
/// What drives joints: <spring>, <drive>, <servo>, and URDF's <transmission>.

#include "scene/xml_element.h"

namespace flexarm::scene {

SpringDescription read_spring(const XmlElement& spring);
DriveDescription read_drive(const XmlElement& drive);
ServoDescription read_servo(const XmlElement& servo);

/// The reduction between one motor and one joint.
struct Transmission {
  std::string joint;
  std::string reduction;  ///< as it is written
  int line = 0;
};
/// Nothing where it has no <mechanicalReduction>, or couples several joints or motors.
std::optional<Transmission> read_transmission(const XmlElement& transmission);

/// Drives without a gear take that of their joint's transmission; records contradictions.
void settle_gears(const std::vector<Transmission>& transmissions, std::vector<DriveDescription>& drives,
                  Findings& findings);

}  // namespace flexarm::scene
