#pragma once
/// Scalar functions of time in a scene: a constant, a muParser expression in t, a table, or a spline.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flexarm {

/// A function of time t [s]. Evaluation does not allocate memory, so it may be used in the real-time loop. Copies are
/// independent of each other: several threads may copy one function and evaluate their copies at the same time. Two
/// threads must not evaluate the same object at once.
class TimeFunction {
 public:
  /// The constant 1.
  TimeFunction();
  TimeFunction(const TimeFunction& other);
  TimeFunction(TimeFunction&&) noexcept;  ///< a moved-from function may only be assigned to or destroyed
  TimeFunction& operator=(TimeFunction other) noexcept;
  ~TimeFunction();
  explicit TimeFunction(double constant);
  /// Parses `text`, which is one of:
  /// - an expression in t: "t < 1 ? t : 0", "sin(2*_pi*t)";
  /// - a table of time:value at increasing times, linear between the points, constant outside: "0:0 1:50 2:0";
  /// - a table of time:value:rate, see spline(): "0:0:0 2:1:0".
  /// Times in tables must increase strictly.
  /// @throws std::invalid_argument with a message that says what was expected and what was read.
  static TimeFunction parse(std::string_view text);
  /// Cubic spline through points at strictly increasing times [s], constant outside. `rates` are its derivatives at the
  /// points [1/s]. Without rates the spline is twice continuously differentiable between its ends, and its derivative
  /// at both ends is zero.
  /// @throws std::invalid_argument if there are fewer than two points, if the sizes differ, or if numbers are not
  /// finite.
  static TimeFunction spline(std::vector<double> times, std::vector<double> values, std::vector<double> rates = {});

  /// Value at time t. It may be non-finite if the expression is; the caller has to check it.
  double operator()(double t) const;
  /// Derivative at time t. Exact for a spline; otherwise a central difference with a step of cbrt(machine epsilon) *
  /// max(1, |t|), and a forward difference at t = 0.
  double derivative(double t) const;
  /// Mean value over [begin, end], in either order; the value if both times are equal. Exact for constants, tables and
  /// splines. For expressions the error is about 1e-13 of the largest value. This also holds for expressions with
  /// kinks, and with jumps of more than 3e-10 of the largest value. Evaluates the expression at most five times if it
  /// is smooth over the interval, and otherwise about 4,000 times. May be non-finite if a value is. Does not allocate
  /// memory.
  /// @throws std::invalid_argument if a time is not finite and the function is not a constant.
  double mean(double begin, double end) const;
  /// As mean(), for the function clamped to [-limit, limit] at each instant.
  /// @throws std::invalid_argument as mean(), and if the limit is not > 0.
  double mean_within(double limit, double begin, double end) const;
  /// Whether the function or its derivative may jump anywhere, as far as its text shows it.
  bool may_have_corners() const;
  /// Increasing times within (begin, end), exact to round-off, at which the function or its derivative jumps; at most
  /// 10,000. For an expression these are the jumps of its abs, sign, rint, min, max and comparisons. Other jumps are
  /// found if they are more than 1e-4 of the interval apart. Use this before a run, since it evaluates an expression
  /// 10,000 to a million times.
  /// @throws std::invalid_argument if a time is not finite.
  std::vector<double> corners(double begin, double end) const;
  /// The value, if the text of the function does not contain t. Empty for all other functions, even constant ones.
  std::optional<double> constant() const;
  /// A text from which parse() makes this function.
  const std::string& text() const;

 private:
  struct Implementation;
  explicit TimeFunction(std::shared_ptr<const Implementation> implementation);
  std::shared_ptr<const Implementation> implementation_;  // copies share it if evaluation writes nothing to it
};

}  // namespace flexarm
