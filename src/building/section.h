#pragma once
/// Stiffness and inertia of cross-sections, from the scene.

#include <optional>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm {

/// Properties per unit length of the reference line, in the section frame (1 = tangent, 2 = y, 3 = z).
struct SectionProperties {
  Matrix6 stiffness = Matrix6::Zero();       ///< F = {N, M} = stiffness * {Gamma, K}; [N], [N m], [N m^2]
  double mass = 0;                           ///< [kg/m]
  Vector3 center_of_mass = Vector3::Zero();  ///< in the section, from the reference line [m]
  Matrix3 inertia = Matrix3::Zero();         ///< rotary inertia about the centre of mass [kg m]
  double radius = 0;                         ///< largest distance of the edge from the reference line, for display [m]
  Eigen::Vector2d extent = Eigen::Vector2d::Zero();  ///< along y and z [m]; zero if the shape is not known
};

/// Converts geometry and material, direct properties or full matrices.
/// Shear correction factors: Cowper (1966); torsion constants: Saint-Venant (Bredt for the thin box). beam.md 2.1.
SectionProperties section_properties(const scene::UniformSection& section);

/// The same section referred to its mass centroid: the strain energy is unchanged because
/// Gamma_reference = Gamma_centroid + d^ K for the centroid at d in the section.
/// In the result center_of_mass is zero.
SectionProperties referred_to_center_of_mass(const SectionProperties& section);

/// The section along a line, by arc length of the reference line [m].
class SectionLine {
 public:
  SectionLine() : SectionLine(scene::Section()) {}
  explicit SectionLine(const scene::Section& section);
  /// The same section everywhere; for tests.
  explicit SectionLine(const SectionProperties& uniform) : uniform_(uniform) {}

  bool is_uniform() const { return uniform_.has_value(); }
  SectionProperties at(double arc_length) const;
  /// Arc lengths at which the section is given, ascending; empty if it is uniform.
  const std::vector<double>& stations() const { return stations_.arc_lengths; }
  /// Largest radius along the line, for display [m].
  double largest_radius() const;

 private:
  std::optional<SectionProperties> uniform_;
  scene::SectionStations stations_;
};

}  // namespace flexarm
