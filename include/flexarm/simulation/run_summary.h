#pragma once
/// A summary of a run, with what makes its results doubtful.

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Counts steps and what they needed. Keeps the largest rotation of a node in a step, the largest strain and the
/// largest defect of the energy account, with place and time. One thread may count() while another one calls look().
class RunSummary {
 public:
  /// At the beginning of the run.
  explicit RunSummary(const Simulation& simulation);

  /// Call it after each step; it takes hardly any time.
  void count(const Simulation& simulation, const StepResult& result);
  /// Evaluates strains and energies, which takes as long as writing them. Call it when you write results, and at the
  /// end.
  void look(const Simulation& simulation);

  const StepCounts& counts() const { return counts_; }
  /// Warnings: what was out of bounds by how much, where and when, what that means and what to do; a line for each.
  /// Empty if all was well.
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
