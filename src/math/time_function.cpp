#include "flexarm/math/time_function.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "math/adaptive_mean.h"
#include "math/cubic_spline.h"
#include "math/expression.h"
#include "math/number_text.h"
#include "math/traced_expression.h"

namespace flexarm {
namespace {

constexpr std::size_t kLongestTable = 1 << 20;
constexpr const char* kExpected = "an expression of t, or a table TIME:VALUE TIME:VALUE ...";

/// A piecewise linear function, constant outside of its points.
struct Table {
  std::vector<double> times, values;

  double operator()(double t) const {
    const auto after = std::upper_bound(times.begin(), times.end(), t);
    if (after == times.begin()) return values.front();
    if (after == times.end()) return values.back();
    const std::size_t i = after - times.begin();
    const double fraction = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return (1 - fraction) * values[i - 1] + fraction * values[i];
  }
};

/// An expression of t. A compiled one has a place for t, which every evaluation writes, so that copies must not share
/// it. A copy compiles the expression when it is first evaluated: most copies are parts of scenes, and never are.
class Expression {
 public:
  /// @throws std::invalid_argument
  explicit Expression(std::string text) : text_(std::move(text)) {
    compiled();
    has_branches_ = text_.find_first_of("<>=!?&|") != std::string::npos;
    for (const char* corner : {"abs", "sign", "rint", "min", "max"})
      has_branches_ = has_branches_ || text_.find(corner) != std::string::npos;
  }
  Expression(const Expression& other) : text_(other.text_), has_branches_(other.has_branches_) {}
  Expression& operator=(const Expression&) = delete;

  /// Returns the value at a time. Recent values are cached, since the end of a step is the beginning of the next.
  double operator()(double time) const {
    for (const Known& known : known_)
      if (known.time == time) return known.value;
    compiled().t = time;
    const double value = compiled().parser.Eval();
    known_[next_] = {time, value};
    next_ = (next_ + 1) % known_.size();
    return value;
  }
  bool has_branches() const { return has_branches_; }
  /// Returns the value if it does not depend on t. This modifies the parser, so call it only on a copy of an expression
  /// that is in use.
  std::optional<double> constant() {
    mu::Parser& parser = compiled().parser;
    return parser.GetUsedVar().empty() ? std::optional(parser.Eval()) : std::nullopt;
  }

 private:
  struct Compiled {
    double t = 0;
    mu::Parser parser;
  };
  Compiled& compiled() const {
    if (!compiled_) {
      compiled_ = std::make_unique<Compiled>();
      compiled_->parser.DefineVar("t", &compiled_->t);
      compile_expression(compiled_->parser, text_, kExpected);
    }
    return *compiled_;
  }

  std::string text_;
  struct Known {
    double time = std::numeric_limits<double>::quiet_NaN(), value = 0;
  };
  mutable std::array<Known, 4> known_;  // several, since a mean evaluates further times after that at the step's end
  mutable std::size_t next_ = 0;
  bool has_branches_ = false;
  mutable std::unique_ptr<Compiled> compiled_;  // null: not yet
};

/// Returns the mean of a function that is a polynomial between its points and constant outside. `of_piece(a, b)`:
/// returns the mean over a part of one piece.
template <class Piecewise, class OfPiece>
double mean_by_pieces(const Piecewise& function, double begin, double end, const OfPiece& of_piece) {
  auto next = std::upper_bound(function.times.begin(), function.times.end(), begin);
  if (next == function.times.end() || *next >= end) return of_piece(begin, end);
  double sum = 0, from = begin;
  for (; from < end; ++next) {
    const double to = next == function.times.end() ? end : std::min(*next, end);
    sum += (to - from) / (end - begin) * of_piece(from, to);
    from = to;
    if (next == function.times.end()) break;
  }
  return sum;
}

double mean(const Table& table, double begin, double end) {
  return mean_by_pieces(table, begin, end, [&](double a, double b) { return table(0.5 * (a + b)); });
}
double mean(const CubicSpline& spline, double begin, double end) {
  return mean_by_pieces(spline, begin, end,
                        [&](double a, double b) { return (spline(a) + 4 * spline(0.5 * (a + b)) + spline(b)) / 6; });
}

/// Returns the mean of a linear function from `a` to `b` that is cut at +-limit.
double mean_of_cut_line(double a, double b, double limit) {
  if (std::max(std::abs(a), std::abs(b)) <= limit) return 0.5 * (a + b);
  if (std::min(a, b) >= limit) return limit;
  if (std::max(a, b) <= -limit) return -limit;
  const auto integral = [limit](double x) {  // of the cut identity function from 0 to x
    return std::abs(x) <= limit ? 0.5 * x * x : limit * (std::abs(x) - 0.5 * limit);
  };
  return (integral(b) - integral(a)) / (b - a);
}

/// Whether the slope of a table changes at a point by more than round-off; outside of the table it is zero.
bool bends(const Table& table, std::size_t i) {
  const auto &t = table.times, &v = table.values;
  const bool is_first = i == 0, is_last = i + 1 == t.size();
  const double before = is_first ? 0 : (v[i] - v[i - 1]) / (t[i] - t[i - 1]);
  const double after = is_last ? 0 : (v[i + 1] - v[i]) / (t[i + 1] - t[i]);
  // Points on a straight line have round-off in values and times.
  double shortest = std::numeric_limits<double>::infinity();
  if (!is_first) shortest = std::min(shortest, t[i] - t[i - 1]);
  if (!is_last) shortest = std::min(shortest, t[i + 1] - t[i]);
  const double round_off = 8 * std::numeric_limits<double>::epsilon() / shortest *
                           (std::abs(v[i]) + std::abs(t[i]) * std::max(std::abs(before), std::abs(after)));
  return std::abs(after - before) > round_off;
}

void require_times(double begin, double end) {
  if (!std::isfinite(begin) || !std::isfinite(end))
    throw std::invalid_argument(fmt::format("begin and end: expected finite times [s], got {} and {}", begin, end));
}

using Function = std::variant<double, Table, CubicSpline, Expression>;

/// Returns the numbers of "1:2:3"; none if a part is not a number.
std::vector<double> parse_entry(std::string_view word) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= word.size();) {
    const std::size_t end = std::min(word.find(':', begin), word.size());
    const std::optional<double> number = parse_number(word.substr(begin, end - begin));
    if (!number) return {};
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

void read_table(std::string_view text, Function& function) {
  if (text.size() > kLongestTable)
    throw std::invalid_argument("table of " + std::to_string(text.size()) + " characters, expected at most " +
                                std::to_string(kLongestTable));
  CubicSpline table;
  std::string_view rest = text;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    const std::vector<double> entry = parse_entry(word);
    const auto fail = [&](const char* expected) {
      throw std::invalid_argument("entry " + quoted_expression(word) + " of a table, expected " + expected);
    };
    if (entry.size() != 2 && entry.size() != 3) fail("TIME:VALUE or TIME:VALUE:RATE with numbers");
    if (!table.times.empty() && entry[0] <= table.times.back()) fail("strictly increasing times");
    table.times.push_back(entry[0]);
    table.values.push_back(entry[1]);
    if (entry.size() == 3) table.rates.push_back(entry[2]);
    if (!table.rates.empty() && table.rates.size() != table.times.size()) fail("a rate in all entries or in none");
  }
  if (table.rates.empty()) {
    function.emplace<Table>(Table{std::move(table.times), std::move(table.values)});
    return;
  }
  if (table.times.size() < 2) throw std::invalid_argument("a single point with a rate, expected at least two");
  function.emplace<CubicSpline>(std::move(table));
}

}  // namespace

/// Can be copied but not moved.
struct TimeFunction::Implementation {
  Implementation() = default;
  template <class Kind>
  Implementation(std::string as_text, Kind kind) : text(std::move(as_text)), function(std::move(kind)) {}
  Implementation(const Implementation&) = default;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() = default;

  std::string text;
  Function function;
};

TimeFunction::TimeFunction() : TimeFunction(1.0) {}

TimeFunction::TimeFunction(double constant) {
  char text[kLongestNumber];
  const char* end = write_number(text, constant, NumberFormat::Shortest);
  implementation_ = std::make_shared<const Implementation>(std::string(text, end - text), constant);
}

TimeFunction::TimeFunction(std::shared_ptr<const Implementation> implementation)
    : implementation_(std::move(implementation)) {}

TimeFunction::TimeFunction(const TimeFunction& other)
    : implementation_(std::holds_alternative<Expression>(other.implementation_->function)
                          ? std::make_shared<const Implementation>(*other.implementation_)
                          : other.implementation_) {}
TimeFunction::TimeFunction(TimeFunction&&) noexcept = default;
TimeFunction::~TimeFunction() = default;

TimeFunction& TimeFunction::operator=(TimeFunction other) noexcept {
  implementation_.swap(other.implementation_);
  return *this;
}

TimeFunction TimeFunction::parse(std::string_view text) {
  std::string_view rest = text;
  const std::string_view first = next_word(rest);
  if (first.empty()) throw std::invalid_argument("nothing, expected an expression of t or a table TIME:VALUE ...");
  if (text.find('\0') != std::string_view::npos)
    throw std::invalid_argument("a zero byte, expected an expression of t or a table TIME:VALUE ...");

  auto implementation = std::make_shared<Implementation>();
  const std::optional<double> constant = next_word(rest).empty() ? parse_number(first) : std::nullopt;
  if (constant) {
    implementation->function = *constant;
  } else if (text.find(':') != std::string_view::npos && text.find('?') == std::string_view::npos) {
    read_table(text, implementation->function);
  } else {
    implementation->function.emplace<Expression>(std::string(text));
  }
  implementation->text = text;
  return TimeFunction(std::move(implementation));
}

TimeFunction TimeFunction::spline(std::vector<double> times, std::vector<double> values, std::vector<double> rates) {
  if (times.size() < 2) throw std::invalid_argument("at least two points are expected");
  if (values.size() != times.size() || (!rates.empty() && rates.size() != times.size()))
    throw std::invalid_argument("as many values as times are expected, and as many rates or none");
  if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
    throw std::invalid_argument("strictly increasing times are expected");
  if (rates.empty()) rates = smoothest_rates(times, values);
  CubicSpline spline{std::move(times), std::move(values), std::move(rates)};
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < spline.times.size(); ++i) {
    if (!std::isfinite(spline.times[i]) || !std::isfinite(spline.values[i]) || !std::isfinite(spline.rates[i]))
      throw std::invalid_argument("finite numbers, and finite rates between them, are expected");
    fmt::format_to(std::back_inserter(text), "{}{}:{}:{}", i > 0 ? " " : "", spline.times[i], spline.values[i],
                   spline.rates[i]);
  }
  return TimeFunction(std::make_shared<const Implementation>(to_string(text), std::move(spline)));
}

double TimeFunction::operator()(double t) const {
  const Function& function = implementation_->function;
  if (const double* constant = std::get_if<double>(&function)) return *constant;
  if (const Table* table = std::get_if<Table>(&function)) return (*table)(t);
  if (const CubicSpline* spline = std::get_if<CubicSpline>(&function)) return (*spline)(t);
  return std::get<Expression>(function)(t);
}

double TimeFunction::derivative(double t) const {
  if (const CubicSpline* spline = std::get_if<CubicSpline>(&implementation_->function)) return spline->derivative(t);
  const double step = std::cbrt(std::numeric_limits<double>::epsilon()) * std::max(1.0, std::abs(t));
  // The function may not be defined for negative times. So near the start use a second-order forward difference.
  if (t >= 0 && t < step) return (-3 * (*this)(t) + 4 * (*this)(t + step) - (*this)(t + 2 * step)) / (2 * step);
  return ((*this)(t + step) - (*this)(t - step)) / (2 * step);
}

double TimeFunction::mean(double begin, double end) const {
  const Function& function = implementation_->function;
  if (const double* constant = std::get_if<double>(&function)) return *constant;
  if (begin == end) return (*this)(begin);
  if (begin > end) std::swap(begin, end);
  require_times(begin, end);
  if (const Table* table = std::get_if<Table>(&function)) return flexarm::mean(*table, begin, end);
  if (const CubicSpline* spline = std::get_if<CubicSpline>(&function)) return flexarm::mean(*spline, begin, end);
  const Expression& expression = std::get<Expression>(function);
  return mean_of_what_may_be_smooth(expression, begin, end, !expression.has_branches());
}

double TimeFunction::mean_within(double limit, double begin, double end) const {
  if (!(limit > 0)) throw std::invalid_argument(fmt::format("limit: expected a number > 0, got {}", limit));
  const Function& function = implementation_->function;
  const auto cut = [limit](double value) { return std::clamp(value, -limit, limit); };
  if (const double* constant = std::get_if<double>(&function)) return cut(*constant);
  if (begin == end) return cut((*this)(begin));
  if (begin > end) std::swap(begin, end);
  require_times(begin, end);
  if (const Table* table = std::get_if<Table>(&function))
    return mean_by_pieces(*table, begin, end,
                          [&](double a, double b) { return mean_of_cut_line((*table)(a), (*table)(b), limit); });
  if (const CubicSpline* spline = std::get_if<CubicSpline>(&function)) {
    const auto value = [&](double t) { return cut((*spline)(t)); };
    return mean_by_pieces(*spline, begin, end, [&](double a, double b) { return adaptive_mean(value, a, b); });
  }
  const Expression& expression = std::get<Expression>(function);
  return mean_of_what_may_be_smooth([&](double t) { return cut(expression(t)); }, begin, end, false);
}

bool TimeFunction::may_have_corners() const {
  const Function& function = implementation_->function;
  if (const Table* table = std::get_if<Table>(&function)) {
    for (std::size_t i = 0; i < table->times.size(); ++i)
      if (bends(*table, i)) return true;
    return false;
  }
  if (const CubicSpline* spline = std::get_if<CubicSpline>(&function))
    return spline->rates.front() != 0 || spline->rates.back() != 0;
  const Expression* expression = std::get_if<Expression>(&function);
  return expression && expression->has_branches();
}

std::vector<double> TimeFunction::corners(double begin, double end) const {
  require_times(begin, end);
  const Function& function = implementation_->function;
  std::vector<double> out;
  const auto add = [&](double t, bool is_corner) {
    if (is_corner && t > begin && t < end && out.size() < kMostCorners) out.push_back(t);
  };
  if (const Table* table = std::get_if<Table>(&function)) {
    for (std::size_t i = 0; i < table->times.size(); ++i) add(table->times[i], bends(*table, i));
  } else if (const CubicSpline* spline = std::get_if<CubicSpline>(&function)) {
    add(spline->times.front(), spline->rates.front() != 0);
    add(spline->times.back(), spline->rates.back() != 0);
  } else if (std::holds_alternative<Expression>(function) && !constant()) {
    return expression_corners(implementation_->text, begin, end);
  }
  return out;
}

std::optional<double> TimeFunction::constant() const {
  const Function& function = implementation_->function;
  if (const double* value = std::get_if<double>(&function)) return *value;
  if (const Expression* expression = std::get_if<Expression>(&function)) return Expression(*expression).constant();
  return std::nullopt;
}

const std::string& TimeFunction::text() const {
  return implementation_->text;
}

}  // namespace flexarm
