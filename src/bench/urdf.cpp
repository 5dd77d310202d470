#include "bench/urdf.h"

#include <fmt/format.h>

namespace flexarm::bench::urdf {
namespace {

/// Escapes `<` and `&` in an expression for XML.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

std::string attached(const std::string& element, const std::string& name, const std::string& type,
                     const std::string& parent, const std::string& child, const Vector3& at,
                     const std::string& inside) {
  return fmt::format(
      "<{} name=\"{}\" type=\"{}\"> <parent link=\"{}\"/> <child link=\"{}\"/> <origin xyz=\"{}\"/> {}</{}>\n", element,
      name, type, parent, child, triple(at), inside, element);
}

}  // namespace

std::string triple(const Vector3& v) {
  return fmt::format("{} {} {}", v.x(), v.y(), v.z());
}

std::string rod(double ea, double ei, double mass) {
  constexpr double kShear = 0.35, kTorsion = 0.8;  // G A k / EA and G J / EI for Poisson's ratio 0.25
  const double inertia = mass * ei / ea;
  return fmt::format(
      "<section ea=\"{}\" ga2=\"{}\" ga3=\"{}\" gj=\"{}\" ei2=\"{}\" ei3=\"{}\" mass=\"{}\" j1=\"{}\" j2=\"{}\" "
      "j3=\"{}\"/>",
      ea, kShear * ea, kShear * ea, kTorsion * ei, ei, ei, mass, 2 * inertia, inertia, inertia);
}

std::string circle(double radius, double young, double density) {
  return fmt::format("<circle radius=\"{}\"/> <material young=\"{}\" poisson=\"0.3\" density=\"{}\"/>", radius, young,
                     density);
}

std::string beam(const std::string& name, const Vector3& to, const std::string& section, int elements,
                 const std::string& more, int order) {
  return beam_along(name, fmt::format("<line to=\"{}\"/>", triple(to)), section, elements, more, order);
}

std::string refined(std::string scene) {
  const std::string tag = "<beam ";
  for (std::size_t at = scene.find(tag); at != std::string::npos; at = scene.find(tag, at + 1))
    scene.insert(at + tag.size(), "refine=\"true\" ");
  return scene;
}

std::string beam_along(const std::string& name, const std::string& pieces, const std::string& section, int elements,
                       const std::string& more, int order) {
  return fmt::format(
      "<link name=\"{}\"> <beam elements=\"{}\" order=\"{}\"> <centerline> {} </centerline>\n  {} {}"
      "</beam> </link>\n",
      name, elements, order, pieces, section, more);
}

std::string body(const std::string& name, double mass, double inertia, const Vector3& centre) {
  return body(name, mass, Vector3::Constant(inertia), centre);
}

std::string body(const std::string& name, double mass, const Vector3& inertias, const Vector3& centre) {
  return fmt::format(
      "<link name=\"{}\"> <inertial> <origin xyz=\"{}\"/> <mass value=\"{}\"/> <inertia ixx=\"{}\" iyy=\"{}\" "
      "izz=\"{}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/> </inertial> </link>\n",
      name, triple(centre), mass, inertias.x(), inertias.y(), inertias.z());
}

std::string massless(const std::string& name) {
  return fmt::format("<link name=\"{}\"/>\n", name);
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const Vector3& at, const std::string& inside) {
  return attached("joint", name, type, parent, child, at, inside);
}

std::string loop_joint(const std::string& name, const std::string& type, const std::string& parent,
                       const std::string& child, const Vector3& at, const Vector3& child_at,
                       const std::string& inside) {
  return attached("loop_joint", name, type, parent, child, at,
                  fmt::format("<child_origin xyz=\"{}\"/> {}", triple(child_at), inside));
}

std::string axis(const Vector3& axis) {
  return fmt::format("<axis xyz=\"{}\"/> ", triple(axis));
}

std::string gravity(const Vector3& acceleration) {
  return fmt::format("<gravity xyz=\"{}\"/>\n", triple(acceleration));
}

std::string load(const std::string& link, const Vector3& at, const Vector3& force, const std::string& history,
                 const std::string& frame) {
  return fmt::format("<load link=\"{}\" at=\"{}\" force=\"{}\" frame=\"{}\" history=\"{}\"/>\n", link, triple(at),
                     triple(force), frame, escaped(history));
}

std::string moment(const std::string& link, const Vector3& at, const Vector3& moment, const std::string& history) {
  return fmt::format("<load link=\"{}\" at=\"{}\" moment=\"{}\" history=\"{}\"/>\n", link, triple(at), triple(moment),
                     escaped(history));
}

std::string initial(const std::string& joint, double position, double velocity) {
  return fmt::format("<initial joint=\"{}\" position=\"{}\" velocity=\"{}\"/>\n", joint, position, velocity);
}

std::string initial_field(const std::string& link, const Vector3& linear, const Vector3& angular) {
  return fmt::format("<initial link=\"{}\" linear=\"{}\" angular=\"{}\"/>\n", link, triple(linear), triple(angular));
}

std::string motion(const std::string& joint, const std::string& position) {
  return fmt::format("<motion joint=\"{}\" position=\"{}\"/>\n", joint, escaped(position));
}

std::string effort(const std::string& joint, const std::string& history) {
  return fmt::format("<effort joint=\"{}\" history=\"{}\"/>\n", joint, escaped(history));
}

std::string probe(const std::string& link, const Vector3& at) {
  return fmt::format("<probe name=\"{}\" link=\"{}\" at=\"{}\"/>\n", link, link, triple(at));
}

std::string scene(const std::string& links_and_joints, const std::string& simulation) {
  const bool has_gravity = simulation.find("<gravity") != std::string::npos;
  return fmt::format("<robot name=\"hard\">\n<link name=\"world\"/>\n{}<simulation>\n{}{}</simulation>\n</robot>\n",
                     links_and_joints, has_gravity ? "" : gravity(Vector3::Zero()), simulation);
}

}  // namespace flexarm::bench::urdf
