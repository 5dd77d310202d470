#pragma once
/// Scalar functions of time as a scene writes them: a constant, a muParser expression of t, or a table.

#include <memory>
#include <string>
#include <string_view>

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
  /// Parses `text`: an expression in t ("t < 1 ? t : 0", "sin(2*_pi*t)") or a table "0:0 1:50 2:0"
  /// (linear between its points, constant outside; strictly increasing times).
  /// @throws std::invalid_argument with a message that says what was read and what was expected.
  static TimeFunction parse(std::string_view text);

  /// Value at time t; may be non-finite where the expression is (the caller checks).
  double operator()(double t) const;
  /// Central difference with a step of cbrt(machine epsilon) * max(1, |t|); one-sided (forward) at t = 0.
  double derivative(double t) const;
  /// Text from which the function was made.
  const std::string& text() const;

 private:
  struct Implementation;
  explicit TimeFunction(std::unique_ptr<const Implementation> implementation);
  std::unique_ptr<const Implementation> implementation_;
};

}  // namespace flexarm
