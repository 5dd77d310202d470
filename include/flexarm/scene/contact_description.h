#pragma once
/// What touches what: <ground>, <contact>, <no_contact> of a scene.

#include <optional>
#include <string>

#include "flexarm/math/pose.h"
#include "flexarm/scene/source_location.h"

namespace flexarm::scene {

/// A half-space fixed in the world: where normal . x < offset.
struct GroundDescription {
  std::string name;
  Vector3 normal = Vector3::UnitZ();  ///< outwards, unit
  double offset = 0;                  ///< [m]
  SourceLocation location = {};
};

/// Stands for all links and grounds that are not neighbours.
constexpr const char* kAllBodies = "*";

/// Two sides that touch: a link, a ground, or all. If several name a pair, the one that names more of it counts.
struct ContactPair {
  std::string first, second;
  SourceLocation location = {};
};
struct ContactDescription : ContactPair {
  std::optional<double> stiffness = {};  ///< of a contact point [N/m]; empty: by what it moves and the step
  double restitution = 0.3;              ///< from 0.05 to 1
  std::optional<double> friction = {};   ///< Coulomb's coefficient; empty: as the links' surfaces have it, else 0
  /// Moments that resist turning about the normal and across it: at most this length times the normal force of each
  /// point [m].
  double spinning = 0, rolling = 0;
};

/// What a <gazebo> element says of the surface of a link.
struct SurfaceHints {
  std::optional<double> friction;   ///< the smaller one of mu1 and mu2
  std::optional<double> stiffness;  ///< kp [N/m]
};

}  // namespace flexarm::scene
