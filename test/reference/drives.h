#pragma once
/// Drives of scenes that are made by a program.

#include <string>

#include "support/scene_builder.h"

namespace flexarm::test {

/// Appends the drive of a joint's coordinate; `rotor_inertia` [kg m^2] about the motor's own axis.
inline scene::DriveDescription& add_drive(SceneBuilder& b, const std::string& joint, double gear,
                                          double rotor_inertia) {
  scene::DriveDescription drive;
  drive.coordinate = joint;
  drive.gear = gear;
  drive.rotor_inertia = rotor_inertia;
  b.scene.drives.push_back(drive);
  return b.scene.drives.back();
}

}  // namespace flexarm::test
