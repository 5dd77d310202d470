#include "elements/oil_chamber.h"

#include <algorithm>

#include "elements/stretch_energy.h"

namespace flexarm {

double OilChamber::energy(double volume, double content) const {
  return StretchEnergy{bulk_modulus}.energy({content - volume, content});
}

double OilChamber::pressure(double volume, double content) const {
  return StretchEnergy{bulk_modulus}.at({content - volume, content}).force;
}

OilStep OilChamber::over(double volume, double content, double end_volume, double end_content, bool at_end) const {
  OilStep out;
  const double most = content_at(end_volume, relief_pressure);
  const bool is_relieved = relief_pressure < bulk_modulus && end_content > most;
  const double left = is_relieved ? most : end_content;
  const double left_by_volume = is_relieved ? content_at(1, relief_pressure) : 0, left_by_oil = is_relieved ? 0 : 1;

  const StretchEnergy law{bulk_modulus};
  const Stretch end{left - end_volume, left};
  const StretchForces oil = at_end ? law.at(end) : law.means({content - volume, content}, end);
  const double by_left = oil.force_by_stretch + oil.force_by_rest;
  out.pressure = oil.force;
  out.by_volume = -oil.force_by_stretch + by_left * left_by_volume;
  out.by_oil = by_left * left_by_oil;
  const double price_by_left = by_left + oil.release_by_stretch + oil.release_by_rest;
  out.price = oil.force + oil.release;
  out.price_by_volume = -oil.force_by_stretch - oil.release_by_stretch + price_by_left * left_by_volume;
  out.price_by_oil = price_by_left * left_by_oil;
  out.dissipated = out.price * (end_content - left);
  // A void has no energy, so what fills it does not count.
  out.content = makes_up ? std::max(left, end_volume) : left;
  out.through_valves = out.content - end_content;
  return out;
}

}  // namespace flexarm
