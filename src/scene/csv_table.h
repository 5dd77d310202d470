#pragma once
/// Reads CSV files that a scene refers to: tables of numbers, whose columns may be functions of time, for example from
/// a motion planner or a measurement.

#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/xml_element.h"

namespace flexarm::scene {

/// A CSV file that an XML element names, relative to the scene's folder. Its first line has the names of the columns,
/// the others have numbers. The file is read row by row. Faults are recorded as errors of the element; their texts name
/// the line of the table.
class CsvTable {
 public:
  /// Opens the file that the element's `attribute` names. If it cannot be read, records an error and returns nothing.
  /// The element must outlive the table.
  static std::optional<CsvTable> open(const XmlElement& element, const char* attribute, const std::string& file);

  const std::vector<std::string>& columns() const { return columns_; }
  /// Reads the next row that is not empty. Returns false at the end of the file. Also returns false, and records an
  /// error, if the row has another number of cells than the first line.
  bool next_row();
  /// Returns a number of the current row. If the cell is not a finite number, records an error and returns nothing.
  std::optional<double> number(std::size_t column) const;

  /// Records an error about the current line. `got`: without quotes.
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

/// Whether the value of an attribute names a column of a table ("FILE#COLUMN"), and is not a formula.
bool names_column(const std::string& value);

/// Reads "FILE#COLUMN" or "FILE#COLUMN,RATES": a spline through the values in COLUMN of a CSV file over its column
/// `time` [s]. If RATES is given, the time derivative of the spline takes the values of that column. If there is an
/// error, records it and returns nothing.
std::optional<TimeFunction> read_trajectory(const XmlElement& element, const char* attribute, const std::string& value);

}  // namespace flexarm::scene
