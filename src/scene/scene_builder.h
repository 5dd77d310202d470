#pragma once
/// Makes scenes in code, for benchmarks and tests.

#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// Builds a scene with the root link "world" and without gravity. References that its functions return are valid until
/// the next part of the same kind is added.
class SceneBuilder {
 public:
  explicit SceneBuilder(const std::string& name);

  /// Adds a flexible link whose centreline runs straight from the link's origin through `points` (link frame) [m].
  BeamDescription& beam(const std::string& name, const std::vector<Vector3>& points, const Section& section,
                        int elements, int order);
  /// Adds a rigid link. `inertia` is about the centre of mass; it and `center` are in the link frame [kg, m, kg m^2].
  void body(const std::string& name, double mass, const Vector3& center, const Matrix3& inertia);
  /// Adds a joint. `origin` in the parent's link frame [m], `axis` in the joint frame.
  JointDescription& joint(const std::string& name, JointKind kind, const std::string& parent, const std::string& child,
                          const Vector3& origin = Vector3::Zero(), const Vector3& axis = Vector3::UnitZ());
  /// Adds a load. `at` in the link frame [m]; force [N] and moment [N m] in `frame`, both times the history (see
  /// TimeFunction::parse).
  void load(const std::string& link, const Vector3& at, const Vector3& force, const Vector3& moment = Vector3::Zero(),
            const std::string& history = "1", LoadFrame frame = LoadFrame::World);
  /// Adds a drive to a joint's coordinate. `rotor_inertia` about the motor's own axis [kg m^2].
  DriveDescription& drive(const std::string& coordinate, double gear, double rotor_inertia);
  /// Adds a servo of mode Position to a joint's coordinate. Gains as in ServoDescription.
  ServoDescription& servo(const std::string& coordinate, double kp, double kd = 0, double ki = 0);
  /// Adds a sensor. `at` in the link frame [m].
  void sensor(const std::string& name, SensorKind kind, const std::string& link, const Vector3& at = Vector3::Zero());
  /// Adds a probe. `at` in the link frame [m].
  void probe(const std::string& name, const std::string& link, const Vector3& at);

  SceneDescription scene;
};

}  // namespace flexarm::scene
