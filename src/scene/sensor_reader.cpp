#include "scene/readers.h"
#include "scene/scene_names.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <sstream>

#include <fmt/format.h>

namespace flexarm::scene {
namespace {

constexpr std::size_t kMostErrors = 6;
/// The upper bound lets the samples of a run of years be counted.
constexpr NumberRange kRate{"> 0 and at most 1e9", [](double x) { return x > 0 && x <= 1e9; }};

/// Reads `noise` or `bias`: one number for all channels, or `count` numbers.
std::vector<double> read_errors(const XmlElement& sensor, const char* attribute, std::size_t count) {
  if (!sensor.has(attribute)) return {};
  std::vector<double> errors = sensor.all_numbers(attribute, kMostErrors).value_or(std::vector<double>());
  if (errors.empty() || errors.size() == 1 || errors.size() == count) return errors;
  sensor.attribute_error(attribute, count == 1 ? fmt::format("{} must be 1 number", attribute)
                                               : fmt::format("{} must be 1 number or {}", attribute, count));
  return {};
}

/// Reads names that are separated by white space.
std::vector<std::string> read_group(const XmlElement& sensor) {
  const std::optional<std::string> text = sensor.text("group");
  std::istringstream words(text.value_or(""));
  std::vector<std::string> names{std::istream_iterator<std::string>(words), {}};
  if (text && names.empty()) sensor.attribute_error("group", "group must be names of links or grounds");
  return names;
}

}  // namespace

Sensor read_sensor(const XmlElement& unnamed) {
  Sensor out;
  out.name = unnamed.name("name").value_or("");
  out.location = unnamed.location();
  const XmlElement sensor = unnamed.with_name(out.name);
  sensor.expect_only({"name", "kind", "link", "joint", "group", "tendon", "at", "rate", "noise", "bias", "seed"});
  const SensorTraits* kind = read_row(sensor, "kind", sensor_kinds());
  if (kind && kind->place == SensedPlace::Tendon) {
    out.tendon = sensor.name("tendon").value_or("");
    for (const char* attribute : {"link", "joint", "group", "at"})
      if (sensor.has(attribute)) sensor.attribute_error(attribute, "a sensor of a tendon has no such attribute");
  } else {
    out.link = sensor.name("link").value_or("");
    if (sensor.has("tendon")) sensor.attribute_error("tendon", "tendon is for sensors of kind tendon");
  }
  if (sensor.has("joint")) out.joint = sensor.name("joint").value_or("");
  if (sensor.has("group")) out.group = read_group(sensor);
  out.at = sensor.vector("at", out.at);
  if (sensor.has("rate")) out.rate = sensor.number("rate", kRate).value_or(0);
  if (sensor.has("seed")) out.seed = sensor.integer("seed", 0, std::numeric_limits<int>::max()).value_or(0);
  if (!kind) return out;
  out.kind = kind->kind;
  out.noise = read_errors(sensor, "noise", kind->errors);
  out.bias = read_errors(sensor, "bias", kind->errors);
  if (std::any_of(out.noise.begin(), out.noise.end(), [](double deviation) { return deviation < 0; }))
    sensor.attribute_error("noise", "noise is a standard deviation, >= 0");
  return out;
}

void connect_tendon_sensors(SceneDescription& scene, Findings& findings) {
  for (Sensor& sensor : scene.sensors) {
    if (traits_of(sensor.kind).place != SensedPlace::Tendon || sensor.tendon.empty()) continue;
    const std::size_t tendon = find_force_element(scene, "tendon", sensor.tendon);
    if (tendon == scene.force_elements.size())
      findings.error(sensor.location.line, "<sensor> " + quoted(sensor.name),
                     "tendon must be the name of a <tendon>" +
                         findings.candidates(sensor.tendon, force_element_names(scene, "tendon")),
                     quoted(sensor.tendon));
    else if (const std::vector<LinkPoint> points = scene.force_elements[tendon]->points(); !points.empty())
      sensor.link = points.front().link;
  }
}

}  // namespace flexarm::scene
