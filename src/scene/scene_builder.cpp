#include "scene/scene_builder.h"

namespace flexarm::scene {

SceneBuilder::SceneBuilder(const std::string& name) {
  scene.name = name;
  scene.file = name + ".urdf";
  scene.root_link = "world";
  scene.gravity.setZero();
  scene.links.push_back({"world", {}, {}, {}});
}

BeamDescription& SceneBuilder::beam(const std::string& name, const std::vector<Vector3>& points, const Section& section,
                                    int elements, int order) {
  LinkDescription link;
  link.name = name;
  link.beam.emplace();
  for (const Vector3& point : points) {
    CentrelinePiece piece;
    piece.to = point;
    link.beam->centreline.push_back(piece);
  }
  link.beam->section = section;
  link.beam->elements = elements;
  link.beam->order = order;
  scene.links.push_back(link);
  return *scene.links.back().beam;
}

void SceneBuilder::body(const std::string& name, double mass, const Vector3& center, const Matrix3& inertia) {
  scene.links.push_back({name, RigidInertia{mass, center, inertia}, {}, {}});
}

JointDescription& SceneBuilder::joint(const std::string& name, JointKind kind, const std::string& parent,
                                      const std::string& child, const Vector3& origin, const Vector3& axis) {
  JointDescription joint;
  joint.name = name;
  joint.kind = kind;
  joint.parent = parent;
  joint.child = child;
  joint.origin.position = origin;
  joint.axis = axis;
  scene.joints.push_back(joint);
  return scene.joints.back();
}

void SceneBuilder::load(const std::string& link, const Vector3& at, const Vector3& force, const Vector3& moment,
                        const std::string& history, LoadFrame frame) {
  PointLoad load;
  load.link = link;
  load.at = at;
  load.force = force;
  load.moment = moment;
  load.frame = frame;
  load.history = TimeFunction::parse(history);
  scene.loads.push_back(load);
}

DriveDescription& SceneBuilder::drive(const std::string& coordinate, double gear, double rotor_inertia) {
  DriveDescription& drive = scene.drives.emplace_back();
  drive.coordinate = coordinate;
  drive.gear = gear;
  drive.rotor_inertia = rotor_inertia;
  return drive;
}

ServoDescription& SceneBuilder::servo(const std::string& coordinate, double kp, double kd, double ki) {
  ServoDescription& servo = scene.servos.emplace_back();
  servo.coordinate = coordinate;
  servo.kp = kp;
  servo.kd = kd;
  servo.ki = ki;
  return servo;
}

void SceneBuilder::sensor(const std::string& name, SensorKind kind, const std::string& link, const Vector3& at) {
  Sensor sensor;
  sensor.name = name;
  sensor.kind = kind;
  sensor.link = link;
  sensor.at = at;
  scene.sensors.push_back(sensor);
}

void SceneBuilder::probe(const std::string& name, const std::string& link, const Vector3& at) {
  scene.probes.push_back({name, link, at, {}});
}

}  // namespace flexarm::scene
