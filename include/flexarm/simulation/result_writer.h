#pragma once
/// Results of a simulation as a file, row by row.

#include "flexarm/simulation/result_columns.h"

namespace flexarm {

/// Functions throw std::runtime_error naming the file and the reason where it cannot be written.
class ResultWriter {
 public:
  virtual ~ResultWriter() = default;

  /// Writes a row with the simulation's present state.
  virtual void write_row(const Simulation& simulation) = 0;
  /// To be called at the end: a destructor cannot report what is noticed only then.
  virtual void close() = 0;
  /// To be called after each step: its outcome is in the solver's counts of the next row.
  virtual void note_step(const Simulation&, const StepResult& result) { counts_.add(result); }
  /// Whether note_step() needs the simulation as it is after the step.
  virtual bool looks_at_steps() const { return false; }

 protected:
  /// Counts since the row before; the next one's start again.
  StepCounts take_counts() {
    const StepCounts counts = counts_;
    counts_ = {};
    return counts;
  }

 private:
  StepCounts counts_;
};

}  // namespace flexarm
