#include "scene/section_table.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include "math/parse_number.h"
#include "scene/section_matrix.h"

namespace flexarm::scene {
namespace {

constexpr const char* kDirect[] = {"ea", "ga2", "ga3", "gj", "ei2", "ei3", "mass", "j1", "j2", "j3"};
constexpr std::size_t kMostStations = 100000;

std::vector<std::string> cells(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> out(1);
  for (const char c : line) {
    if (c == ',')
      out.emplace_back();
    else if (c != ' ' && c != '\t')
      out.back() += c;
  }
  return out;
}

/// "k11", "k12", ..., "k66".
std::vector<std::string> triangle(char letter) {
  std::vector<std::string> names;
  for (int i = 1; i <= 6; ++i)
    for (int j = i; j <= 6; ++j) names.push_back(fmt::format("{}{}{}", letter, i, j));
  return names;
}

/// A line of the table by the names of its columns.
using Row = std::map<std::string, double>;

Matrix6 symmetric_matrix(const Row& row, char letter) {
  Matrix6 out;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) out(i, j) = out(j, i) = row.at(fmt::format("{}{}{}", letter, i + 1, j + 1));
  return out;
}

class Table {
 public:
  Table(const XmlElement& stations, std::string name) : stations_(stations), name_(std::move(name)) {}

  std::optional<SectionStations> read(std::istream& file) {
    std::string line;
    std::getline(file, line);
    columns_ = cells(line);
    if (!check_columns()) return std::nullopt;
    SectionStations out;
    for (line_ = 2; std::getline(file, line); ++line_) {
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      const std::optional<Row> row = read_row(cells(line));
      if (!row) return std::nullopt;
      const double at = row->at("at");
      if (!out.arc_lengths.empty() && !(at > out.arc_lengths.back())) {
        error(fmt::format("at must be > {}, that of the line before", out.arc_lengths.back()), fmt::to_string(at));
        return std::nullopt;
      }
      const std::optional<UniformSection> section = is_direct_ ? direct(*row) : matrices(*row);
      if (!section) return std::nullopt;
      if (out.sections.size() == kMostStations) {
        error(fmt::format("a table has at most {} stations", kMostStations));
        return std::nullopt;
      }
      out.arc_lengths.push_back(at);
      out.sections.push_back(*section);
    }
    if (out.sections.size() >= 2) return out;
    error("at least two stations are expected");
    return std::nullopt;
  }

 private:
  bool check_columns() {
    std::vector<std::string> direct(std::begin(kDirect), std::end(kDirect)), matrices = triangle('k');
    for (const std::string& name : triangle('m')) matrices.push_back(name);
    const std::vector<std::string> sorted = sorted_names(columns_);
    for (std::vector<std::string>* names : {&direct, &matrices}) {
      names->push_back("at");
      if (sorted_names(*names) != sorted) continue;
      is_direct_ = names == &direct;
      return true;
    }
    error(fmt::format("the columns {}, or at, k11, k12, ..., k66, m11, m12, ..., m66 (upper triangles) are expected",
                      fmt::join(direct, ", ")));
    return false;
  }

  static std::vector<std::string> sorted_names(std::vector<std::string> names) {
    std::sort(names.begin(), names.end());
    return names;
  }

  std::optional<Row> read_row(const std::vector<std::string>& values) const {
    if (values.size() != columns_.size()) {
      error(fmt::format("{} numbers are expected", columns_.size()), fmt::to_string(values.size()));
      return std::nullopt;
    }
    Row row;
    for (std::size_t c = 0; c < values.size(); ++c) {
      const std::optional<double> value = parse_number(values[c]);
      if (!value) {
        error(columns_[c] + " must be a finite number", values[c]);
        return std::nullopt;
      }
      row[columns_[c]] = *value;
    }
    if (row["at"] >= 0) return row;
    error("at must be >= 0", fmt::to_string(row["at"]));
    return std::nullopt;
  }

  std::optional<UniformSection> direct(const Row& row) const {
    for (const char* name : kDirect) {
      const bool may_vanish = name[0] == 'j';
      if (row.at(name) > 0 || (may_vanish && row.at(name) == 0)) continue;
      error(fmt::format("{} must be {} 0", name, may_vanish ? ">=" : ">"), fmt::to_string(row.at(name)));
      return std::nullopt;
    }
    return DirectSection{row.at("ea"),  row.at("ga2"),  row.at("ga3"), row.at("gj"), row.at("ei2"),
                         row.at("ei3"), row.at("mass"), row.at("j1"),  row.at("j2"), row.at("j3")};
  }

  std::optional<UniformSection> matrices(const Row& row) const {
    const MatrixSection section{symmetric_matrix(row, 'k'), symmetric_matrix(row, 'm')};
    if (!is_positive_definite(section.stiffness)) {
      error("the stiffness k11 to k66 must be positive definite");
    } else if (!is_inertia(section.inertia)) {
      error("the inertia m11 to m66 must be [[m 1, -m d^], [m d^, J]] with mass per length m > 0");
    } else {
      return section;
    }
    return std::nullopt;
  }

  void error(const std::string& expected, const std::string& got = "") const {
    stations_.error(fmt::format("{}:{}: {}", name_, line_, expected), got.empty() ? got : "'" + got + "'");
  }

  const XmlElement& stations_;
  std::string name_;
  int line_ = 1;
  std::vector<std::string> columns_;
  bool is_direct_ = true;
};

}  // namespace

std::optional<SectionStations> read_section_table(const XmlElement& stations) {
  stations.expect_only({"file"});
  const std::optional<std::string> name = stations.text("file");
  if (!name) return std::nullopt;
  const std::filesystem::path path = std::filesystem::path(stations.findings().file()).parent_path() / *name;
  std::ifstream file(path);
  if (!file || !std::filesystem::is_regular_file(path)) {
    stations.attribute_error("file", "file must be a table that can be read, relative to the scene's folder");
    return std::nullopt;
  }
  return Table(stations, *name).read(file);
}

}  // namespace flexarm::scene
