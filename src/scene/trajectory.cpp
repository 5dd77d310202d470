#include "scene/trajectory.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "scene/csv_table.h"

namespace flexarm::scene {
namespace {

constexpr char kSeparator = '#';  // which no expression has

/// `time` and the names in "COLUMN" or "COLUMN,RATES"; nothing where it is neither.
std::optional<std::vector<std::string>> column_names(const std::string& text) {
  std::vector<std::string> names = {"time", ""};
  for (const char c : text) {
    if (c == ',')
      names.emplace_back();
    else if (c != ' ' && c != '\t')
      names.back() += c;
  }
  const bool is_complete = std::find(names.begin(), names.end(), "") == names.end();
  return is_complete && names.size() <= 3 ? std::optional(names) : std::nullopt;
}

/// Their places in the table; nothing where one is missing.
std::optional<std::vector<std::size_t>> find_columns(const CsvTable& table, const std::vector<std::string>& names) {
  const std::vector<std::string>& columns = table.columns();
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    if (std::count(columns.begin(), columns.end(), name) != 1) {
      table.error(fmt::format("one column '{}' is expected", name), fmt::format("{}", fmt::join(columns, ",")));
      return std::nullopt;
    }
    places.push_back(std::find(columns.begin(), columns.end(), name) - columns.begin());
  }
  return places;
}

}  // namespace

bool names_column(const std::string& value) {
  return value.find(kSeparator) != std::string::npos;
}

std::optional<TimeFunction> read_trajectory(const XmlElement& element, const char* attribute,
                                            const std::string& value) {
  const std::size_t separator = value.rfind(kSeparator);
  const std::string file = value.substr(0, separator);
  const std::optional<std::vector<std::string>> names = column_names(value.substr(separator + 1));
  if (file.empty() || !names) {
    element.attribute_error(attribute, fmt::format("{} must be FILE#COLUMN or FILE#COLUMN,RATES", attribute));
    return std::nullopt;
  }
  std::optional<CsvTable> table = CsvTable::open(element, attribute, file);
  if (!table) return std::nullopt;
  const std::optional<std::vector<std::size_t>> places = find_columns(*table, *names);
  if (!places) return std::nullopt;

  std::vector<std::vector<double>> read(3);  // times, values, rates
  while (table->next_row()) {
    for (std::size_t i = 0; i < places->size(); ++i) {
      const std::optional<double> number = table->number((*places)[i]);
      if (!number) return std::nullopt;
      if (i == 0 && !read[0].empty() && *number <= read[0].back()) {
        table->error(fmt::format("time must be > {}, that of the row before", read[0].back()), fmt::to_string(*number));
        return std::nullopt;
      }
      read[i].push_back(*number);
    }
  }
  if (table->has_failed()) return std::nullopt;
  try {
    return TimeFunction::spline(std::move(read[0]), std::move(read[1]), std::move(read[2]));
  } catch (const std::invalid_argument& problem) {
    table->error(problem.what());
    return std::nullopt;
  }
}

}  // namespace flexarm::scene
