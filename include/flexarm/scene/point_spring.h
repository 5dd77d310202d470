#pragma once
/// A spring between points of two links, with a damper beside it: <spring from="" to="">.

#include <optional>

#include "flexarm/scene/force_element.h"

namespace flexarm::scene {

class PointSpring : public ForceElementDescription {
 public:
  std::string from, to;                                        ///< links
  Vector3 from_at = Vector3::Zero(), to_at = Vector3::Zero();  ///< in the undeformed link frames [m]
  double stiffness = 0;                                        ///< [N/m]
  std::optional<double> rest_length = {};                      ///< empty: as long as it is at the start [m]
  double damping = 0;                                          ///< [N s/m]

  const char* kind() const override { return "spring"; }
  std::vector<LinkPoint> points() const override { return {{"from", from, from_at}, {"to", to, to_at}}; }
  std::vector<double> numbers() const override;
  std::shared_ptr<const ForceElement> place(const std::vector<NodePoint>& places,
                                            const std::vector<Vector3>& positions) const override;
};

}  // namespace flexarm::scene
