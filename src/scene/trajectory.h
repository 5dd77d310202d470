#pragma once
/// Functions of time as columns of a table, as planners and measurements give them.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Whether the value of an attribute means a column of a table, not a formula.
bool names_column(const std::string& value);

/// Reads "FILE#COLUMN" or "FILE#COLUMN,RATES": a smooth function through a column of a CSV file (see CsvTable) over its
/// column `time` [s], which at these times has the rates of the other one. Nothing if there is an error, which is
/// recorded.
std::optional<TimeFunction> read_trajectory(const XmlElement& element, const char* attribute, const std::string& value);

}  // namespace flexarm::scene
