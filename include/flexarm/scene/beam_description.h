#pragma once
/// The beam of a flexible link as a scene file has it: numbers in SI units, in the frame of the link.

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/math/time_function.h"
#include "flexarm/scene/source_location.h"

namespace flexarm::scene {

/// Solid circular section. [m]
struct Circle {
  double radius;
};
/// Circular tube. [m]
struct Tube {
  double outer_radius, inner_radius;
};
/// Solid rectangle: width along the section's y axis, height along z. [m]
struct Rectangle {
  double width, height;
};
/// Thin-walled rectangular box: outer width along y, outer height along z, wall thickness. [m]
struct BoxTube {
  double width, height, thickness;
};
/// Isotropic material: Young's modulus [Pa], Poisson ratio, density [kg/m^3].
struct Material {
  double young, poisson, density;
};

using SectionShape = std::variant<Circle, Tube, Rectangle, BoxTube>;
/// A section given by its geometry and its material.
struct GeometricSection {
  SectionShape shape;
  Material material;
};
/// Section stiffnesses and inertias about principal axes. Index 1: tangent, 2: section's y axis, 3: z axis.
/// ea, ga2, ga3 [N]; gj, ei2, ei3 [N m^2]; mass [kg/m]; j1, j2, j3 [kg m].
struct DirectSection {
  double ea, ga2, ga3, gj, ei2, ei3, mass, j1, j2, j3;
};
/// Full 6x6 section matrices in the section frame, order {force 1 2 3, moment 1 2 3}. The stiffness is symmetric
/// positive definite. The inertia is [[m 1, -m d^], [m d^, J]], where d is the centre of mass within the section and d^
/// its cross product matrix.
struct MatrixSection {
  Matrix6 stiffness, inertia;
};

using UniformSection = std::variant<GeometricSection, DirectSection, MatrixSection>;

/// A section that varies along the centreline, given at stations. Between stations the shape's dimensions, or else the
/// stiffnesses and inertias, are interpolated linearly. Before the first and beyond the last station they are constant.
struct SectionStations {
  std::vector<double> arc_lengths;       ///< ascending, at least two [m]
  std::vector<UniformSection> sections;  ///< one per station; all of the same type, shape and material
};

using Section = std::variant<GeometricSection, DirectSection, MatrixSection, SectionStations>;

/// One piece of the centreline in the link frame. It starts at the end of the piece before; the first piece starts at
/// the link's origin.
struct CentrelinePiece {
  enum class Kind { Line, Arc };
  Kind kind = Kind::Line;
  Vector3 to = Vector3::Zero();      ///< end point [m]
  Vector3 center = Vector3::Zero();  ///< centre of an arc [m]; the arc is the shorter one of the two possible arcs
  double twist = 0;                  ///< increase of the section's pre-twist over this piece [rad]
  SourceLocation location;
};

/// A rigid body at one end of a beam, such as a drive's housing or a flange.
struct HubDescription {
  enum class End { Start, End };
  End end = End::Start;
  double mass = 0;                    ///< concentrated at the end of the centreline [kg]
  Vector3 inertia = Vector3::Zero();  ///< principal moments about that point, along the link's axes [kg m^2]
  SourceLocation location;
};

/// A spring and a dashpot in series (a Maxwell element), in parallel with the stiffness of the beam's sections.
struct MaxwellElement {
  double modulus_ratio = 0;    ///< stiffness of the spring, relative to that of the sections at rest [-]
  double relaxation_time = 0;  ///< in which its stress decays by the factor e at constant strain [s]
};

/// A part of an element that is divided into two halves. Part 1 is the whole element, as the scene gives it; the halves
/// of part k are the parts 2k and 2k + 1.
struct HalvedPart {
  int element = 0, part = 1;
};

/// The beam of a flexible link.
struct BeamDescription {
  std::optional<int> elements;     ///< number of elements; empty: chosen automatically; 0: the beam is rigid
  int order = 2;                   ///< 1..4, nodes per element minus one
  std::optional<bool> refine;      ///< whether strongly bent elements are halved; empty: only in runs that would fail
  std::vector<HalvedPart> halved;  ///< the parts that are halved now, with all parts that contain them
  std::vector<CentrelinePiece> centreline;
  std::optional<Vector3> section_y;  ///< section's y axis at arc length 0, in the link frame; empty: a default axis
  Section section;
  /// Factor of stiffness-proportional damping for the strain component with the most damping [s].
  double stiffness_proportional_damping = 0;
  /// Damping of each strain component relative to that factor, at most 1: axial, shear y z, torsion, bending y z.
  Vector6 damping_shares = Vector6::Ones();
  double mass_proportional_damping = 0;  ///< [1/s]
  std::vector<MaxwellElement> maxwell;   ///< relaxation of the material (generalised Maxwell model)
  /// Strains at which the beam has no stress: axial, shear y z [-], torsion, bending y z [1/m]; empty: zero.
  std::array<std::optional<TimeFunction>, 6> prestrain;
  std::vector<HubDescription> hubs;  ///< at most one per end
  SourceLocation location;
};

}  // namespace flexarm::scene
