#include "scene/hydraulics_reader.h"

#include <algorithm>

#include <fmt/format.h>

#include "elements/hydraulic_cylinder.h"
#include "flexarm/model/model_error.h"
#include "math/pi.h"
#include "scene/readers.h"
#include "scene/standard_reader.h"

namespace flexarm::scene {
namespace {

constexpr NumberRange kBore{"from 1e-6 to 1e3", [](double x) { return x >= 1e-6 && x <= 1e3; }};
constexpr NumberRange kBulkModulus{"> 0 and at most 1e15", [](double x) { return x > 0 && x <= 1e15; }};
constexpr NumberRange kVolume{"> 0 and at most 1e9", [](double x) { return x > 0 && x <= 1e9; }};
constexpr Choice<bool> kMakesUp[] = {{"true", true}, {"false", false}};

// If the scene gives none:
constexpr double kPressure = 1e6;      // on the piston's side [Pa], but at most:
constexpr double kCompression = 0.01;  // relative to the bulk modulus
constexpr double kDeadVolume = 0.1;    // of what the piston sweeps

constexpr double kMostPressure = 0.5;  // relative to the bulk modulus; the law of oil is for small compressions

using Pair = std::array<std::optional<double>, 2>;

/// Reads an attribute with a number for the piston's side, and perhaps one for the rod's side.
Pair read_pair(const XmlElement& element, const char* attribute, const NumberRange& range) {
  if (!element.has(attribute)) return {};
  const std::optional<std::vector<double>> values = element.all_numbers(attribute, 2);
  if (!values) return {};
  if (values->empty() || !std::all_of(values->begin(), values->end(), range.holds)) {
    element.attribute_error(attribute, fmt::format("{} must be one or two numbers {}", attribute, range.text));
    return {};
  }
  return {values->front(), values->size() == 2 ? std::optional<double>(values->back()) : std::nullopt};
}

void read_areas(const XmlElement& element, HydraulicsDescription& oil) {
  const auto area = [](double diameter) { return 0.25 * kPi * diameter * diameter; };
  const double bore = element.number("bore", kBore).value_or(1);
  const double rod = element.number("rod", kNonNegative, 0);
  oil.chambers[0].area = area(bore);
  oil.chambers[1].area = area(bore) - area(rod);
  if (oil.chambers[1].area > 0) return;
  element.attribute_error("rod", fmt::format("rod must be less than bore, which is {:g}", bore));
  oil.chambers[1].area = oil.chambers[0].area;  // for the checks of other attributes
}

void read_volumes(const XmlElement& element, const JointDescription& travel, HydraulicsDescription& oil) {
  if (!travel.limits || !(travel.limits->lower < travel.limits->upper)) {
    element.error("needs the stroke of the cylinder: <limit lower=\"\" upper=\"\"/> with lower < upper");
    return;
  }
  oil.lower = travel.limits->lower;
  oil.upper = travel.limits->upper;
  const Pair given = read_pair(element, "dead_volume", kVolume);
  for (int i = 0; i < 2; ++i) {
    const double usual = kDeadVolume * oil.chambers[i].area * (oil.upper - oil.lower);
    oil.chambers[i].dead_volume = given[i].value_or(given[0].value_or(usual));
  }
}

void check_pressures(const XmlElement& element, const HydraulicsDescription::Chamber& chamber, double most) {
  const double relief = chamber.relief_pressure.value_or(most);
  if (relief > most)
    element.attribute_error("relief_pressure",
                            fmt::format("relief_pressure must be at most half the bulk modulus, {:g} Pa", most));
  else if (chamber.pressure > most)
    element.error(fmt::format("pressures must be at most half the bulk modulus, {:g} Pa", most),
                  fmt::format("'{:g}' Pa at the start", chamber.pressure));
  else if (chamber.pressure > relief)
    element.error(fmt::format("pressures at the start must be at most relief_pressure, {:g} Pa", relief),
                  fmt::format("'{:g}' Pa", chamber.pressure));
}

void read_pressures(const XmlElement& element, HydraulicsDescription& oil) {
  auto& [piston, rod] = oil.chambers;
  oil.bulk_modulus = element.number("bulk_modulus", kBulkModulus).value_or(1e9);
  const Pair start = read_pair(element, "pressure", kNonNegative);
  piston.pressure = start[0].value_or(std::min(kPressure, kCompression * oil.bulk_modulus));
  rod.pressure = start[1].value_or(piston.pressure * piston.area / rod.area);  // no force
  const Pair relief = read_pair(element, "relief_pressure", kPositive);
  piston.relief_pressure = relief[0];
  rod.relief_pressure = relief[1] ? relief[1] : relief[0];
  const std::size_t errors = element.findings().error_count();
  for (const HydraulicsDescription::Chamber& chamber : oil.chambers)
    if (element.findings().error_count() == errors) check_pressures(element, chamber, kMostPressure * oil.bulk_modulus);
}

JointDescription read_pump(const XmlElement& unnamed) {
  JointDescription travel;
  travel.name = unnamed.name("name").value_or("");
  travel.location = unnamed.location();
  travel.kind = JointKind::Prismatic;
  const XmlElement pump = unnamed.with_name(travel.name);
  pump.expect_only({"name"}, {"limit", "dynamics", "friction", "spring", "drive", "servo"});
  pump.expect_at_most_one({"spring", "drive", "servo"});
  read_travel(pump, travel, kAnyNumber);
  return travel;
}

}  // namespace

ReadHydraulics read_hydraulics(const XmlElement& element, const JointDescription& travel) {
  element.expect_only({"bore", "rod", "bulk_modulus", "dead_volume", "pressure", "relief_pressure", "makeup", "flow"},
                      {"pump"});
  element.expect_at_most_one({"pump"});
  ReadHydraulics out;
  out.oil = std::make_shared<HydraulicsDescription>();
  out.oil->name = travel.name;
  out.oil->location = element.location();
  read_areas(element, *out.oil);
  read_volumes(element, travel, *out.oil);
  read_pressures(element, *out.oil);
  out.oil->makes_up = read_choice(element, "makeup", kMakesUp, true);
  if (element.has("flow")) out.oil->flow = element.function("flow");
  if (const std::optional<XmlElement> pump = element.child("pump")) out.pump = read_pump(*pump);
  return out;
}

std::vector<LinkPoint> HydraulicsDescription::points() const {
  std::vector<LinkPoint> out = {{"barrel", barrel, barrel_at}, {"rod", rod, rod_at}};
  if (!reel.empty()) out.push_back({kReel, reel, Vector3::Zero()});
  return out;
}

std::vector<TimeFunction> HydraulicsDescription::functions() const {
  return flow ? std::vector<TimeFunction>{*flow} : std::vector<TimeFunction>{};
}

std::vector<double> HydraulicsDescription::numbers() const {
  std::vector<double> out = {lower, upper, bulk_modulus, makes_up ? 1.0 : 0.0};
  for (const Chamber& chamber : chambers)
    out.insert(out.end(), {chamber.area, chamber.dead_volume, chamber.pressure, chamber.relief_pressure.value_or(0)});
  return out;
}

std::shared_ptr<ForceElementDescription> HydraulicsDescription::with_links(const LinkChanges& change) const {
  auto out = std::make_shared<HydraulicsDescription>(*this);
  const LinkChange of_barrel = change(barrel), of_rod = change(rod);
  out->barrel = of_barrel.name, out->barrel_at = of_barrel.frame * barrel_at;
  out->rod = of_rod.name, out->rod_at = of_rod.frame * rod_at;
  if (!reel.empty()) out->reel = change(reel).name;
  return out;
}

std::shared_ptr<const ForceElement> HydraulicsDescription::place(const ForcePlacement& placement) const {
  CylinderPlan plan;
  plan.barrel = placement.places[0];
  plan.rod = placement.places[1];
  plan.start_length = (placement.positions[1] - placement.positions[0]).norm();
  if (!reel.empty()) {
    // The coordinate counts from the world's origin.
    plan.pump = {placement.places[2].node, -placement.origin.x(), placement.positions[2].x()};
  }
  for (int i = 0; i < 2; ++i) {
    const Chamber& given = chambers[i];
    CylinderPlan::Chamber& chamber = plan.chambers[i];
    chamber.oil.bulk_modulus = bulk_modulus;
    chamber.oil.makes_up = makes_up;
    if (given.relief_pressure) chamber.oil.relief_pressure = *given.relief_pressure;
    chamber.start_pressure = given.pressure;
    chamber.area = i == 0 ? given.area : -given.area;
    chamber.volume = given.dead_volume + (i == 0 ? -given.area * lower : given.area * upper);
    if (!(chamber.volume + chamber.area * plan.start_length > 0))
      throw ModelError(fmt::format(
          "{}:{}: <hydraulics> of cylinder '{}': its length at the start, {:g} m, is so far beyond its limits, "
          "{:g} to {:g}, that a chamber has no volume",
          location.file, location.line, name, plan.start_length, lower, upper));
  }
  return std::make_shared<HydraulicCylinder>(name, plan, placement.functions);
}

}  // namespace flexarm::scene
