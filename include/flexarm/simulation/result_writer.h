#pragma once
/// Interface of all writers of result files, which have one row per instant.

#include "flexarm/simulation/result_columns.h"

namespace flexarm {

/// Writes a result file. All functions throw std::runtime_error naming the file and the reason if it cannot be written.
class ResultWriter {
 public:
  virtual ~ResultWriter() = default;

  /// Writes a row with the simulation's present state.
  virtual void write_row(const Simulation& simulation) = 0;
  /// Finishes the file. Call this at the end, because a destructor cannot report errors.
  virtual void close() = 0;
  /// Call this after each step, so that the step counts in the solver columns of the next row.
  virtual void note_step(const Simulation&, const StepResult& result) { counts_.add(result); }
  /// Whether note_step() reads the simulation, which must then be in its state after the step.
  virtual bool looks_at_steps() const { return false; }

 protected:
  /// Returns the counts since the last call, and resets them.
  StepCounts take_counts() {
    const StepCounts counts = counts_;
    counts_ = {};
    return counts;
  }

 private:
  StepCounts counts_;
};

}  // namespace flexarm
