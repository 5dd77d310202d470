#pragma once
/// What a run looks like: all that does not change with time. docs/notes/page.md explains the members.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/result_columns.h"
#include "flexarm/simulation/simulation.h"
#include "meshes/surface_mesh.h"
#include "pictures/bare_links.h"
#include "pictures/scene_extent.h"

namespace flexarm::pictures {

/// A shape of a link. A mesh is an index into Picture::meshes.
struct PictureShape {
  Pose pose;  ///< in the link's frame
  std::variant<scene::BoxShape, scene::CylinderShape, scene::SphereShape, std::size_t> shape;
  std::optional<scene::Color> color;
};

struct PictureLink {
  std::string name;
  int parent = -1;  ///< index of a link; -1: none
  int beam = -1;    ///< index into Picture::beams; -1: none
  /// Where the children are that it carries, and the centre of mass of a link with a MassBall, in the link's frame [m].
  /// Lines from its origin to these points stand for a link without shapes.
  std::vector<Vector3> stick = {};
  std::vector<PictureShape> shapes = {};
  std::optional<MassBall> mass = {};  ///< what shows the mass of a link that has neither shapes nor a beam
  bool is_fixed = false;              ///< nothing can move or bend it
};

struct PictureMesh {
  std::string name;  ///< the URL in the scene
  Vector3 scale;
  meshes::SurfaceMesh surface;
};

struct PictureBeam {
  std::size_t link;
  std::vector<double> arc_lengths;  ///< of the sections [m]
  std::vector<Pose> sections;       ///< undeformed, in the link's frame
  double radius;                    ///< of the section's contour about the line [m]
  int between;                      ///< sections between neighbouring nodes
  double tube = 0;                  ///< radius of the tube that stands for a beam without shapes [m]
};

struct PictureJoint {
  std::string name, kind;
  std::size_t link;                  ///< that it carries
  std::optional<Vector3> axis;       ///< in that link's frame, unit
  std::vector<std::size_t> columns;  ///< its positions, velocities and efforts
};

/// A spring between points, or a tendon.
struct PictureLine {
  std::string kind, name;
  std::size_t element;  ///< index of SceneDescription::force_elements
  std::size_t points;   ///< at most
};

struct Picture {
  std::string name, title;
  std::vector<std::string> notes;  ///< for the user: what could not be shown, and other warnings
  SceneExtent extent;
  Vector3 gravity;  ///< [m/s^2]
  std::vector<PictureLink> links;
  std::vector<PictureMesh> meshes;
  std::vector<PictureBeam> beams;
  std::vector<PictureJoint> joints;
  std::vector<scene::Probe> probes;
  std::vector<PictureLine> lines;
  std::vector<scene::GroundDescription> grounds;
  std::vector<ResultColumn> columns;
};

/// The picture of a simulation in its present state. A mesh that cannot be read becomes a note.
Picture picture_of(const Simulation& simulation, const std::vector<ResultColumn>& columns);

}  // namespace flexarm::pictures
