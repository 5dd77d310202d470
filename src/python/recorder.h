#pragma once
/// Records rows of results during runs.

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "flexarm/simulation/result_columns.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::python {

/// Patterns of names of columns.
using Patterns = std::vector<std::string>;

/// @throws std::invalid_argument if there is no such run
inline void require_run(long steps, long every) {
  if (steps < 0) throw std::invalid_argument(fmt::format("steps: expected a number >= 0, got {}", steps));
  if (every < 1) throw std::invalid_argument(fmt::format("every: expected a number >= 1, got {}", every));
}

/// Records a row of results after every `every` steps.
class Recorder {
 public:
  Recorder(ResultColumns* columns, double* place, long every) : columns_(columns), place_(place), every_(every) {}

  void note(const Simulation& simulation, const StepResult& result) {
    counts_.add(result);
    if (!columns_ || !result.converged || ++steps_ % every_ != 0) return;
    const std::vector<double>& row = columns_->row(simulation, counts_);
    place_ = std::copy(row.begin(), row.end(), place_);
    counts_ = {};
    ++rows_;
  }
  pybind11::ssize_t rows() const { return rows_; }

 private:
  ResultColumns* columns_;  // null: nothing is recorded
  double* place_;
  long every_, steps_ = 0;
  pybind11::ssize_t rows_ = 0;
  StepCounts counts_;
};

}  // namespace flexarm::python
