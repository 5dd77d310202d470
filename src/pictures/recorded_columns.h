#pragma once
/// Finds the columns of rows of results by their names.

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flexarm/math/pose.h"
#include "pictures/recorded_rows.h"

namespace flexarm::pictures {

class RecordedColumns {
 public:
  template <std::size_t count>
  using Names = std::array<const char*, count>;
  template <std::size_t count>
  using Places = std::array<std::size_t, count>;
  using PosePlaces = Places<7>;

  explicit RecordedColumns(const ResultRows& rows) : rows_(rows) {
    for (std::size_t i = 0; i < rows.columns.size(); ++i) columns_[rows.columns[i].name] = i;
  }

  std::optional<std::size_t> find(const std::string& name) const {
    const auto found = columns_.find(name);
    return found == columns_.end() ? std::nullopt : std::optional(found->second);
  }
  /// The columns that have these names behind a prefix; empty unless all of them are there.
  template <std::size_t count>
  std::optional<Places<count>> find_all(const std::string& prefix, const Names<count>& names) const {
    Places<count> places;
    for (std::size_t k = 0; k < count; ++k) {
      const auto column = find(prefix + names[k]);
      if (!column) return std::nullopt;
      places[k] = *column;
    }
    return places;
  }
  std::optional<PosePlaces> find_pose(const std::string& prefix) const {
    return find_all<7>(prefix, {"x", "y", "z", "qx", "qy", "qz", "qw"});
  }

  double value(std::size_t row, std::size_t column) const { return rows_.values[row * rows_.columns.size() + column]; }
  Pose pose(std::size_t row, const PosePlaces& places) const {
    const auto at = [&](std::size_t k) { return value(row, places[k]); };
    return {{at(0), at(1), at(2)}, Quaternion(at(6), at(3), at(4), at(5)).normalized()};
  }

 private:
  const ResultRows& rows_;
  std::map<std::string, std::size_t> columns_;
};

}  // namespace flexarm::pictures
