#pragma once
/// Makes pieces of scenes as URDF text.

#include <string>

#include "flexarm/math/pose.h"

namespace flexarm::bench::urdf {

/// Text such as "1 0 0.5".
std::string triple(const Vector3& v);

/// <section> of a homogeneous circular rod, given by stiffnesses [N, N m^2] and mass [kg/m]. Poisson's ratio is 0.25,
/// shear areas are those of the circle, and the radius of gyration is sqrt(EI/EA).
std::string rod(double ea, double ei, double mass);
/// <circle> section of a metal [m, Pa, kg/m^3].
std::string circle(double radius, double young = 2e11, double density = 7800);

/// A flexible link along a straight line; `more`: other elements of <beam>.
std::string beam(const std::string& name, const Vector3& to, const std::string& section, int elements,
                 const std::string& more = "", int order = 2);
/// A scene in which elements of all beams are halved while they are strongly bent.
std::string refined(std::string scene);
/// A flexible link along any pieces of a <centerline>.
std::string beam_along(const std::string& name, const std::string& pieces, const std::string& section, int elements,
                       const std::string& more = "", int order = 2);
/// A rigid link with its centre of mass in the link frame, and equal principal moments of inertia [kg, kg m^2, m].
std::string body(const std::string& name, double mass, double inertia, const Vector3& centre = Vector3::Zero());
/// A rigid link with different principal moments of inertia, in link axes.
std::string body(const std::string& name, double mass, const Vector3& inertias,
                 const Vector3& centre = Vector3::Zero());
/// A link without mass.
std::string massless(const std::string& name);
/// `at`: place in the parent's link frame [m]; `inside`: other elements of <joint>.
std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const Vector3& at = Vector3::Zero(), const std::string& inside = "");
std::string loop_joint(const std::string& name, const std::string& type, const std::string& parent,
                       const std::string& child, const Vector3& at, const Vector3& child_at,
                       const std::string& inside = "");
std::string axis(const Vector3& axis);

// ---- entries of <simulation>
std::string gravity(const Vector3& acceleration);
std::string load(const std::string& link, const Vector3& at, const Vector3& force, const std::string& history = "1",
                 const std::string& frame = "world");
std::string moment(const std::string& link, const Vector3& at, const Vector3& moment, const std::string& history = "1");
std::string initial(const std::string& joint, double position, double velocity);
/// Initial velocity field of a link [m/s, rad/s].
std::string initial_field(const std::string& link, const Vector3& linear, const Vector3& angular);
std::string motion(const std::string& joint, const std::string& position);
std::string effort(const std::string& joint, const std::string& history);
std::string probe(const std::string& link, const Vector3& at);

/// A complete scene with the root link "world". There is no gravity unless `simulation` contains it.
std::string scene(const std::string& links_and_joints, const std::string& simulation = "");

}  // namespace flexarm::bench::urdf
