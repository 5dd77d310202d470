#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

const std::vector<SensorTraits>& sensor_kinds() {
  using Place = SensedPlace;
  static const std::vector<SensorChannel> wrench = {{"fx", "N"},   {"fy", "N"},   {"fz", "N"},
                                                    {"mx", "N m"}, {"my", "N m"}, {"mz", "N m"}},
                                          strain = {{"strain", "1"}}, tendon = {{"length", "m"}, {"tension", "N"}},
                                          imu = {{"wx", "rad/s"}, {"wy", "rad/s"}, {"wz", "rad/s"},
                                                 {"ax", "m/s^2"}, {"ay", "m/s^2"}, {"az", "m/s^2"}},
                                          pose = {{"x", "m"},  {"y", "m"},  {"z", "m"}, {"qx", "1"},
                                                  {"qy", "1"}, {"qz", "1"}, {"qw", "1"}},
                                          twist = {{"vx", "m/s"},   {"vy", "m/s"},   {"vz", "m/s"},
                                                   {"wx", "rad/s"}, {"wy", "rad/s"}, {"wz", "rad/s"}};
  static const std::vector<SensorTraits> kinds = {
      {"wrench", SensorKind::Wrench, Place::Joint, false, wrench, 6},
      {"reaction", SensorKind::Reaction, Place::Joint, true, wrench, 6},
      {"section_force", SensorKind::SectionForce, Place::Section, false, wrench, 6},
      {"strain", SensorKind::Strain, Place::Section, false, strain, 1},
      {"imu", SensorKind::Imu, Place::Point, false, imu, 6},
      {"pose", SensorKind::Pose, Place::Point, true, pose, 6},
      {"twist", SensorKind::Twist, Place::Point, true, twist, 6},
      {"contact", SensorKind::Contact, Place::Touch, false, wrench, 6},
      {"tendon", SensorKind::Tendon, Place::Tendon, false, tendon, 2}};
  return kinds;
}

const SensorTraits& traits_of(SensorKind kind) {
  return *std::find_if(sensor_kinds().begin(), sensor_kinds().end(),
                       [&](const SensorTraits& traits) { return traits.kind == kind; });
}

std::size_t find_force_element(const SceneDescription& scene, const std::string& kind, const std::string& name) {
  const auto& elements = scene.force_elements;
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const auto& each) { return each->kind() == kind && each->name == name; });
  return static_cast<std::size_t>(found - elements.begin());
}

const JointLimits* limits_of(const SceneDescription& scene, const std::string& coordinate) {
  for (const auto* joints : {&scene.joints, &scene.loop_joints})
    for (const JointDescription& joint : *joints)
      if (joint.name == coordinate) return joint.limits ? &*joint.limits : nullptr;
  return nullptr;
}

}  // namespace flexarm::scene
