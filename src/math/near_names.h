#pragma once
/// Names as people type them.

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flexarm {

/// How many letters have to be changed, put in, left out or swapped with their neighbour to make one of the other. In
/// `typed`, `*` stands for any letters and `?` for one, as in patterns.
inline int misspellings(std::string_view typed, std::string_view name) {
  std::vector<int> before, last, now(name.size() + 1);  // for the beginnings of `name`
  for (std::size_t j = 0; j <= name.size(); ++j) now[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= typed.size(); ++i) {
    before = std::exchange(last, now);
    const char c = typed[i - 1];
    const bool is_any = c == '*';
    now[0] = last[0] + (is_any ? 0 : 1);
    for (std::size_t j = 1; j <= name.size(); ++j) {
      const bool is_same = c == name[j - 1] || c == '?' || is_any;
      now[j] = std::min({last[j] + (is_any ? 0 : 1), now[j - 1] + (is_any ? 0 : 1), last[j - 1] + (is_same ? 0 : 1)});
      if (i > 1 && j > 1 && c == name[j - 2] && typed[i - 2] == name[j - 1])
        now[j] = std::min(now[j], before[j - 2] + 1);
    }
  }
  return now[name.size()];
}

/// The same names, those that `typed` is nearest to first.
inline std::vector<std::string> nearest_first(std::string_view typed, std::vector<std::string> names) {
  std::stable_sort(names.begin(), names.end(), [typed](const std::string& a, const std::string& b) {
    return misspellings(typed, a) < misspellings(typed, b);
  });
  return names;
}

/// "; did you mean 'simulate'?", where one of the names is near enough; else empty.
inline std::string suggestion(std::string_view typed, const std::vector<std::string>& names) {
  if (names.empty()) return "";
  std::string meant = nearest_first(typed, names).front();
  bool is_near = misspellings(typed, meant) <= std::max(1, static_cast<int>(meant.size()) / 3);
  for (const std::string& name : names)  // or it is only begun
    if (!is_near && typed.size() > 2 && name.compare(0, typed.size(), typed) == 0) {
      meant = name;
      is_near = true;
    }
  return is_near ? "; did you mean '" + meant + "'?" : "";
}

}  // namespace flexarm
