#include "scene/csv_table.h"

#include <filesystem>

#include <fmt/format.h>

#include "math/parse_number.h"
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

}  // namespace flexarm::scene
