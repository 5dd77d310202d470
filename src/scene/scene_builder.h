#pragma once
/// Scenes made in code, for benchmarks and tests.

#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// Adds to a scene whose root link is "world", without gravity. What is returned may be changed until the next part of
/// its kind is added.
class SceneBuilder {
 public:
  explicit SceneBuilder(const std::string& name);

  /// A flexible link along straight lines through `points` (link frame; the first at the origin is implied) [m].
  BeamDescription& beam(const std::string& name, const std::vector<Vector3>& points, const Section& section,
                        int elements, int order);
  /// A rigid link; its inertia is about the centre of mass, both in the link frame [kg, m, kg m^2].
  void body(const std::string& name, double mass, const Vector3& center, const Matrix3& inertia);
  /// `origin` in the parent's link frame [m], `axis` in the joint's.
  JointDescription& joint(const std::string& name, JointKind kind, const std::string& parent, const std::string& child,
                          const Vector3& origin = Vector3::Zero(), const Vector3& axis = Vector3::UnitZ());
  /// `at` in the link frame [m]; force [N] and moment [N m] in `frame`, times the history (see TimeFunction::parse).
  void load(const std::string& link, const Vector3& at, const Vector3& force, const Vector3& moment = Vector3::Zero(),
            const std::string& history = "1", LoadFrame frame = LoadFrame::World);
  /// On a joint's coordinate; `rotor_inertia` about the motor's own axis [kg m^2].
  DriveDescription& drive(const std::string& coordinate, double gear, double rotor_inertia);
  /// Of mode position, on a joint's coordinate; gains as in ServoDescription.
  ServoDescription& servo(const std::string& coordinate, double kp, double kd = 0, double ki = 0);
  /// `at` in the link frame [m].
  void sensor(const std::string& name, SensorKind kind, const std::string& link, const Vector3& at = Vector3::Zero());
  /// `at` in the link frame [m].
  void probe(const std::string& name, const std::string& link, const Vector3& at);

  SceneDescription scene;
};

}  // namespace flexarm::scene
