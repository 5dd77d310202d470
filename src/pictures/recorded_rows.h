#pragma once
/// Shows runs of which only rows of results are left.

#include <string>
#include <vector>

#include "pictures/recording.h"

namespace flexarm::pictures {

/// Rows of results: `values` has one number for each column of each row.
struct ResultRows {
  std::vector<ResultColumn> columns;  ///< one of them is `time`
  std::vector<double> values;
  std::vector<std::string> notes = {};  ///< for the user: what the rows lack
  std::size_t count() const { return columns.empty() ? 0 : values.size() / columns.size(); }
};

/// Records the rows of a run of the scene of `simulation`, which is in its state at the start. RecordedMotion says
/// where things are, RecordedArrows which forces act. Strains and stress resultants of beams are those of the columns
/// beam/LINK/*, or else unknown. Notes of the picture say what the rows lack; without a column that places a link, all
/// links stay at the start.
/// @throws std::invalid_argument if no column has a time
EncodedRun record_rows(const Simulation& simulation, const ResultRows& rows, const RecordingOptions& options);

}  // namespace flexarm::pictures
