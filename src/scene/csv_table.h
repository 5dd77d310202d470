#pragma once
/// Tables of numbers that lie beside a scene. Their columns may be functions of time, as planners and measurements give
/// them.

#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/xml_element.h"

namespace flexarm::scene {

/// A CSV file that an element names, relative to the scene's folder: a line of names of columns, then rows of numbers.
/// It is read row by row; what is wrong is recorded as an error of the element, with the table's own line.
class CsvTable {
 public:
  /// Nothing, which is recorded, if the file cannot be read. `attribute`: names it; the element must outlive the table.
  static std::optional<CsvTable> open(const XmlElement& element, const char* attribute, const std::string& file);

  const std::vector<std::string>& columns() const { return columns_; }
  /// Goes on to the next row that is not empty; false at the end, and where it has another number of cells.
  bool next_row();
  /// Of the row at hand; recorded if it is not a finite number.
  std::optional<double> number(std::size_t column) const;

  /// About the line at hand. `got`: without quotes.
  void error(const std::string& expected, const std::string& got = "") const;
  bool has_failed() const { return has_failed_; }

 private:
  CsvTable(const XmlElement& element, std::string name, std::ifstream file);
  bool read_cells(std::vector<std::string>& cells);

  const XmlElement* element_;
  std::string name_;
  std::ifstream file_;
  int line_ = 0;
  std::vector<std::string> columns_, cells_;
  mutable bool has_failed_ = false;
};

/// Whether the value of an attribute means a column of a table, not a formula.
bool names_column(const std::string& value);

/// Reads "FILE#COLUMN" or "FILE#COLUMN,RATES": a smooth function through a column of a CSV file over its column `time`
/// [s], which at these times has the rates of the other one. Nothing if there is an error, which is recorded.
std::optional<TimeFunction> read_trajectory(const XmlElement& element, const char* attribute, const std::string& value);

}  // namespace flexarm::scene
