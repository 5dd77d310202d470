#pragma once
/// Results of a simulation as a file, row by row.

#include "flexarm/simulation/result_columns.h"

namespace flexarm {

/// Functions throw std::runtime_error naming the file and the reason if it cannot be written.
class ResultWriter {
 public:
  virtual ~ResultWriter() = default;

  /// Writes a row with the simulation's present state.
  virtual void write_row(const Simulation& simulation) = 0;
  /// Call it at the end: a destructor could not report errors that are noticed only then.
  virtual void close() = 0;
  /// Call it after each step: the next row counts it in the columns of the solver.
  virtual void note_step(const Simulation&, const StepResult& result) { counts_.add(result); }
  /// Whether note_step() needs the simulation as it is after the step.
  virtual bool looks_at_steps() const { return false; }

 protected:
  /// Counts since the last row; they start again from zero.
  StepCounts take_counts() {
    const StepCounts counts = counts_;
    counts_ = {};
    return counts;
  }

 private:
  StepCounts counts_;
};

}  // namespace flexarm
