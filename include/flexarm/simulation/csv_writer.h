#pragma once
/// Results of a simulation as comma-separated values.

#include <cstdio>
#include <memory>
#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// One file: a header line, then a row per call. Numbers have 17 significant digits, so that they are read back bit for
/// bit, whatever the locale. Columns, in this order, SI units, world axes, quaternions x y z w:
///   time
///   joint/NAME/position|velocity|effort      for every released coordinate
///   frame/LINK/x|y|z|qx|qy|qz|qw             for every link
///   probe/NAME/x|y|z|qx|qy|qz|qw|vx|vy|vz    for every probe
///   energy/kinetic|strain|potential|total|work|dissipated
///   momentum/x|y|z, angular_momentum/x|y|z   (about the world origin)
///   solver/step|iterations|halvings|deepest_halving|other_guesses|dissipated_steps
///                                            only of a simulation in time: step size, and StepCounts since the row
///                                            before
class CsvWriter {
 public:
  enum class Columns { State, StateAndSolver };

  /// Creates the file and writes the header. The path "-" means the standard output.
  /// @throws std::runtime_error naming the file and the reason if that fails; so do the other functions. Rows that were
  ///   written before are then whole.
  CsvWriter(const std::string& path, const Simulation& simulation, Columns columns);

  /// Writes a row with the simulation's present state.
  void write_row(const Simulation& simulation);
  /// Adds the outcome of a step to the solver's counts in the next row.
  void count(const StepResult& result);
  /// To be called at the end: the destructor cannot report what a remote file system notices only then.
  void close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void write_line(std::string& line);

  std::string path_, line_;
  std::unique_ptr<std::FILE, Closer> file_;
  Columns columns_;
  long written_ = 0;   // bytes of whole rows
  StepCounts counts_;  // since the last row
};

}  // namespace flexarm
