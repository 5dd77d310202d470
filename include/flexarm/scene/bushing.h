#pragma once
/// The element <bushing from="" to="">: six stiffnesses and dampings between frames of two links.

#include "flexarm/scene/force_element.h"

namespace flexarm::scene {

/// It has no force as the scene is described: the frame on `to` has the same axes as that on `from` there.
class BushingDescription : public BetweenTwoPoints {
 public:
  Quaternion axes = Quaternion::Identity();                        ///< in the undeformed frame of `from`
  Matrix6 stiffness = Matrix6::Zero(), damping = Matrix6::Zero();  ///< see flexarm::Bushing::Law

  const char* kind() const override { return "bushing"; }
  std::vector<double> numbers() const override;
  std::shared_ptr<ForceElementDescription> with_links(const LinkChanges& change) const override;
  std::shared_ptr<const ForceElement> place(const ForcePlacement& placement) const override;
};

}  // namespace flexarm::scene
