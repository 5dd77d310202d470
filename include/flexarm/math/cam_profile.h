#pragma once
/// Travel of a cam's follower as a function of the cam's angle, with the difference quotients that conserve energy over
/// a time step.

#include <vector>

namespace flexarm {

/// f(u): travel [m] as a function of the angle u [rad], with period 2 pi, twice continuously differentiable.
class CamProfile {
 public:
  /// Eccentric disc: f = radius (cos u - 1) - offset (Muñoz 2004, Table 11.1). [m]
  /// @throws std::invalid_argument if an argument is not finite.
  static CamProfile eccentric(double radius, double offset);
  /// Periodic cubic spline through the points (angles[i], travels[i]). At least 3 points; the angles increase and span
  /// less than 2 pi.
  /// @throws std::invalid_argument with a message that says what is wrong.
  static CamProfile periodic(const std::vector<double>& angles, const std::vector<double>& travels);

  double value(double u) const;              ///< f [m]
  double derivative(double u) const;         ///< f' [m/rad]
  double second_derivative(double u) const;  ///< f'' [m/rad^2]
  /// (f(to) - f(from)) / (to - from), computed without cancellation; the derivative if `from` equals `to` [m/rad].
  double secant(double from, double to) const;
  /// Derivative of secant() with respect to `to` [m/rad^2].
  double secant_derivative(double from, double to) const;
  /// Numbers that define the profile; two profiles are equal if these are. Radius and offset [m], then for each piece
  /// of the spline its start angle [rad] and its coefficients.
  std::vector<double> numbers() const;

 private:
  /// A polynomial c[0] + c[1] t + c[2] t^2 + c[3] t^3 with t = u - begin.
  struct Piece {
    double begin, c[4];
  };
  /// Returns the piece that contains u - 2 pi `turns`, and sets `turns`. Sets `t` to the distance from its start [rad].
  const Piece& piece_at(double u, double& t, double& turns) const;

  double radius_ = 0, offset_ = 0;
  std::vector<Piece> pieces_;  // over one period; empty for an eccentric disc
};

}  // namespace flexarm
