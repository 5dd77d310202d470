#include "bench/outside_references.h"

#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::bench {
namespace {

using Cells = std::vector<std::string>;

[[noreturn]] void refuse(const std::string& file, std::size_t line, const std::string& what) {
  throw std::runtime_error(fmt::format("{}:{}: {}", file, line, what));
}

/// Splits a line into cells; a quoted cell may contain commas.
Cells cells_of(const std::string& line) {
  Cells cells(1);
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"')
      is_quoted = !is_quoted;
    else if (c == ',' && !is_quoted)
      cells.emplace_back();
    else if (c != '\r')
      cells.back() += c;
  }
  return cells;
}

struct Table {
  std::string file;
  Cells head;
  std::vector<Cells> rows;

  double number(std::size_t row, std::size_t column) const {
    const std::string& text = rows[row][column];
    std::size_t end = 0;
    double value = NAN;
    try {
      value = std::stod(text, &end);
    } catch (const std::exception&) {
    }
    if (!std::isfinite(value) || end != text.size())
      refuse(file, row + 2, fmt::format("{}: expected a finite number, got '{}'", head[column], text));
    return value;
  }
};

Table read_table(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(fmt::format("{}: cannot be read", file));
  Table table{file, {}, {}};
  for (std::string line; std::getline(stream, line);) {
    if (table.head.empty()) {
      table.head = cells_of(line);
      continue;
    }
    table.rows.push_back(cells_of(line));
    if (table.rows.back().size() != table.head.size())
      refuse(file, table.rows.size() + 1,
             fmt::format("expected {} columns, got {}", table.head.size(), table.rows.back().size()));
  }
  return table;
}

JudgedMotion read_motion(const std::string& file, double until, int intervals) {
  const Table table = read_table(file);
  const std::size_t columns = table.head.size();
  if (columns < 4 || columns % 3 != 1 || table.head.front() != "time")
    refuse(file, 1, "expected the columns time, x0, y0, z0, ...");
  if (table.rows.size() != static_cast<std::size_t>(intervals) + 1)
    refuse(file, table.rows.size() + 1, fmt::format("expected {} rows, got {}", intervals + 1, table.rows.size()));
  JudgedMotion motion((columns - 1) / 3);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double time = until * static_cast<double>(row) / intervals;
    if (std::abs(table.number(row, 0) - time) > 1e-12 * until)
      refuse(file, row + 2, fmt::format("expected the time {:.17g}, got '{}'", time, table.rows[row][0]));
    std::vector<Vector3> points;
    for (std::size_t c = 1; c < columns; c += 3)
      points.emplace_back(table.number(row, c), table.number(row, c + 1), table.number(row, c + 2));
    motion.add(points);
  }
  return motion;
}

/// Checks that the reference's points start where those of the scene do.
void require_start(const OutsideReference& reference, const std::string& file) {
  const Simulation simulation(reference.scene);
  const std::vector<Vector3> start = JudgedPoints(simulation).positions(simulation);
  const std::vector<Trajectory>& points = reference.motion.points;
  if (start.size() != points.size())
    refuse(file, 1, fmt::format("it has {} points, the scene {}", points.size(), start.size()));
  const double scale = reference.motion.largest_displacement();
  if (!(scale > 0)) refuse(file, 2, "nothing moves");
  for (std::size_t i = 0; i < start.size(); ++i) {
    const double gap = (start[i] - points[i].front()).norm();
    if (gap > kLargestDisagreement * scale)
      refuse(file, 2, fmt::format("point {} is {:.2g} m from where the scene starts", i, gap));
  }
}

OutsideReference read_reference(const Table& index, std::size_t row) {
  std::map<std::string, std::size_t> columns;
  for (std::size_t i = 0; i < index.head.size(); ++i) columns[index.head[i]] = i;
  const auto column = [&](const char* name) {
    const auto found = columns.find(name);
    if (found == columns.end()) refuse(index.file, 1, fmt::format("there is no column '{}'", name));
    return found->second;
  };
  const auto number = [&](const char* name) { return index.number(row, column(name)); };
  OutsideReference out;
  out.group = index.rows[row][column("group")];
  out.name = index.rows[row][column("name")];
  out.is_cornered = number("cornered") != 0;
  out.until = number("until");
  out.intervals = static_cast<int>(number("intervals"));
  out.disagreement = number("disagreement");
  const std::string& kind = index.rows[row][column("reference")];
  if (kind != "outside" && kind != "finer")
    refuse(index.file, row + 2, fmt::format("reference: expected 'outside' or 'finer', got '{}'", kind));
  out.is_there = kind == "outside";
  if (!(out.until > 0) || out.intervals < 1 || out.intervals > 1000000)
    refuse(index.file, row + 2, "expected an end time > 0 and an interval at least");
  if (!(out.disagreement >= 0 && out.disagreement <= kLargestDisagreement))
    refuse(
        index.file, row + 2,
        fmt::format("the reference of '{}' is not good: two runs of it differ by {:.2g} of its way, expected at most "
                    "{:g}",
                    out.name, out.disagreement, kLargestDisagreement));
  return out;
}

}  // namespace

std::vector<OutsideReference> read_outside_references(const std::string& folder, const std::string& only) {
  const Table index = read_table(folder + "/index.csv");
  std::vector<OutsideReference> found;
  for (std::size_t row = 0; row < index.rows.size(); ++row) {
    OutsideReference reference = read_reference(index, row);
    if ((reference.group + ": " + reference.name).find(only) == std::string::npos) continue;
    const std::string stem = folder + "/" + index.rows[row][0];
    scene::ReadResult read = scene::read_scene_file(stem + ".urdf");
    if (!read.scene) throw std::runtime_error(scene::to_text(read.diagnostics));
    reference.scene = std::move(*read.scene);
    if (reference.is_there) {
      reference.motion = read_motion(stem + ".csv", reference.until, reference.intervals);
      require_start(reference, stem + ".csv");
    }
    found.push_back(std::move(reference));
  }
  return found;
}

}  // namespace flexarm::bench
