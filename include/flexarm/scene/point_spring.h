#pragma once
/// The element <spring from="" to="">: a spring with a parallel damper between points of two links.

#include <optional>

#include "flexarm/scene/force_element.h"

namespace flexarm::scene {

class PointSpring : public BetweenTwoPoints {
 public:
  double stiffness = 0;                    ///< [N/m]
  std::optional<double> rest_length = {};  ///< [m]; empty: its initial length
  double damping = 0;                      ///< [N s/m]

  const char* kind() const override { return "spring"; }
  std::vector<double> numbers() const override;
  std::shared_ptr<ForceElementDescription> with_links(const LinkChanges& change) const override;
  std::shared_ptr<const ForceElement> place(const ForcePlacement& placement) const override;
};

}  // namespace flexarm::scene
