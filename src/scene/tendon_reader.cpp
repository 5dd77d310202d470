#include "scene/tendon_reader.h"

#include <cmath>

#include <fmt/format.h>

#include "elements/tendon.h"
#include "flexarm/model/model_error.h"
#include "flexarm/scene/tendon.h"
#include "scene/limits.h"

namespace flexarm::scene {
namespace {

/// A shorter line counts as one without length [m]. The pieces between coinciding guides are 1e-8 m long.
constexpr double kShortest = 1e-7;

flexarm::TendonGuide placed(const TendonDescription::Guide& guide, const NodePoint& place) {
  flexarm::TendonGuide out;
  out.place.node = place.node;
  out.place.centre = place.arm;
  out.friction = guide.friction;
  if (guide.radius == 0) return out;
  const Vector3 axis = place.orientation * guide.axis;
  out.place.first = axis.unitOrthogonal();
  out.place.second = axis.cross(out.place.first);
  out.place.radius = guide.radius;
  out.place.sense = guide.turns_left ? 1 : -1;
  out.grips = guide.grips;
  out.wrap = guide.wrap;
  return out;
}

}  // namespace

std::vector<LinkPoint> TendonDescription::points() const {
  std::vector<LinkPoint> out;
  for (const Guide& guide : guides) out.push_back({"link", guide.link, guide.at});
  for (const std::string& reel : reels) out.push_back({kReel, reel, Vector3::Zero()});
  return out;
}

std::vector<TimeFunction> TendonDescription::functions() const {
  if (tension) return {*tension};
  return rest_length ? std::vector<TimeFunction>{*rest_length} : std::vector<TimeFunction>{};
}

std::vector<double> TendonDescription::numbers() const {
  std::vector<double> out = {stiffness, damping, tension ? 1.0 : 0.0, static_cast<double>(guides.size())};
  for (const Guide& guide : guides) {
    out.push_back(guide.friction);
    if (guide.radius == 0) continue;
    out.insert(out.end(), {guide.radius, guide.axis[0], guide.axis[1], guide.axis[2], guide.turns_left ? 1.0 : -1.0,
                           guide.grips ? 1.0 : 0.0, guide.wrap});
  }
  return out;
}

std::shared_ptr<ForceElementDescription> TendonDescription::with_links(const LinkChanges& change) const {
  auto out = std::make_shared<TendonDescription>(*this);
  for (Guide& guide : out->guides) {
    const auto [link, frame] = change(guide.link);
    guide.link = link;
    guide.at = frame * guide.at;
    guide.axis = frame.orientation * guide.axis;
  }
  for (std::string& reel : out->reels) reel = change(reel).name;
  return out;
}

std::shared_ptr<const ForceElement> TendonDescription::place(const ForcePlacement& placement) const {
  TendonPlan plan;
  for (std::size_t i = 0; i < guides.size(); ++i) plan.guides.push_back(placed(guides[i], placement.places[i]));
  for (std::size_t i = guides.size(); i < placement.places.size(); ++i) {
    const int node = placement.places[i].node;
    // The coordinate counts from the world's origin. A line that is as long as at the start does so with any of its
    // values.
    const double at_zero = -placement.origin.x(), now = placement.positions[i].x();
    plan.winches.push_back({node, Vector3::UnitX(), rest_length ? at_zero : now, now});
  }
  plan.has_tension = tension.has_value();
  plan.law = {stiffness, damping};
  const auto element = std::make_shared<Tendon>(name, std::move(plan), placement.functions, *placement.nodes);
  if (const double length = element->length_at_start(); !std::isfinite(length))
    throw ModelError(
        fmt::format("{}:{}: <tendon> '{}': a guide is inside the rim of the pulley next to it, or two "
                    "pulleys overlap",
                    location.file, location.line, name));
  else if (length < kShortest)
    throw ModelError(fmt::format("{}:{}: <tendon> '{}': its length is 0", location.file, location.line, name));
  return element;
}

// ---------------------------------------------------------------- reading

namespace {

void read_link_and_place(const XmlElement& guide, TendonDescription::Guide& out) {
  out.link = guide.name("link").value_or("");
  out.at = guide.vector("at", out.at);
  out.friction = guide.number("friction", kNonNegative, 0);
}

TendonDescription::Guide read_via(const XmlElement& via) {
  via.expect_only({"link", "at", "friction"});
  TendonDescription::Guide out;
  read_link_and_place(via, out);
  return out;
}

TendonDescription::Guide read_pulley(const XmlElement& pulley) {
  pulley.expect_only({"link", "at", "axis", "radius", "side", "grips", "wrap", "friction"});
  constexpr Choice<bool> kSides[] = {{"left", true}, {"right", false}};
  constexpr Choice<bool> kGrips[] = {{"true", true}, {"false", false}};
  TendonDescription::Guide out;
  read_link_and_place(pulley, out);
  out.radius = pulley.number("radius", kPositive).value_or(1);
  if (pulley.has("axis")) out.axis = pulley.direction("axis").value_or(out.axis);
  out.turns_left = read_choice(pulley, "side", kSides, true);
  out.grips = read_choice(pulley, "grips", kGrips, false);
  out.wrap = pulley.number("wrap", kNonNegative, out.wrap);
  if (out.grips && pulley.has("friction"))
    pulley.attribute_error("friction", "on a pulley that grips the line never slips; leave this out");
  return out;
}

/// Reads <vias>: points at equal distances on a straight line, or on a helix about it.
void read_vias(const XmlElement& vias, std::vector<TendonDescription::Guide>& out) {
  vias.expect_only({"link", "from", "to", "count", "radius", "phase", "twist", "friction"});
  const double friction = vias.number("friction", kNonNegative, 0);
  const std::string link = vias.name("link").value_or("");
  const std::optional<Vector3> from = vias.vector("from"), to = vias.vector("to");
  const std::optional<int> count = vias.integer("count", 2, kMostVias);
  const double radius = vias.number("radius", kNonNegative, 0);
  const double phase = vias.number("phase", kAnyNumber, 0), twist = vias.number("twist", kAnyNumber, 0);
  if (!from || !to || !count) return;
  const Vector3 way = *to - *from;
  if (way.norm() == 0) {
    vias.attribute_error("to", "`to` must be another point than `from`");
    return;
  }
  // The angle counts from the link's y axis, or from z if the line has the direction of y.
  const Vector3 axis = way.normalized();
  const Vector3 reference = std::abs(axis.y()) < 0.9 ? Vector3::UnitY() : Vector3::UnitZ();
  const Vector3 first = (reference - reference.dot(axis) * axis).normalized(), second = axis.cross(first);
  for (int i = 0; i < *count; ++i) {
    const double part = static_cast<double>(i) / (*count - 1), angle = phase + part * twist;
    TendonDescription::Guide guide;
    guide.link = link;
    guide.friction = friction;
    guide.at = *from + part * way + radius * (std::cos(angle) * first + std::sin(angle) * second);
    out.push_back(guide);
  }
}

/// Checks what several attributes or guides must have together.
void check(const XmlElement& tendon, const TendonDescription& description) {
  if (description.guides.size() < 2) tendon.error("needs at least two <via> or <pulley>");
  if (description.guides.size() > std::size_t{kMostVias}) tendon.error(fmt::format("may have {} points", kMostVias));
  for (const TendonDescription::Guide& guide : description.guides)
    if ((guide.friction > 0 || guide.grips) && tendon.has("tension")) {
      tendon.error("a line of given tension has the same tension everywhere: friction and grip need ea");
      break;
    }
  if (description.guides.empty()) return;
  for (const TendonDescription::Guide* end : {&description.guides.front(), &description.guides.back()})
    if (end->radius > 0 && !end->grips) tendon.error("must not begin or end on a pulley without grips=\"true\"");
}

}  // namespace

std::shared_ptr<const ForceElementDescription> read_tendon(const XmlElement& unnamed) {
  auto out = std::make_shared<TendonDescription>();
  if (unnamed.has("name")) out->name = unnamed.name("name").value_or("");
  const XmlElement tendon = out->name.empty() ? unnamed : unnamed.with_name(out->name);
  out->location = tendon.location();
  tendon.expect_only({"name", "ea", "damping", "rest_length", "tension"}, {"via", "vias", "pulley"});
  for (const XmlElement& child : tendon.children()) {
    if (child.tag() == "via") out->guides.push_back(read_via(child));
    if (child.tag() == "pulley") out->guides.push_back(read_pulley(child));
    if (child.tag() == "vias") read_vias(child, out->guides);
  }
  if (tendon.has("tension")) {
    for (const char* attribute : {"ea", "damping", "rest_length"})
      if (tendon.has(attribute)) tendon.attribute_error(attribute, "a tendon of given tension has no such attribute");
    out->tension = tendon.function("tension");
  } else {
    out->stiffness = tendon.number("ea", kPositive).value_or(1);
    out->damping = tendon.number("damping", kNonNegative, 0);
    if (tendon.has("rest_length")) out->rest_length = tendon.function("rest_length");
    if (out->rest_length && !((*out->rest_length)(0) > 0))
      tendon.attribute_error("rest_length", "rest_length must be > 0 at t = 0");
  }
  check(tendon, *out);
  return out;
}

}  // namespace flexarm::scene
