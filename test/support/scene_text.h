#pragma once
/// Scenes as text: what they are written with, and their reader. Brings fmt and gtest along.

#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#include "support/source_path.h"

namespace flexarm::test {

/// The scene that was read. All findings fail the test, also warnings. @throws std::runtime_error if there is no scene
inline scene::SceneDescription found_good(scene::ReadResult read) {
  for (const scene::Diagnostic& finding : read.diagnostics) ADD_FAILURE() << finding.text();
  if (!read.scene) throw std::runtime_error("a scene has errors");
  return *std::move(read.scene);
}
/// The scene of an extended URDF, which messages call test.urdf.
inline scene::SceneDescription scene_of(const std::string& text, const scene::ReadOptions& options = {}) {
  return found_good(scene::read_scene_text(text, "test.urdf", options));
}
/// The scene of a text with something that its reader warns of.
inline scene::SceneDescription scene_warned_of(const std::string& text) {
  scene::ReadResult read = scene::read_scene_text(text, "test.urdf");
  EXPECT_TRUE(read.scene && !read.diagnostics.empty()) << scene::to_text(read.diagnostics);
  return std::move(read.scene).value();
}
/// The scene of a file of the repository, such as config/demo_arm.urdf.
inline scene::SceneDescription scene_at(const std::string& path) {
  return found_good(scene::read_scene_file(source_path(path)));
}

/// Components as an attribute has them, to the last digit.
inline std::string xyz(const Vector3& vector) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", vector.x(), vector.y(), vector.z());
}

/// <inertial> with these moments about axes of the link through its centre of mass [kg, kg m^2, m].
inline std::string inertial(double mass, const Vector3& moments = Vector3::Ones(),
                            const Vector3& centre = Vector3::Zero()) {
  return fmt::format(R"(<inertial><origin xyz="{}"/><mass value="{:.17g}"/><inertia ixx="{:.17g}" iyy="{:.17g}" )"
                     R"(izz="{:.17g}" ixy="0" ixz="0" iyz="0"/></inertial>)",
                     xyz(centre), mass, moments.x(), moments.y(), moments.z());
}

/// A rigid <link>. `more`: its children beside <inertial>.
inline std::string body(const std::string& name, double mass, const Vector3& moments = Vector3::Ones(),
                        const Vector3& centre = Vector3::Zero(), const std::string& more = "") {
  return "<link name=\"" + name + "\">" + inertial(mass, moments, centre) + more + "</link>";
}

/// A ball's moments of inertia [kg m^2].
inline Vector3 of_ball(double mass, double radius) {
  return Vector3::Constant(0.4 * mass * radius * radius);
}

/// A box's moments of inertia [kg m^2]. `size`: its edges [m].
inline Vector3 of_box(double mass, const Vector3& size) {
  const Vector3 squares = size.cwiseAbs2();
  return mass / 12 * (Vector3::Constant(squares.sum()) - squares);
}

/// <collision> with a shape such as <sphere radius="0.1"/>.
inline std::string collision(const std::string& shape, const Vector3& centre = Vector3::Zero()) {
  return "<collision><origin xyz=\"" + xyz(centre) + "\"/><geometry>" + shape + "</geometry></collision>";
}

/// A rigid ball that may touch others.
inline std::string ball(const std::string& name, double mass, double radius) {
  return body(name, mass, of_ball(mass, radius), Vector3::Zero(),
              collision(fmt::format("<sphere radius=\"{:.17g}\"/>", radius)));
}

/// A rigid box that may touch others.
inline std::string box(const std::string& name, double mass, const Vector3& size) {
  return body(name, mass, of_box(mass, size), Vector3::Zero(), collision("<box size=\"" + xyz(size) + "\"/>"));
}

/// A <joint>, or a <loop_joint> as `tag`. `more`: its children beside the links, such as <axis>. A spherical one is
/// written such that urdfdom reads it.
inline std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                         const std::string& child, const std::string& more = "", const std::string& tag = "joint") {
  const bool spherical = type == "spherical";
  return fmt::format(R"(<{0} name="{1}" type="{2}"><parent link="{3}"/><child link="{4}"/>{5}{6}</{0}>)", tag, name,
                     spherical ? "floating" : type, parent, child, spherical ? R"(<release kind="spherical"/>)" : "",
                     more);
}

/// Limits that nothing reaches, which prismatic joints must have.
inline const std::string kFarLimits = R"(<limit lower="-1e3" upper="1e3" effort="0" velocity="0"/>)";

/// A prismatic joint from the world along `axis`.
inline std::string rail(const std::string& name, const std::string& child, const std::string& axis) {
  return joint(name, "prismatic", "world", child, "<axis xyz=\"" + axis + "\"/>" + kFarLimits);
}

/// A whole scene: `parts` beside the link "world", and the children of <simulation>.
inline std::string robot(const std::string& parts, const std::string& simulation = "") {
  return "<robot name=\"test\"><link name=\"world\"/>" + parts + "<simulation>" + simulation + "</simulation></robot>";
}

inline std::string gravity(const Vector3& acceleration) {
  return "<gravity xyz=\"" + xyz(acceleration) + "\"/>";
}

/// `tolerance` of Newton's method.
inline std::string integrator(const std::string& scheme, double step, double tolerance = 1e-8) {
  return fmt::format(R"(<integrator scheme="{}" step="{:.17g}" tolerance="{:.17g}"/>)", scheme, step, tolerance);
}

/// The scene of these parts, solved to the tolerance 1e-12. `entries`: children of <simulation>.
inline scene::SceneDescription scene_of_parts(const std::string& parts, const std::string& entries = "",
                                              double step = 1e-3, const std::string& scheme = "em") {
  return scene_of(robot(parts, integrator(scheme, step, 1e-12) + entries));
}
inline Simulation simulation_of_parts(const std::string& parts, const std::string& entries = "", double step = 1e-3,
                                      const std::string& scheme = "em") {
  return Simulation(scene_of_parts(parts, entries, step, scheme));
}

}  // namespace flexarm::test
