#include "scene/readers.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "math/number_text.h"
#include "scene/limits.h"

namespace flexarm::scene {
namespace {

/// The gear ratio. The rotor adds its inertia times the square of this to the joint's inertia, hence the upper bound.
constexpr NumberRange kGear{"> 0 and at most 1e9", [](double x) { return x > 0 && x <= 1e9; }};
constexpr NumberRange kEfficiency{"> 0 and at most 1", [](double x) { return x > 0 && x <= 1; }};

/// Relative difference up to which two gear ratios count as equal: files may give them with few digits.
constexpr double kSameRatio = 1e-6;

/// The name of the coordinate on which an element acts: its `joint`, or the <cylinder>, <winch> or <pump> whose
/// child it is.
std::string coordinate_of(const XmlElement& element) {
  const tinyxml2::XMLElement* parent = element.xml().Parent() ? element.xml().Parent()->ToElement() : nullptr;
  const std::string_view tag = parent ? parent->Name() : "";
  if (tag != "cylinder" && tag != "winch" && tag != "pump") return element.text("joint").value_or("");
  if (element.has("joint"))
    element.attribute_error("joint", "it acts on its <" + std::string(tag) + ">; leave this out");
  const char* name = parent->Attribute("name");
  return name ? name : "";
}

/// Records errors for attributes that contradict each other, and for attributes without others that they require.
void check_conditions(const XmlElement& drive, const DriveDescription& description) {
  if (drive.has("damping") && drive.has("damping_ratio"))
    drive.attribute_error("damping_ratio", "damping is given already; leave out one of the two");
  for (const char* attribute : {"damping", "damping_ratio", "backlash"})
    if (drive.has(attribute) && !drive.has("stiffness"))
      drive.attribute_error(attribute, "a rigid gear has none; give its stiffness > 0, or leave this out");
  if (drive.has("stiffness") && description.rotor_inertia <= 0)
    drive.error("an elastic gear needs the inertia of the rotor behind it, rotor_inertia > 0");
  if (drive.has("velocity_limit") && !drive.has("effort_limit"))
    drive.attribute_error("velocity_limit", "the line from rest to the no-load speed begins at effort_limit: give it");
  if (!drive.has("stiffness") && description.efficiency <= 0.5)
    drive.attribute_error("efficiency",
                          "a rigid gear with an efficiency of at most 0.5 is self-locking under any load; give it a "
                          "stiffness, or an efficiency above 0.5");
}

constexpr Choice<ServoDescription::Mode> kModes[] = {{"effort", ServoDescription::Mode::Effort},
                                                     {"velocity", ServoDescription::Mode::Velocity},
                                                     {"position", ServoDescription::Mode::Position}};
constexpr Choice<ServoDescription::Side> kSides[] = {{"motor", ServoDescription::Side::Motor},
                                                     {"link", ServoDescription::Side::Link}};

/// Records errors for gains that the mode does not use, and for attributes without others that they require.
void check_gains(const XmlElement& servo, ServoDescription::Mode mode) {
  const auto refuse = [&](const char* attribute, const char* why) {
    if (servo.has(attribute)) servo.attribute_error(attribute, why);
  };
  if (mode == ServoDescription::Mode::Effort) {
    for (const char* gain : {"kp", "kd", "ki", "anti_windup"})
      refuse(gain, "mode 'effort' has no error to control; leave this out");
  } else if (mode == ServoDescription::Mode::Velocity) {
    refuse("kd", "mode 'velocity' has kp and ki only; leave this out");
  }
  if (!servo.has("ki")) refuse("anti_windup", "there is no integral without ki; leave this out");
  if (!servo.has("sample_time")) refuse("delay", "only a sampled servo has a delay; give its sample_time > 0");
  if (servo.has("delay") && servo.has("sample_time")) {
    const double delay = servo.number("delay", kNonNegative, 0);
    const double period = servo.number("sample_time", kPositive).value_or(delay);
    if (delay > kLongestDelay * period)
      servo.attribute_error("delay", fmt::format("delay must be at most {} sample times", kLongestDelay));
  }
}

/// Returns the children with this tag.
std::vector<XmlElement> children(const XmlElement& element, const char* tag) {
  std::vector<XmlElement> out;
  for (const XmlElement& child : element.children())
    if (child.tag() == tag) out.push_back(child);
  return out;
}

/// Reads the children <gains>: the gains of modes other than `mode`, the servo's own.
std::vector<ServoDescription::Gains> read_other_modes(const XmlElement& servo, ServoDescription::Mode mode) {
  std::vector<ServoDescription::Gains> out;
  for (const XmlElement& gains : children(servo, "gains")) {
    gains.expect_only({"mode", "kp", "kd", "ki", "anti_windup"});
    const std::optional<ServoDescription::Mode> other = read_choice(gains, "mode", kModes);
    if (!other) continue;
    check_gains(gains, *other);
    const auto is_same = [&](const ServoDescription::Gains& earlier) { return earlier.mode == *other; };
    if (*other == mode || std::any_of(out.begin(), out.end(), is_same))
      gains.attribute_error("mode", "the gains of this mode are given already");
    else if (*other == ServoDescription::Mode::Effort)
      gains.attribute_error("mode", "mode 'effort' needs no gains, and is always there; leave this out");
    else
      out.push_back({*other, gains.number("kp", kNonNegative, 0), gains.number("kd", kNonNegative, 0),
                     gains.number("ki", kNonNegative, 0),
                     gains.has("anti_windup") ? gains.number("anti_windup", kPositive).value_or(0) : 0});
  }
  return out;
}

}  // namespace

SpringDescription read_spring(const XmlElement& spring) {
  spring.expect_only({"joint", "stiffness", "rest", "damping_ratio"});
  return {coordinate_of(spring), spring.number("stiffness", kNonNegative).value_or(0),
          spring.number("rest", kAnyNumber, 0), spring.location(), spring.number("damping_ratio", kNonNegative, 0)};
}

DriveDescription read_drive(const XmlElement& drive) {
  drive.expect_only({"joint", "gear", "rotor_inertia", "stiffness", "damping", "damping_ratio", "backlash", "friction",
                     "efficiency", "effort_limit", "velocity_limit", "axis"});
  DriveDescription out;
  out.location = drive.location();
  out.coordinate = coordinate_of(drive);
  if (drive.has("gear")) out.gear = drive.number("gear", kGear);
  out.rotor_inertia = drive.number("rotor_inertia", kNonNegative, 0);
  if (drive.has("stiffness")) out.stiffness = drive.number("stiffness", kPositive);
  out.damping = drive.number("damping", kNonNegative, 0);
  out.damping_ratio = drive.number("damping_ratio", kNonNegative, 0);
  out.backlash = drive.number("backlash", kNonNegative, 0);
  out.friction = drive.number("friction", kNonNegative, 0);
  out.efficiency = drive.number("efficiency", kEfficiency, 1);
  if (drive.has("effort_limit")) out.effort_limit = drive.number("effort_limit", kPositive).value_or(0);
  if (drive.has("velocity_limit")) out.velocity_limit = drive.number("velocity_limit", kPositive).value_or(0);
  if (drive.has("axis")) out.axis = drive.direction("axis");
  check_conditions(drive, out);
  return out;
}

ServoDescription read_servo(const XmlElement& servo) {
  servo.expect_only({"joint", "mode", "kp", "kd", "ki", "set_point", "feedforward", "effort_limit", "anti_windup",
                     "side", "sample_time", "delay"},
                    {"gains"});
  ServoDescription out;
  out.location = servo.location();
  out.coordinate = coordinate_of(servo);
  const std::optional<ServoDescription::Mode> mode = read_choice(servo, "mode", kModes);
  out.mode = mode.value_or(out.mode);
  out.kp = servo.number("kp", kNonNegative, 0);
  out.kd = servo.number("kd", kNonNegative, 0);
  out.ki = servo.number("ki", kNonNegative, 0);
  if (servo.has("set_point")) out.set_point = servo.function("set_point");
  if (servo.has("feedforward")) out.feedforward = servo.function("feedforward");
  if (servo.has("effort_limit")) out.effort_limit = servo.number("effort_limit", kPositive).value_or(0);
  if (servo.has("anti_windup")) out.anti_windup = servo.number("anti_windup", kPositive).value_or(0);
  out.side = read_choice(servo, "side", kSides, out.side);
  if (servo.has("sample_time")) out.sample_time = servo.number("sample_time", kPositive).value_or(0);
  out.delay = servo.number("delay", kNonNegative, 0);
  if (mode) check_gains(servo, *mode);
  if (mode) out.other_modes = read_other_modes(servo, *mode);
  return out;
}

std::optional<Transmission> read_transmission(const XmlElement& transmission) {
  const std::vector<XmlElement> joints = children(transmission, "joint");
  const std::vector<XmlElement> actuators = children(transmission, "actuator");
  if (joints.size() != 1 || actuators.size() > 1) return std::nullopt;
  const char* joint = joints.front().xml().Attribute("name");
  std::optional<XmlElement> reduction;
  for (const std::vector<XmlElement>* places : {&joints, &actuators})  // older files have it in <joint>
    for (const XmlElement& place : *places)
      if (const std::optional<XmlElement> found = place.child("mechanicalReduction")) reduction = found;
  if (!joint || !reduction) return std::nullopt;
  const char* text = reduction->xml().GetText();
  return Transmission{joint, text ? text : "", reduction->line()};
}

void settle_gears(const std::vector<Transmission>& transmissions, std::vector<DriveDescription>& drives,
                  Findings& findings) {
  std::map<std::string, const Transmission*> of_joint;
  for (const Transmission& transmission : transmissions) of_joint.emplace(transmission.joint, &transmission);
  std::vector<std::string> odd;  // "'elbow' (100, line 7 has 1)"
  int line = 0;
  for (DriveDescription& drive : drives) {
    const auto found = of_joint.find(drive.coordinate);
    if (found == of_joint.end()) continue;
    const Transmission& transmission = *found->second;
    std::string_view text = transmission.reduction;
    const std::optional<double> reduction = parse_number(next_word(text));
    if (!reduction || *reduction == 0 || !next_word(text).empty()) {
      findings.error(transmission.line, "<mechanicalReduction> of the transmission of " + quoted(drive.coordinate),
                     "a number different from 0 is expected, since the joint has a <drive>",
                     quoted(transmission.reduction));
      continue;
    }
    const double ratio = std::abs(*reduction);  // the sign is only the motor's sense of rotation
    if (!drive.gear) drive.gear = ratio;
    if (std::abs(*drive.gear - ratio) <= kSameRatio * ratio) continue;
    if (odd.empty()) line = drive.location.line;
    odd.push_back(
        fmt::format("{} ({}, line {} has {})", quoted(drive.coordinate), *drive.gear, transmission.line, ratio));
  }
  // One warning for all joints: most exporters write a reduction of 1 for every joint.
  if (!odd.empty())
    findings.warning(line, "<drive> of robot",
                     fmt::format("gear counts, not the <mechanicalReduction> of the joint's <transmission>: {}",
                                 fmt::join(odd, ", ")));
}

}  // namespace flexarm::scene
