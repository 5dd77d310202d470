#pragma once
/// A spring between two points, with a damper in parallel.

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
  /// Returns stiffness * (length - rest length) + damping * rate. With means over the step, length is the mean of both
  /// ends. The work of the elastic part is then exactly the change of the elastic energy.
  LineTension tension(const CoordinateStep& change) const override;
  double energy(double length) const override;
  LineTension elastic(double length) const override;
  LineTension damper(double rate) const override { return {law_.damping * rate, law_.damping}; }

  Law law_;
};

}  // namespace flexarm
