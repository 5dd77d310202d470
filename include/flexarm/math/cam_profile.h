#pragma once
/// Follower travel of a cam over its angle, with the divided differences that make its work exact over a step.

#include <vector>

namespace flexarm {

/// f(u): travel [m] over the angle u [rad], period 2 pi, twice continuously differentiable.
class CamProfile {
 public:
  /// Eccentric disc: f = radius (cos u - 1) - offset (Muñoz 2004, Table 11.1). [m]
  /// @throws std::invalid_argument if one is not finite.
  static CamProfile eccentric(double radius, double offset);
  /// Periodic cubic spline through (angles[i], travels[i]), angles increasing within less than 2 pi, at least 3 of
  /// them.
  /// @throws std::invalid_argument saying what is wrong.
  static CamProfile periodic(const std::vector<double>& angles, const std::vector<double>& travels);

  double value(double u) const;              ///< f [m]
  double derivative(double u) const;         ///< f' [m/rad]
  double second_derivative(double u) const;  ///< f'' [m/rad^2]
  /// (f(to) - f(from)) / (to - from), free of cancellation; the derivative where both are equal [m/rad].
  double secant(double from, double to) const;
  /// Its derivative with respect to `to` [m/rad^2].
  double secant_derivative(double from, double to) const;
  /// Numbers that define the profile, to tell two profiles apart: radius and offset [m], then for each piece of the
  /// spline its beginning [rad] and its coefficients.
  std::vector<double> numbers() const;

 private:
  /// A polynomial c[0] + c[1] t + c[2] t^2 + c[3] t^3, t = u - begin.
  struct Piece {
    double begin, c[4];
  };
  /// The piece of an angle and how far it lies behind the start of that piece; `turns` full turns are taken off.
  const Piece& piece_at(double u, double& t, double& turns) const;

  double radius_ = 0, offset_ = 0;
  std::vector<Piece> pieces_;  // over one period; empty: eccentric
};

}  // namespace flexarm
