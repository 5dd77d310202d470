#pragma once
/// The fmt library before version 7 (Ubuntu 20.04 has 6.1), with the way in which later versions write numbers: 2 is
/// "2", not "2.0". CMakeLists.txt puts this folder before the library's own where the library is so old.

#include_next <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <type_traits>
#include <utility>

namespace flexarm {

/// A number whose text is the shortest one that is read back bit for bit, unless a format is given.
struct Number {
  double value;
};

/// Within namespace flexarm, `fmt::format` and its like are these functions. All else is the library's.
namespace fmt {
using namespace ::fmt;

template <class T>
decltype(auto) argument(T&& value) {
  if constexpr (std::is_floating_point_v<std::decay_t<T>>)
    return Number{static_cast<double>(value)};
  else
    return std::forward<T>(value);
}

template <class... T>
std::string format(string_view text, T&&... values) {
  return ::fmt::format(text, argument(std::forward<T>(values))...);
}
template <class Iterator, class... T>
Iterator format_to(Iterator out, string_view text, T&&... values) {
  return ::fmt::format_to(out, text, argument(std::forward<T>(values))...);
}
template <class... T>
void print(std::FILE* file, string_view text, T&&... values) {
  ::fmt::print(file, text, argument(std::forward<T>(values))...);
}
template <class... T>
void print(string_view text, T&&... values) {
  ::fmt::print(text, argument(std::forward<T>(values))...);
}
template <class T>
std::string to_string(const T& value) {
  return format("{}", value);
}

}  // namespace fmt
}  // namespace flexarm

namespace fmt {

template <>
struct formatter<flexarm::Number> : formatter<double> {
  auto parse(format_parse_context& context) {
    is_plain_ = context.begin() == context.end() || *context.begin() == '}';
    return formatter<double>::parse(context);
  }

  template <class Context>
  auto format(const flexarm::Number& number, Context& context) {
    if (!is_plain_) return formatter<double>::format(number.value, context);
    std::string text = ::fmt::to_string(number.value);
    if (text.size() > 2 && text.compare(text.size() - 2, 2, ".0") == 0) text.resize(text.size() - 2);
    return std::copy(text.begin(), text.end(), context.out());
  }

 private:
  bool is_plain_ = false;
};

}  // namespace fmt
