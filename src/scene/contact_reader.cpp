#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "scene/readers.h"

namespace flexarm::scene {
namespace {

ContactPair read_pair(const XmlElement& element) {
  ContactPair out;
  out.location = element.location();
  out.first = element.name("first").value_or("");
  out.second = element.name("second").value_or("");
  return out;
}

/// Records links that have nothing but meshes to touch with.
void warn_of_meshes(const SceneDescription& scene, Findings& findings) {
  const auto is_mesh = [](const VisualDescription& shape) { return std::holds_alternative<MeshShape>(shape.shape); };
  for (const LinkDescription& link : scene.links)
    if (!link.collisions.empty() && std::all_of(link.collisions.begin(), link.collisions.end(), is_mesh))
      findings.warning(link.location.line, "<link> " + quoted(link.name),
                       "touches nothing: its <collision> is a mesh; expected a box, a cylinder or a sphere");
}

}  // namespace

GroundDescription read_ground(const XmlElement& ground) {
  ground.expect_only({"name", "normal", "offset"});
  GroundDescription out;
  out.location = ground.location();
  out.name = ground.name("name").value_or("");
  out.normal = ground.has("normal") ? ground.direction("normal").value_or(out.normal) : out.normal;
  out.offset = ground.number("offset", kAnyNumber, 0);
  return out;
}

bool is_contact(const XmlElement& element) {
  return element.tag() == "contact" && (element.has("first") || element.has("second"));
}

ContactDescription read_contact(const XmlElement& contact) {
  contact.expect_only({"first", "second", "stiffness", "restitution", "friction"});
  ContactDescription out;
  static_cast<ContactPair&>(out) = read_pair(contact);
  if (contact.has("stiffness")) out.stiffness = contact.number("stiffness", kPositive);
  if (contact.has("restitution")) out.restitution = contact.number("restitution", kRestitution).value_or(1);
  out.friction = contact.number("friction", kNonNegative, 0);
  return out;
}

ContactPair read_no_contact(const XmlElement& pair) {
  pair.expect_only({"first", "second"});
  return read_pair(pair);
}

void check_contacts(const SceneDescription& scene, Findings& findings) {
  if (!scene.contacts.empty()) warn_of_meshes(scene, findings);
  std::set<std::string> links, sides = {kAllBodies};
  for (const LinkDescription& link : scene.links) links.insert(link.name);
  sides.insert(links.begin(), links.end());
  const auto element = [&](const char* tag) { return fmt::format("<{}> of robot {}", tag, quoted(scene.name)); };
  for (const GroundDescription& ground : scene.grounds)
    if (!ground.name.empty() && !sides.insert(ground.name).second)
      findings.error(ground.location.line, element("ground"), "its name must be that of no link and of no other ground",
                     quoted(ground.name));
  std::set<std::pair<std::string, std::string>> named;
  const auto has_line = [&](const std::string& name) {
    const auto is_it = [&](const LinkDescription& link) { return link.name == name; };
    const auto link = std::find_if(scene.links.begin(), scene.links.end(), is_it);
    return link != scene.links.end() && link->beam && link->collisions.empty();
  };
  const auto check = [&](const ContactPair& pair, const std::string& who) {
    if (pair.first.empty() || pair.second.empty()) return;  // which is told
    for (const auto& [attribute, side] : {std::pair("first", pair.first), std::pair("second", pair.second)})
      if (sides.count(side) == 0)
        findings.error(pair.location.line, who,
                       std::string(attribute) + " must be a link or a ground of the scene, or *", quoted(side));
    if (pair.first == pair.second && pair.first != kAllBodies && !has_line(pair.first))
      findings.error(pair.location.line, who, "first and second must be different, but of a beam without <collision>",
                     quoted(pair.first));
    if (!named.insert(std::minmax(pair.first, pair.second)).second)
      findings.error(pair.location.line, who, "must be the only <contact> or <no_contact> of its pair",
                     quoted(pair.first) + " and " + quoted(pair.second));
  };
  for (const ContactDescription& contact : scene.contacts) check(contact, element("contact"));
  for (const ContactPair& pair : scene.no_contacts) check(pair, element("no_contact"));
}

}  // namespace flexarm::scene
