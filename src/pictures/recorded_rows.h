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

/// Records the rows of a run of the scene of `simulation`, which is in its state at the start. Links are where the
/// columns frame/LINK/* have them, or else where the positions of joints put them. Beams are as the columns beam/LINK/*
/// have them, or else bent as by a force at their end; a note of the picture says so.
/// @throws std::invalid_argument if no column has a time, or places a link of the scene
EncodedRun record_rows(const Simulation& simulation, const ResultRows& rows, const RecordingOptions& options);

}  // namespace flexarm::pictures
