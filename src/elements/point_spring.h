#pragma once
/// A spring along the line between two points, with a damper beside it.

#include "elements/line_element.h"

namespace flexarm {

class PointSpring : public LineElement {
 public:
  struct Law {
    double stiffness = 0;    ///< [N/m]
    double rest_length = 0;  ///< [m]
    double damping = 0;      ///< [N s/m]
  };

  PointSpring(std::string name, const NodePoint& from, const NodePoint& to, const Law& law)
      : LineElement(std::move(name), from, to), law_(law) {}

  const char* kind() const override { return "spring"; }
  std::string description() const override;

 private:
  /// Of means: stiffness times (the mean length - rest length), whose work is exactly the change of the energy,
  /// stiffness (length - rest length)^2 / 2; and damping times the mean rate.
  LineTension tension(const CoordinateStep& change) const override;
  double energy(double length) const override;
  LineTension elastic(double length) const override;
  LineTension damper(double rate) const override { return {law_.damping * rate, law_.damping}; }

  Law law_;
};

}  // namespace flexarm
