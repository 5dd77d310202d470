#pragma once
/// Scalar functions of time as a scene writes them: a constant, a muParser expression of t, a table, or a spline.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flexarm {

/// A function of time t [s]. Immutable to the caller. Evaluation does not allocate, so that it may be used in the
/// real-time loop. Copies are independent of each other: several threads may copy one function and evaluate their
/// copies at the same time. One object must not be evaluated by two threads at once.
class TimeFunction {
 public:
  /// The constant 1.
  TimeFunction();
  TimeFunction(const TimeFunction& other);
  TimeFunction(TimeFunction&&) noexcept;  ///< what was moved from may only be assigned to or destroyed
  TimeFunction& operator=(TimeFunction other) noexcept;
  ~TimeFunction();
  explicit TimeFunction(double constant);
  /// Parses `text`: an expression in t ("t < 1 ? t : 0", "sin(2*_pi*t)"), a table "0:0 1:50 2:0"
  /// (linear between its points, constant outside; strictly increasing times), or one with rates "0:0:0 2:1:0" (as
  /// `spline`).
  /// @throws std::invalid_argument with a message that says what was read and what was expected.
  static TimeFunction parse(std::string_view text);
  /// Cubic between points at strictly increasing times [s] and constant outside, with these rates [1/s]; without any,
  /// twice continuously differentiable between the ends, at which it rests.
  /// @throws std::invalid_argument with fewer than two points, other sizes, or numbers or rates that are not finite.
  static TimeFunction spline(std::vector<double> times, std::vector<double> values, std::vector<double> rates = {});

  /// Value at time t; may be non-finite where the expression is (the caller checks).
  double operator()(double t) const;
  /// Exact for a spline; otherwise a central difference with a step of cbrt(machine epsilon) * max(1, |t|), one-sided
  /// (forward) at t = 0.
  double derivative(double t) const;
  /// Mean value over [begin, end], in either order; if both are equal, the value. Exact for constants, tables and
  /// splines. For expressions the error is about 1e-13 of the largest value, also with kinks, and with jumps of more
  /// than 3e-10 of it; this takes at most five evaluations if the function is smooth over the interval, and otherwise
  /// some 4,000. May be non-finite if a value is. Does not allocate.
  /// @throws std::invalid_argument if a time is not finite, and the function no constant.
  double mean(double begin, double end) const;
  /// The same for the function cut at -limit and limit at each instant.
  /// @throws std::invalid_argument as mean(), and if the limit is not > 0.
  double mean_within(double limit, double begin, double end) const;
  /// Increasing times within (begin, end), at most 10,000, at which the function or its derivative jumps, to round-off.
  /// For an expression these are the jumps of its abs, sign, rint, min, max and comparisons, and others that are more
  /// than a ten thousandth of the interval apart. Use it before a run: it evaluates an expression 10,000 to a million
  /// times.
  /// @throws std::invalid_argument if a time is not finite.
  std::vector<double> corners(double begin, double end) const;
  /// The value of a function without t. Empty for any other function, even if its value never changes.
  std::optional<double> constant() const;
  /// Text of which the function was made, or could have been made.
  const std::string& text() const;

 private:
  struct Implementation;
  explicit TimeFunction(std::shared_ptr<const Implementation> implementation);
  std::shared_ptr<const Implementation> implementation_;  // shared by copies where evaluation writes nothing
};

}  // namespace flexarm
