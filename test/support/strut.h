#pragma once
/// A kind of force element that exists only in tests. It shows what a new kind needs, from its line in the scene to its
/// columns of results.

#include "elements/line_element.h"
#include "flexarm/scene/force_element.h"
#include "scene/force_element_kinds.h"
#include "scene/xml_element.h"

namespace flexarm::test {

/// A strut between two points: a damper with the tension linear v + cubic v^3, where v is the rate at which the points
/// move apart, and a constant push from outside. It sums up the energy that it dissipates.
struct StrutLaw {
  double linear = 0;  ///< [N s/m]
  double cubic = 0;   ///< [N s^3/m^3]
  double push = 0;    ///< [N]
};

class Strut : public LineElement {
 public:
  Strut(std::string name, const NodePoint& from, const NodePoint& to, const StrutLaw& law)
      : LineElement(std::move(name), from, to), law_(law) {}

  const char* kind() const override { return "strut"; }
  std::string description() const override { return "pushes by " + std::to_string(law_.push) + " N"; }
  int memory_size() const override { return 1; }
  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override {
    LineElement::evaluate(step, nodes, action);
    *step.new_memory = *step.memory + action.dissipated;
  }
  std::vector<ForceOutput> outputs() const override { return {{"length", "m"}, {"tension", "N"}, {"dissipated", "J"}}; }
  void put_out(const ForceMotion& motion, std::vector<double>& values) const override {
    LineElement::put_out(motion, values);
    values.push_back(motion.memory[0]);
  }

 private:
  LineTension tension(const CoordinateStep& change) const override {
    LineTension out{-law_.push, 0, 0, law_.push * change.increment};
    if (change.step == 0) return out;
    const LineTension damping = damper(rate_of(change));
    out.value += damping.value;
    out.slope = damping.slope * rate_slope(change);
    out.dissipated = damping.value * change.increment;
    return out;
  }
  double energy(double) const override { return 0; }
  LineTension elastic(double) const override { return {-law_.push, 0}; }
  LineTension damper(double v) const override {
    return {law_.linear * v + law_.cubic * v * v * v, law_.linear + 3 * law_.cubic * v * v};
  }

  StrutLaw law_;
};

/// Reads <strut name="" from="" from_at="" to="" to_at="" linear="" cubic="" push=""/>.
class StrutDescription : public scene::BetweenTwoPoints {
 public:
  StrutLaw law;

  const char* kind() const override { return "strut"; }
  std::vector<double> numbers() const override { return {law.linear, law.cubic, law.push}; }
  std::shared_ptr<ForceElementDescription> with_links(const scene::LinkChanges& change) const override {
    auto out = std::make_shared<StrutDescription>(*this);
    out->change_links(change);
    return out;
  }
  std::shared_ptr<const ForceElement> place(const scene::ForcePlacement& placement) const override {
    return std::make_shared<Strut>(name, placement.places[0], placement.places[1], law);
  }
};

inline std::shared_ptr<const scene::ForceElementDescription> read_strut(const scene::XmlElement& strut) {
  strut.expect_only({"name", "from", "from_at", "to", "to_at", "linear", "cubic", "push"});
  auto out = std::make_shared<StrutDescription>();
  scene::read_ends(strut, *out);
  out->law.linear = strut.number("linear", scene::kNonNegative, 0);
  out->law.cubic = strut.number("cubic", scene::kNonNegative, 0);
  out->law.push = strut.number("push", scene::kAnyNumber, 0);
  return out;
}

/// The list for ReadOptions::more_force_elements.
inline const std::vector<scene::ForceElementKind>& strut_kind() {
  static const std::vector<scene::ForceElementKind> kinds = {{"strut", "", read_strut}};
  return kinds;
}

}  // namespace flexarm::test
