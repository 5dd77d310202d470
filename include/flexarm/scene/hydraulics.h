#pragma once
/// The element <hydraulics> of a <cylinder>: oil in two chambers, and a pump between them.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "flexarm/scene/force_element.h"

namespace flexarm::scene {

class HydraulicsDescription : public ForceElementDescription {
 public:
  /// Chamber 0 is on the piston's side: it grows with the cylinder's length. Chamber 1 is on the rod's side.
  struct Chamber {
    double area = 0;                        ///< of the piston [m^2]
    double dead_volume = 0;                 ///< that is left when the piston has come to the chamber's end [m^3]
    double pressure = 0;                    ///< at the start [Pa]
    std::optional<double> relief_pressure;  ///< [Pa]; empty: no relief valve
  };

  std::string barrel, rod;                                        ///< links between whose points the oil pushes
  Vector3 barrel_at = Vector3::Zero(), rod_at = Vector3::Zero();  ///< in their frames [m]
  std::string reel;                                               ///< link whose travel along the world's x axis is
                                                                  ///< the pump's coordinate; empty: no pump
  double lower = 0, upper = 0;                                    ///< the length at the ends of the stroke [m]
  double bulk_modulus = 0;                                        ///< of the oil at the pressure 0 [Pa]
  std::array<Chamber, 2> chambers;
  bool makes_up = true;                   ///< oil from the tank fills voids
  std::optional<TimeFunction> flow = {};  ///< into chamber 0 [m^3/s]; that out of chamber 1 is
                                          ///< less, in the ratio of the areas

  const char* kind() const override { return "cylinder"; }
  std::vector<LinkPoint> points() const override;
  std::vector<TimeFunction> functions() const override;
  std::vector<double> numbers() const override;
  std::shared_ptr<ForceElementDescription> with_links(const LinkChanges& change) const override;
  /// @throws ModelError if the piston starts so far beyond its stroke that a chamber has no volume.
  std::shared_ptr<const ForceElement> place(const ForcePlacement& placement) const override;
};

}  // namespace flexarm::scene
