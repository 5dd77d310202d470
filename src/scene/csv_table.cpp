#include "scene/csv_table.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "math/number_text.h"
#include "scene/limits.h"

namespace flexarm::scene {

std::optional<CsvTable> CsvTable::open(const XmlElement& element, const char* attribute, const std::string& file) {
  const std::filesystem::path path = std::filesystem::path(element.findings().file()).parent_path() / file;
  std::error_code fault;
  std::ifstream stream(path);
  if (!stream || !std::filesystem::is_regular_file(path, fault)) {
    element.attribute_error(
        attribute, fmt::format("{} must name a table that can be read, relative to the scene's folder", attribute));
    return std::nullopt;
  }
  if (std::filesystem::file_size(path, fault) > kLargestFile) {
    element.attribute_error(attribute, fmt::format("a table may have {} bytes", kLargestFile));
    return std::nullopt;
  }
  return CsvTable(element, file, std::move(stream));
}

CsvTable::CsvTable(const XmlElement& element, std::string name, std::ifstream file)
    : element_(&element), name_(std::move(name)), file_(std::move(file)) {
  if (!read_cells(columns_)) line_ = 1;
}

bool CsvTable::read_cells(std::vector<std::string>& cells) {
  std::string line;
  if (!std::getline(file_, line)) return false;
  ++line_;
  cells.assign(1, "");
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else if (c != ' ' && c != '\t' && c != '\r')
      cells.back() += c;
  }
  return true;
}

bool CsvTable::next_row() {
  do {
    if (!read_cells(cells_)) return false;
  } while (cells_.size() == 1 && cells_.front().empty());
  if (cells_.size() == columns_.size()) return true;
  error(fmt::format("{} numbers are expected", columns_.size()), fmt::to_string(cells_.size()));
  return false;
}

std::optional<double> CsvTable::number(std::size_t column) const {
  const std::optional<double> value = parse_number(cells_[column]);
  if (!value) error(columns_[column] + " must be a finite number", cells_[column]);
  return value;
}

void CsvTable::error(const std::string& expected, const std::string& got) const {
  has_failed_ = true;
  element_->error(fmt::format("{}:{}: {}", name_, line_, expected), got.empty() ? "" : scene::quoted(got));
}

// ---------------------------------------------------------------- functions of time

namespace {

constexpr char kSeparator = '#';  // occurs in no expression

/// Returns "time" and the names in "COLUMN" or "COLUMN,RATES". Returns nothing if the text has another form.
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

/// Returns the indices of the named columns. Returns nothing if a column is missing or not unique.
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
        table->error(fmt::format("time must be > {}, the time of the row before", read[0].back()),
                     fmt::to_string(*number));
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
