#pragma once
/// Scenes made in code, for tests and benchmarks.

#include <string>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::test {

/// Section with the given stiffnesses and inertias; 1 = tangent, 2 = y, 3 = z.
inline scene::DirectSection section(double ea, double ga, double gj, double ei, double mass, double j1, double j2) {
  return {ea, ga, ga, gj, ei, ei, mass, j1, j2, j2};
}

/// Fluent construction of a scene whose root link is "world", without gravity.
class SceneBuilder {
 public:
  SceneBuilder() {
    scene.name = "test";
    scene.file = "test.urdf";
    scene.root_link = "world";
    scene.gravity.setZero();
    scene.integrator.scheme = "em";
    scene.links.push_back({"world", {}, {}, {}});
  }

  /// A flexible link along straight lines through `points` (the first at the origin is implied).
  scene::BeamDescription& beam(const std::string& name, const std::vector<Vector3>& points, const scene::Section& s,
                               int elements, int order) {
    scene::LinkDescription link;
    link.name = name;
    link.beam.emplace();
    for (const Vector3& point : points) {
      scene::CentrelinePiece piece;
      piece.to = point;
      link.beam->centreline.push_back(piece);
    }
    link.beam->section = s;
    link.beam->elements = elements;
    link.beam->order = order;
    scene.links.push_back(link);
    return *scene.links.back().beam;
  }

  void body(const std::string& name, double mass, const Vector3& center, const Matrix3& inertia) {
    scene.links.push_back({name, scene::RigidInertia{mass, center, inertia}, {}, {}});
  }

  /// `origin` in the parent's link frame.
  scene::JointDescription& joint(const std::string& name, scene::JointKind kind, const std::string& parent,
                                 const std::string& child, const Vector3& origin = Vector3::Zero(),
                                 const Vector3& axis = Vector3::UnitZ()) {
    scene::JointDescription description;
    description.name = name;
    description.kind = kind;
    description.parent = parent;
    description.child = child;
    description.origin.position = origin;
    description.axis = axis;
    scene.joints.push_back(description);
    return scene.joints.back();
  }

  void load(const std::string& link, const Vector3& at, const Vector3& force, const Vector3& moment = Vector3::Zero(),
            const std::string& history = "1", scene::LoadFrame frame = scene::LoadFrame::World) {
    scene::PointLoad load;
    load.link = link;
    load.at = at;
    load.force = force;
    load.moment = moment;
    load.frame = frame;
    load.history = TimeFunction::parse(history);
    scene.loads.push_back(load);
  }

  void probe(const std::string& name, const std::string& link, const Vector3& at) {
    scene.probes.push_back({name, link, at, {}});
  }

  scene::SceneDescription scene;
};

}  // namespace flexarm::test
