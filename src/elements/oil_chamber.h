#pragma once
/// The oil in a chamber whose volume changes. (docs/notes/oil.md)

#include <limits>

namespace flexarm {

/// What the oil of a chamber does over a step, with the derivatives by the volume at the end and by the oil that is
/// pumped in.
struct OilStep {
  double pressure = 0, by_volume = 0, by_oil = 0;           ///< energy per volume that the chamber loses, >= 0 [Pa]
  double price = 0, price_by_volume = 0, price_by_oil = 0;  ///< energy per oil that is pumped in, >= 0 [Pa]
  double content = 0;                                       ///< at the end of the step [m^3]
  double through_valves = 0;                                ///< what has come in through them [m^3]
  double dissipated = 0;                                    ///< by the relief valve [J]
};

/// A chamber with an elastic fluid, a relief valve, and perhaps a valve that lets oil in from the tank. Its content u
/// is the volume that its oil has without pressure. The energy is B (u - V)^2 / (2 u) if u is more than the chamber's
/// volume V, so that the pressure is B (u - V) / u; else a part of the chamber is void, and both are zero.
struct OilChamber {
  double bulk_modulus = 0;  ///< B, at the pressure 0 [Pa]
  /// The relief valve lets out at the end of a step what would make the pressure larger than this [Pa].
  double relief_pressure = std::numeric_limits<double>::infinity();
  bool makes_up = false;  ///< oil from the tank fills a void at the end of a step

  double energy(double volume, double content) const;    ///< [J]
  double pressure(double volume, double content) const;  ///< [Pa]
  /// The content of a full chamber at a pressure less than the bulk modulus.
  double content_at(double volume, double pressure) const { return volume / (1 - pressure / bulk_modulus); }
  bool is_full(double volume, double content) const { return content > volume; }

  /// The step from one volume and content to another volume, and to the content that would be in it but for the
  /// valves. `at_end`: values at the end of the step; else means over it, with -pressure * change of volume + price *
  /// change of content (but for the valves) exactly the change of the energy plus what is dissipated. The content at
  /// the end is 0 or less if no oil is left.
  OilStep over(double volume, double content, double end_volume, double end_content, bool at_end) const;
};

}  // namespace flexarm
