#pragma once
/// Suggests names for misspelt ones.

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flexarm {

/// Returns the edit distance: how many letters must be changed, inserted, deleted or swapped with their neighbour to
/// turn one name into the other. In `typed`, `*` matches any letters and `?` any single letter.
inline int misspellings(std::string_view typed, std::string_view name) {
  std::vector<int> before, last, now(name.size() + 1);  // entry j: distance for the first j letters of `name`
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

/// Returns the names sorted by their distance from `typed`, the nearest one first.
inline std::vector<std::string> nearest_first(std::string_view typed, std::vector<std::string> names) {
  std::vector<std::pair<int, std::string>> distances;
  distances.reserve(names.size());
  for (std::string& name : names) distances.emplace_back(misspellings(typed, name), std::move(name));
  std::stable_sort(distances.begin(), distances.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  names.clear();
  for (auto& [distance, name] : distances) names.push_back(std::move(name));
  return names;
}

/// Returns the names as a text, the nearest one first: "elbow, shoulder and 3 others" if there are more than twelve.
inline std::string nearest_listed(std::string_view typed, const std::vector<std::string>& names) {
  constexpr std::size_t kMostNames = 12;
  std::string list;
  std::size_t listed = 0;
  for (const std::string& name : nearest_first(typed, names))
    if (listed < kMostNames) list += (listed++ > 0 ? ", " : "") + name;
  return names.size() > listed ? list + " and " + std::to_string(names.size() - listed) + " others" : list;
}

/// Returns a text such as "; did you mean 'simulate'?" if one of the names is near enough, with a letter in common;
/// else an empty text.
inline std::string suggestion(std::string_view typed, const std::vector<std::string>& names) {
  if (names.empty()) return "";
  std::string meant = nearest_first(typed, names).front();
  const int distance = misspellings(typed, meant);
  bool is_near = distance <= std::max(1, static_cast<int>(meant.size()) / 3) &&
                 distance < static_cast<int>(std::max(typed.size(), meant.size()));
  for (const std::string& name : names)  // or if `typed` is the beginning of a name
    if (!is_near && typed.size() > 2 && name.compare(0, typed.size(), typed) == 0) {
      meant = name;
      is_near = true;
    }
  return is_near ? "; did you mean '" + meant + "'?" : "";
}

}  // namespace flexarm
