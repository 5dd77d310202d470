#pragma once
/// Collects statistics of a run, and warns if they make the results doubtful.

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Counts steps and their recoveries. Records the largest rotation of a node in a step, the element that was bent most,
/// the largest strain and the largest error of the energy balance, with place and time. One thread may call count()
/// while another one calls look().
class RunSummary {
 public:
  /// Call this at the beginning of the run.
  explicit RunSummary(const Simulation& simulation);

  /// Call this after each step; it takes hardly any time.
  void count(const Simulation& simulation, const StepResult& result);
  /// Evaluates strains and energies, which takes as long as writing a row with them. Call this when you write results,
  /// and at the end of the run.
  void look(const Simulation& simulation);

  const StepCounts& counts() const { return counts_; }
  /// Largest error of the energy balance, relative to the largest energy of the motion so far.
  double energy_drift() const { return energy_scale_ > 0 ? energy_.amount / energy_scale_ : 0; }
  /// Warnings, one line each: which value was out of bounds, by how much, where and when, the consequence and a remedy.
  /// Empty if everything was within its bounds.
  std::vector<std::string> warnings(const Simulation& simulation) const;

 private:
  struct Largest {
    double amount = 0, time = 0;
    int index = -1;                // of the link
    double arc_length = 0;         // position of the largest strain [m]
    StepResult::Place place = {};  // of the node that turned most, or of the element that was bent most
  };
  void look_at_bending(const Simulation& simulation);
  static double account(const Energies& energies) { return energies.total() - energies.work + energies.dissipated; }
  std::string rotation_warning(const Simulation& simulation) const;
  std::string bending_warning(const Simulation& simulation) const;
  std::string strain_warning(const Simulation& simulation) const;
  std::string energy_warning() const;

  StepCounts counts_;
  bool conserves_energy_, is_explicit_;
  Energies start_;
  double energy_scale_ = 0;  // largest energy of the motion so far [J]
  Largest rotation_, bending_, strain_, energy_;
};

}  // namespace flexarm
