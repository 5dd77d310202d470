#pragma once
/// How a run went, and what makes its results doubtful.

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Counts what steps came to, and keeps the largest rotation of a node in a step, the largest strain, and the largest
/// defect of the energy account, with where and when they were. One thread may count() while another one does look().
class RunSummary {
 public:
  /// At the beginning of the run.
  explicit RunSummary(const Simulation& simulation);

  /// After each step; takes no time worth mentioning.
  void count(const Simulation& simulation, const StepResult& result);
  /// Looks at strains and energies, which takes as long as to put them out: do it where you do that, and at the end.
  void look(const Simulation& simulation);

  const StepCounts& counts() const { return counts_; }
  /// What was out of bounds: how much, where and when, what it means and what to do; a line each. Empty if all was
  /// well.
  std::vector<std::string> warnings(const Simulation& simulation) const;

 private:
  struct Largest {
    double amount = 0, time = 0;
    int index = -1;         // of a node, or of a link
    double arc_length = 0;  // of a strain [m]
  };
  static double account(const Energies& energies) { return energies.total() - energies.work + energies.dissipated; }
  std::string rotation_warning(const Simulation& simulation) const;
  std::string strain_warning(const Simulation& simulation) const;
  std::string energy_warning() const;

  StepCounts counts_;
  bool conserves_energy_;
  Energies start_;
  double energy_scale_ = 0;  // largest energy of the motion [J]
  Largest rotation_, strain_, energy_;
};

}  // namespace flexarm
