#pragma once
/// The element <tendon>: a line over points and pulleys of links that pulls and never pushes.

#include <optional>
#include <string>
#include <vector>

#include "flexarm/scene/force_element.h"

namespace flexarm::scene {

class TendonDescription : public ForceElementDescription {
 public:
  static constexpr double kQuarterTurn = 1.5707963267948966;  ///< [rad]

  /// A point that the line runs through, or a pulley that it runs over.
  struct Guide {
    std::string link;
    Vector3 at = Vector3::Zero();     ///< point, or centre of the pulley, in the undeformed link frame [m]
    double radius = 0;                ///< of the pulley [m]; 0: a point
    Vector3 axis = Vector3::UnitZ();  ///< of the pulley, in the undeformed link frame
    bool turns_left = true;           ///< counterclockwise about the axis, from the first guide to the last one
    bool grips = false;               ///< the line never slips on the pulley
    double friction = 0;              ///< coefficient of Coulomb friction, of a pulley without grip or a point
    double wrap = kQuarterTurn;       ///< of a pulley without grip: at the start the angle of contact is the possible
                                      ///< one that is nearest to this [rad]
  };

  std::vector<Guide> guides;
  std::vector<std::string> reels;                ///< links of winches: their travel along the world's x axis pays the
                                                 ///< line out at its first guide
  double stiffness = 0;                          ///< EA [N]
  double damping = 0;                            ///< [N s/m]
  std::optional<TimeFunction> rest_length = {};  ///< [m]; empty: its initial length
  std::optional<TimeFunction> tension = {};      ///< [N]; in place of the stiffness

  const char* kind() const override { return "tendon"; }
  std::vector<LinkPoint> points() const override;
  std::vector<TimeFunction> functions() const override;
  std::vector<double> numbers() const override;
  std::shared_ptr<ForceElementDescription> with_links(const LinkChanges& change) const override;
  std::shared_ptr<const ForceElement> place(const ForcePlacement& placement) const override;
};

}  // namespace flexarm::scene
