#pragma once
/// Which links and grounds can touch each other: the elements <ground>, <contact> and <no_contact> of a scene.

#include <optional>
#include <string>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/scene/source_location.h"

namespace flexarm::scene {

/// A half-space fixed in the world, filled where normal . x < offset.
struct GroundDescription {
  std::string name;
  Vector3 normal = Vector3::UnitZ();  ///< unit vector, pointing out of the ground
  double offset = 0;                  ///< [m]
  SourceLocation location = {};
};

/// Coefficient of restitution, from 0 to 1: one value, or values at increasing speeds of approach [m/s]. Between
/// these speeds it is linear, beyond them constant.
struct RestitutionDescription {
  static constexpr std::size_t kMostSpeeds = 8;
  std::vector<double> values = {0.3};
  std::vector<double> speeds = {};  ///< as many as values; empty for one value
};

/// In a contact pair: all links and grounds. Contacts between neighbours are excluded.
constexpr const char* kAllBodies = "*";

/// Two partners that can touch: each is a link, a ground or kAllBodies. If several pairs match the same two bodies, the
/// pair that names more of them explicitly applies.
struct ContactPair {
  std::string first, second;
  SourceLocation location = {};
};
struct ContactDescription : ContactPair {
  std::optional<double> stiffness = {};     ///< of a contact point [N/m]; empty: from moved masses and contact time
  std::optional<double> contact_time = {};  ///< as JointLimits::contact_time
  RestitutionDescription restitution = {};
  std::optional<double> friction = {};  ///< Coulomb coefficient; empty: from the surfaces of the links, else 0
  double grip = 1;  ///< stiffness along the surface while friction sticks, relative to that across the surface
  /// Torsional and rolling friction: the resisting moment about the normal, and across it, is at most this length times
  /// the normal force of each point [m].
  double spinning = 0, rolling = 0;
};

/// Surface properties of a link from its <gazebo> element.
struct SurfaceHints {
  std::optional<double> friction;   ///< the smaller one of mu1 and mu2
  std::optional<double> stiffness;  ///< kp [N/m]
};

}  // namespace flexarm::scene
