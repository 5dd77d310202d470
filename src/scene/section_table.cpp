#include "scene/section_reader.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/csv_table.h"

namespace flexarm::scene {
namespace {

constexpr const char* kDirect[] = {"ea", "ga2", "ga3", "gj", "ei2", "ei3", "mass", "j1", "j2", "j3"};
constexpr std::size_t kMostStations = 100000;

/// Returns the names of an upper triangle's columns: "k11", "k12", ..., "k66" for the letter k.
std::vector<std::string> triangle(char letter) {
  std::vector<std::string> names;
  for (int i = 1; i <= 6; ++i)
    for (int j = i; j <= 6; ++j) names.push_back(fmt::format("{}{}{}", letter, i, j));
  return names;
}

/// A row of the table: numbers by the names of their columns.
using Row = std::map<std::string, double>;

Matrix6 symmetric_matrix(const Row& row, char letter) {
  Matrix6 out;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) out(i, j) = out(j, i) = row.at(fmt::format("{}{}{}", letter, i + 1, j + 1));
  return out;
}

/// Reads stations from a table.
class StationReader {
 public:
  explicit StationReader(CsvTable table) : table_(std::move(table)) {}

  std::optional<SectionStations> read() {
    if (!check_columns()) return std::nullopt;
    SectionStations out;
    while (table_.next_row()) {
      const std::optional<Row> row = read_row();
      if (!row) return std::nullopt;
      const double at = row->at("at");
      if (!out.arc_lengths.empty() && !(at > out.arc_lengths.back())) {
        table_.error(fmt::format("at must be > {}, the value of the line before", out.arc_lengths.back()),
                     fmt::to_string(at));
        return std::nullopt;
      }
      const std::optional<UniformSection> section = is_direct_ ? direct(*row) : matrices(*row);
      if (!section) return std::nullopt;
      if (out.sections.size() == kMostStations) {
        table_.error(fmt::format("a table has at most {} stations", kMostStations));
        return std::nullopt;
      }
      out.arc_lengths.push_back(at);
      out.sections.push_back(*section);
    }
    if (out.sections.size() < 2 && !table_.has_failed()) table_.error("at least two stations are expected");
    if (table_.has_failed()) return std::nullopt;
    return out;
  }

 private:
  bool check_columns() {
    std::vector<std::string> direct(std::begin(kDirect), std::end(kDirect)), matrices = triangle('k');
    for (const std::string& name : triangle('m')) matrices.push_back(name);
    const std::vector<std::string> sorted = sorted_names(table_.columns());
    for (std::vector<std::string>* names : {&direct, &matrices}) {
      names->push_back("at");
      if (sorted_names(*names) != sorted) continue;
      is_direct_ = names == &direct;
      return true;
    }
    table_.error(
        fmt::format("the columns {}, or at, k11, k12, ..., k66, m11, m12, ..., m66 (upper triangles) are "
                    "expected",
                    fmt::join(direct, ", ")));
    return false;
  }

  static std::vector<std::string> sorted_names(std::vector<std::string> names) {
    std::sort(names.begin(), names.end());
    return names;
  }

  std::optional<Row> read_row() const {
    Row row;
    for (std::size_t c = 0; c < table_.columns().size(); ++c) {
      const std::optional<double> value = table_.number(c);
      if (!value) return std::nullopt;
      row[table_.columns()[c]] = *value;
    }
    if (row["at"] >= 0) return row;
    table_.error("at must be >= 0", fmt::to_string(row["at"]));
    return std::nullopt;
  }

  std::optional<UniformSection> direct(const Row& row) const {
    for (const char* name : kDirect) {
      const bool may_vanish = name[0] == 'j';
      if (row.at(name) > 0 || (may_vanish && row.at(name) == 0)) continue;
      table_.error(fmt::format("{} must be {} 0", name, may_vanish ? ">=" : ">"), fmt::to_string(row.at(name)));
      return std::nullopt;
    }
    return DirectSection{row.at("ea"),  row.at("ga2"),  row.at("ga3"), row.at("gj"), row.at("ei2"),
                         row.at("ei3"), row.at("mass"), row.at("j1"),  row.at("j2"), row.at("j3")};
  }

  std::optional<UniformSection> matrices(const Row& row) const {
    const MatrixSection section{symmetric_matrix(row, 'k'), symmetric_matrix(row, 'm')};
    if (!is_positive_definite(section.stiffness)) {
      table_.error("the stiffness k11 to k66 must be positive definite");
    } else if (!is_inertia(section.inertia)) {
      table_.error("the inertia m11 to m66 must be [[m 1, -m d^], [m d^, J]] with mass per length m > 0");
    } else {
      return section;
    }
    return std::nullopt;
  }

  CsvTable table_;
  bool is_direct_ = true;
};

}  // namespace

std::optional<SectionStations> read_section_table(const XmlElement& stations) {
  stations.expect_only({"file"});
  const std::optional<std::string> name = stations.text("file");
  if (!name) return std::nullopt;
  std::optional<CsvTable> table = CsvTable::open(stations, "file", *name);
  if (!table) return std::nullopt;
  return StationReader(std::move(*table)).read();
}

}  // namespace flexarm::scene
