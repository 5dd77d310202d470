#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "flexarm/scene/resource_path.h"
#include "math/number_text.h"
#include "scene/limits.h"
#include "scene/readers.h"
#include "scene/xml_document.h"

namespace flexarm::scene {
namespace {

ContactPair read_pair(const XmlElement& element) {
  ContactPair out;
  out.location = element.location();
  out.first = element.name("first").value_or("");
  out.second = element.name("second").value_or("");
  return out;
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

void read_hardness(const XmlElement& element, std::optional<double>& contact_time, std::optional<double>& stiffness) {
  if (element.has("contact_time")) contact_time = element.number("contact_time", kPositive);
  if (element.has("stiffness")) stiffness = element.number("stiffness", kPositive);
  if (element.has("contact_time") && element.has("stiffness"))
    element.attribute_error("contact_time", "the stiffness determines it; leave one of them out");
}

RestitutionDescription read_restitution(const XmlElement& element) {
  RestitutionDescription out;
  if (!element.has("speeds")) {
    if (element.has("restitution")) out.values = {element.number("restitution", kRestitution).value_or(1)};
    return out;
  }
  constexpr std::size_t kMost = RestitutionDescription::kMostSpeeds;
  const std::optional<std::vector<double>> speeds = element.all_numbers("speeds", kMost);
  const std::optional<std::vector<double>> values = element.all_numbers("restitution", kMost);
  if (!speeds || !values) return out;
  const auto is_lower = [](double one, double other) { return one < other; };
  if (speeds->front() < 0 || std::adjacent_find(speeds->begin(), speeds->end(), std::not_fn(is_lower)) != speeds->end())
    element.attribute_error("speeds", "speeds must be >= 0 and increase");
  else if (values->size() != speeds->size())
    element.attribute_error("restitution",
                            fmt::format("there must be as many restitutions as speeds, {}", speeds->size()));
  else if (!std::all_of(values->begin(), values->end(), kRestitution.holds))
    element.attribute_error("restitution", fmt::format("each restitution must be {}", kRestitution.text));
  else
    out = {*values, *speeds};
  return out;
}

bool is_contact(const XmlElement& element) {
  return element.tag() == "contact" && (element.has("first") || element.has("second"));
}

ContactDescription read_contact(const XmlElement& contact) {
  contact.expect_only({"first", "second", "contact_time", "stiffness", "restitution", "speeds", "friction", "grip",
                       "spinning", "rolling"});
  ContactDescription out;
  static_cast<ContactPair&>(out) = read_pair(contact);
  read_hardness(contact, out.contact_time, out.stiffness);
  out.restitution = read_restitution(contact);
  if (contact.has("friction")) out.friction = contact.number("friction", kNonNegative);
  out.grip = contact.number("grip", kPositive, out.grip);
  out.spinning = contact.number("spinning", kNonNegative, 0);
  out.rolling = contact.number("rolling", kNonNegative, 0);
  return out;
}

ContactPair read_no_contact(const XmlElement& pair) {
  pair.expect_only({"first", "second"});
  return read_pair(pair);
}

std::vector<ContactPair> read_srdf(const XmlElement& no_contact) {
  no_contact.expect_only({"srdf"});
  const std::string url = no_contact.text("srdf").value_or("");
  if (url.empty()) return {};
  tinyxml2::XMLDocument document;
  try {
    const std::string path = path_of_resource(url, no_contact.findings().file());
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("there is no file " + path);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    Findings inside(path);
    if (!parse_xml(text, document, inside)) throw std::runtime_error(inside.take().front().text());
    if (!document.RootElement()) throw std::runtime_error(path + " is empty");
  } catch (const std::runtime_error& error) {
    no_contact.attribute_error("srdf", fmt::format("its file cannot be read: {}", error.what()));
    return {};
  }
  std::vector<ContactPair> out;
  for (const auto* each = document.RootElement()->FirstChildElement("disable_collisions"); each;
       each = each->NextSiblingElement("disable_collisions")) {
    const char *first = each->Attribute("link1"), *second = each->Attribute("link2");
    if (first && second) out.push_back({first, second, no_contact.location()});
  }
  return out;
}

void read_surface(const XmlElement& gazebo, SceneDescription& scene) {
  const char* const link = gazebo.xml().Attribute("reference");
  if (!link) return;
  SurfaceHints hints;
  // These values are meant for another program (Gazebo), so one that is not a number is ignored.
  const auto hint = [&](const char* tag) -> std::optional<double> {
    const std::optional<XmlElement> child = gazebo.child(tag);
    const char* const text = child ? child->xml().GetText() : nullptr;
    if (!text) return std::nullopt;
    std::string_view words = text;
    const std::optional<double> number = parse_number(next_word(words));
    return number && *number >= 0 && *number <= 1e60 ? number : std::nullopt;
  };
  for (const char* tag : {"mu1", "mu2"})
    if (const std::optional<double> number = hint(tag))
      hints.friction = std::min(hints.friction.value_or(*number), *number);
  if (const std::optional<double> number = hint("kp"); number && *number > 0) hints.stiffness = number;
  if (hints.friction || hints.stiffness) scene.surfaces[link] = hints;
}

void check_contacts(const SceneDescription& scene, Findings& findings) {
  std::set<std::string> links, sides = {kAllBodies};
  for (const LinkDescription& link : scene.links) links.insert(link.name);
  sides.insert(links.begin(), links.end());
  const auto element = [&](const char* tag) { return fmt::format("<{}> of robot {}", tag, quoted(scene.name)); };
  for (const GroundDescription& ground : scene.grounds)
    if (!ground.name.empty() && !sides.insert(ground.name).second)
      findings.error(ground.location.line, element("ground"),
                     "its name must differ from those of all links and other grounds", quoted(ground.name));
  std::vector<std::string> candidates(sides.begin(), sides.end());
  candidates.erase(std::find(candidates.begin(), candidates.end(), kAllBodies));
  std::set<std::pair<std::string, std::string>> named;
  const auto has_line = [&](const std::string& name) {
    const auto is_it = [&](const LinkDescription& link) { return link.name == name; };
    const auto link = std::find_if(scene.links.begin(), scene.links.end(), is_it);
    return link != scene.links.end() && link->beam && link->collisions.empty();
  };
  const auto check = [&](const ContactPair& pair, const std::string& who) {
    if (pair.first.empty() || pair.second.empty()) return;  // an error about it is recorded already
    for (const auto& [attribute, side] : {std::pair("first", pair.first), std::pair("second", pair.second)})
      if (sides.count(side) == 0)
        findings.error(pair.location.line, who,
                       std::string(attribute) + " must be a link or a ground of the scene" +
                           findings.candidates(side, candidates) + ", or *",
                       quoted(side));
    if (pair.first == pair.second && pair.first != kAllBodies && !has_line(pair.first))
      findings.error(pair.location.line, who,
                     "first and second must be different, except for a beam without <collision>", quoted(pair.first));
    if (!named.insert(std::minmax(pair.first, pair.second)).second)
      findings.error(pair.location.line, who, "must be the only <contact> or <no_contact> of its pair",
                     quoted(pair.first) + " and " + quoted(pair.second));
  };
  for (const ContactDescription& contact : scene.contacts) check(contact, element("contact"));
  for (const ContactPair& pair : scene.no_contacts) check(pair, element("no_contact"));
}

void add_disabled_pairs(const std::vector<ContactPair>& pairs, SceneDescription& scene) {
  std::set<std::string> links;
  for (const LinkDescription& link : scene.links) links.insert(link.name);
  std::set<std::pair<std::string, std::string>> named;
  for (const ContactPair& pair : scene.contacts) named.insert(std::minmax(pair.first, pair.second));
  for (const ContactPair& pair : scene.no_contacts) named.insert(std::minmax(pair.first, pair.second));
  for (const ContactPair& pair : pairs)
    if (links.count(pair.first) > 0 && links.count(pair.second) > 0 &&
        named.insert(std::minmax(pair.first, pair.second)).second)
      scene.no_contacts.push_back(pair);
}

}  // namespace flexarm::scene
