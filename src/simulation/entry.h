#pragma once
/// Checked access to lists by indices from users of the library.

#include <cstddef>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace flexarm {

/// @throws std::out_of_range whose message says `what` the list contains, and how many entries there are
template <class Entry>
const Entry& entry(const std::vector<Entry>& entries, std::size_t index, const char* what) {
  if (index >= entries.size())
    throw std::out_of_range(
        entries.empty() ? fmt::format("{} {}: there is none", what, index)
                        : fmt::format("{} {}: expected an index from 0 to {}", what, index, entries.size() - 1));
  return entries[index];
}

}  // namespace flexarm
