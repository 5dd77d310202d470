#include "math/traced_expression.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace flexarm {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// ---------------------------------------------------------------- tracing

thread_local TracedExpression::Value* trace = nullptr;  // global, since muParser calls plain functions

void note(std::uint64_t branch, double argument) {
  trace->branches = (trace->branches ^ branch) * 0x9e3779b97f4a7c15u;
  trace->branches ^= trace->branches >> 29;
  trace->arguments.push_back(argument);
}
double compared(bool is_true, double x, double y) {
  note(is_true ? 2 : 3, x - y);
  return is_true ? 1 : 0;
}
double less(double x, double y) {
  return compared(x < y, x, y);
}
double greater(double x, double y) {
  return compared(x > y, x, y);
}
double at_most(double x, double y) {
  return compared(x <= y, x, y);
}
double at_least(double x, double y) {
  return compared(x >= y, x, y);
}
double equal(double x, double y) {
  return compared(x == y, x, y);
}
double other(double x, double y) {
  return compared(x != y, x, y);
}
double both(double x, double y) {
  return x != 0 && y != 0 ? 1 : 0;
}
double either(double x, double y) {
  return x != 0 || y != 0 ? 1 : 0;
}
double absolute(double x) {
  note(x < 0 ? 4 : 5, x);
  return std::abs(x);
}
double sign(double x) {
  note(x < 0 ? 6 : x > 0 ? 7 : 8, x);
  return x < 0 ? -1 : x > 0 ? 1 : 0;
}
double rounded(double x) {
  const double whole = std::floor(x + 0.5);
  note(static_cast<std::uint64_t>(static_cast<std::int64_t>(std::clamp(whole, -1e18, 1e18))) * 16 + 9,
       x - std::floor(x) - 0.5);
  return whole;
}
double smallest(const double* x, int count) {
  const double* least = std::min_element(x, x + count);
  for (int i = 0; i < count; ++i)
    if (x + i != least) note(16 * (least - x) + 10, x[i] - *least);
  return *least;
}
double largest(const double* x, int count) {
  const double* most = std::max_element(x, x + count);
  for (int i = 0; i < count; ++i)
    if (x + i != most) note(16 * (most - x) + 11, *most - x[i]);
  return *most;
}
double sum(double x, double y) {
  return x + y;
}
double difference(double x, double y) {
  return x - y;
}
double product(double x, double y) {
  return x * y;
}
double quotient(double x, double y) {
  return x / y;
}
double power(double x, double y) {
  return std::pow(x, y);
}

// ---------------------------------------------------------------- the search

constexpr int kSamples = 20'000;
constexpr int kMostValues = 1'500'000;

class CornerSearch {
 public:
  using Value = TracedExpression::Value;

  CornerSearch(const std::string& text, double begin, double end)
      : expression_(text), begin_(begin), end_(end), spacing_((end - begin) / kSamples) {}

  std::vector<double> corners() {
    Value before, last = at(begin_), next;
    for (int i = 1; i <= kSamples && !is_enough(); ++i) {
      next = at(i == kSamples ? end_ : begin_ + i * spacing_);
      if (next.branches != last.branches)
        find_switch(last, next);
      else if (i > 1 && before.branches == last.branches)
        look_between(before, last, next);
      before = std::move(last), last = std::move(next);
    }
    tidy();
    return std::move(found_);
  }

 private:
  Value at(double time) {
    ++values_;
    return expression_.at(time);
  }
  bool is_enough() const { return found_.size() >= kMostCorners || values_ >= kMostValues; }
  double resolution(double time) const { return 2 * kEpsilon * std::abs(time); }

  /// Finds all switches of branches between two times with different branches, by bisection.
  void find_switch(const Value& from, const Value& to) {
    const double middle = 0.5 * (from.time + to.time);
    if (middle <= from.time || middle >= to.time || to.time - from.time <= 0.5 * resolution(to.time)) {
      found_.push_back(to.time);
      return;
    }
    if (is_enough()) return;
    const Value between = at(middle);
    if (between.branches != from.branches) find_switch(from, between);
    if (between.branches != to.branches) find_switch(between, to);
  }

  /// Searches between three values with the same branches, for a pair of switches or for a corner without a branch.
  void look_between(const Value& a, const Value& b, const Value& c) {
    for (std::size_t k = 0; k < b.arguments.size(); ++k) {
      const double f = std::abs(b.arguments[k]);
      if (f < std::abs(a.arguments[k]) && f <= std::abs(c.arguments[k]) && touches_zero(a, b, c, k)) return;
    }
    look_for_bend(a, b, c);
  }
  /// Moves to the vertex of the parabola through an argument's values. If the branches differ there, adds the switches
  /// on both sides and returns true.
  bool touches_zero(Value a, Value b, Value c, std::size_t k) {
    const Value first = a, last = c;
    for (int i = 0; i < 4; ++i) {
      const double left = b.time - a.time, right = c.time - b.time;
      const double down = (b.arguments[k] - a.arguments[k]) / left, up = (c.arguments[k] - b.arguments[k]) / right;
      if (up == down) return false;
      const double curvature = (up - down) / (left + right);
      const double slope = down + curvature * left, vertex = b.time - 0.5 * slope / curvature;
      const double lowest = b.arguments[k] - 0.25 * slope * slope / curvature;
      // The vertex is so far from zero, relative to the curvature, that no zero is missed.
      if (std::abs(lowest) > std::abs(curvature) * std::pow(left + right, 2) || (lowest * curvature > 0 && i > 2))
        return false;
      if (!(vertex > a.time && vertex < c.time) || vertex == b.time) return false;
      Value at_vertex = at(vertex);
      if (at_vertex.branches != b.branches) {
        find_switch(first, at_vertex);
        find_switch(at_vertex, last);
        return true;
      }
      (vertex < b.time ? c : a) = b;
      b = std::move(at_vertex);
    }
    return false;
  }

  static double bend(double a, double b, double c) { return std::abs(a - 2 * b + c); }
  /// Searches for a kink or jump without a branch: halves the step of second differences where these are largest, until
  /// they are only round-off. With each halving they shrink by four if the function is smooth, by two at a kink, and
  /// not at all at a jump.
  void look_for_bend(const Value& a, const Value& b, const Value& c) {
    double t = a.time, h = b.time - a.time, f[5] = {a.value, 0, b.value, 0, c.value};
    const double at_first = bend(f[0], f[2], f[4]);
    const double noise = 64 * kEpsilon * (std::abs(f[0]) + std::abs(f[2]) + std::abs(f[4])) +
                         64 * kEpsilon * std::abs(c.time) / h * (std::abs(f[2] - f[0]) + std::abs(f[4] - f[2]));
    double last = at_first;
    int halvings = 0;
    for (; last > noise && h > 4 * resolution(c.time) && !is_enough(); ++halvings) {
      h *= 0.5;
      f[1] = at(t + h).value, f[3] = at(t + 3 * h).value;
      const double bends[3] = {bend(f[0], f[1], f[2]), bend(f[1], f[2], f[3]), bend(f[2], f[3], f[4])};
      const int most = std::max_element(bends, bends + 3) - bends;
      // A kink that is not in the middle may shrink them to a third. Growing differences are round-off.
      if (!(bends[most] > 0.3 * last) || (halvings >= 3 && bends[most] > 1.1 * last)) break;
      last = bends[most];
      t += most * h;
      const double kept[3] = {f[most], f[most + 1], f[most + 2]};
      f[0] = kept[0], f[2] = kept[1], f[4] = kept[2];
    }
    if (last > noise && h > 4 * resolution(c.time)) return;
    if (halvings >= 8 && std::isfinite(at_first)) found_.push_back(t + h);
  }

  void tidy() {
    std::sort(found_.begin(), found_.end());
    std::vector<double> kept;
    for (const double t : found_) {
      if (std::min(t - begin_, end_ - t) <= std::max(2 * resolution(t), 1e-9 * spacing_)) continue;
      if (kept.empty() || t - kept.back() > std::max(4 * resolution(t), 1e-9 * spacing_)) kept.push_back(t);
    }
    found_ = std::move(kept);
  }

  TracedExpression expression_;
  double begin_, end_, spacing_;
  int values_ = 0;
  std::vector<double> found_;
};

}  // namespace

TracedExpression::TracedExpression(const std::string& text) {
  parser_.EnableBuiltInOprt(false);
  parser_.DefineOprt("&&", both, mu::prLAND);
  parser_.DefineOprt("||", either, mu::prLOR);
  parser_.DefineOprt("<", less, mu::prCMP);
  parser_.DefineOprt(">", greater, mu::prCMP);
  parser_.DefineOprt("<=", at_most, mu::prCMP);
  parser_.DefineOprt(">=", at_least, mu::prCMP);
  parser_.DefineOprt("==", equal, mu::prCMP);
  parser_.DefineOprt("!=", other, mu::prCMP);
  parser_.DefineOprt("+", sum, mu::prADD_SUB);
  parser_.DefineOprt("-", difference, mu::prADD_SUB);
  parser_.DefineOprt("*", product, mu::prMUL_DIV);
  parser_.DefineOprt("/", quotient, mu::prMUL_DIV);
  parser_.DefineOprt("^", power, mu::prPOW, mu::oaRIGHT);
  parser_.DefineFun("abs", absolute, false);
  parser_.DefineFun("sign", sign, false);
  parser_.DefineFun("rint", rounded, false);
  parser_.DefineFun("min", smallest, false);
  parser_.DefineFun("max", largest, false);
  parser_.DefineVar("t", &t_);
  parser_.SetExpr(text);
}

TracedExpression::Value TracedExpression::at(double time) {
  Value out;
  out.time = t_ = time;
  trace = &out;
  out.value = parser_.Eval();
  trace = nullptr;
  return out;
}

std::vector<double> expression_corners(const std::string& text, double begin, double end) {
  if (!(begin < end)) return {};
  return CornerSearch(text, begin, end).corners();
}

}  // namespace flexarm
