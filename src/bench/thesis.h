#pragma once
/// The five examples of Muñoz 2004, chapter 12: every run that its text describes, and those that go past it.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/run.h"

namespace flexarm::bench {

/// Elements of a link's beam.
struct MeshChange {
  std::string link;
  int elements;
};

/// One run.
struct ThesisRun {
  std::string scene;    ///< file in the folder of scenes, without its ending
  std::string label;    ///< "node-to-element, alg1"
  std::string scheme;   ///< of the integrator
  std::string contact;  ///< scheme of the slide; empty: the scene's
  bool smooth = false;  ///< C1 line
  double step = 0;      ///< [s]
  std::vector<MeshChange> mesh;
  double stiffness = 1;   ///< factor on all section stiffnesses
  std::string statement;  ///< what the text of the thesis says of it; empty: it has no such run
};

/// What a run gave.
struct ThesisOutcome {
  std::optional<double> arrival;   ///< when the travel's end was crossed, between two steps [s]
  std::optional<Failure> failure;  ///< before that and before the end of the example
  double end = 0;                  ///< time reached [s]
  int halvings = 0;
  double iterations = 0;          ///< of Newton's method per sub-step, rejected ones included
  std::vector<double> crossings;  ///< of the borders of elements [s]
  /// Largest |E - E_0 - work + dissipated| over the largest kinetic, strain and (change of) potential energy.
  double energy_defect = 0;
  double angular_momentum_defect = 0;  ///< the same of the angular momentum about the origin, over its largest value
  double seconds = 0;                  ///< of computing
  /// Rows {time, energy defect, angular momentum defect, then what the example observes}.
  std::vector<std::vector<double>> history;
};

struct ThesisExample {
  std::string number, title;
  double until;                          ///< [s]
  bool ends_at_zero;                     ///< of the travel; else it runs for its time
  bool conserves_angular_momentum;       ///< about the world's origin
  double cost;                           ///< of a simulated second's step, relative: for the progress bar
  std::vector<std::string> observables;  ///< names of the history's further columns
  std::vector<std::string> notes;        ///< readings, and why results differ
  std::vector<ThesisRun> runs;
  /// The arc length of what slides; node-to-node, its like [m].
  std::function<double(const Simulation&)> travel;
  std::function<std::vector<double>(const Simulation&)> observe;
};

std::vector<ThesisExample> thesis_examples();

/// @throws std::runtime_error if the scene cannot be read.
ThesisOutcome run_thesis(const std::string& scene_folder, const ThesisExample& example, const ThesisRun& run,
                         bool quick);

struct ThesisReport {
  std::vector<ThesisExample> examples;
  std::vector<std::vector<ThesisOutcome>> outcomes;  ///< per example and run
};

/// `quick`: ten steps of each run.
ThesisReport measure_thesis(const std::string& scene_folder, bool quick, const std::function<void(double)>& progress);

/// `picture(number)`: file name of an example's picture; empty if there is none.
std::string to_markdown(const ThesisReport& report, const std::function<std::string(const std::string&)>& picture);
/// Columns run, step, time, energy_defect, angular_momentum_defect where that is conserved, then the observables.
std::string histories_to_csv(const ThesisExample& example, const std::vector<ThesisOutcome>& outcomes);

}  // namespace flexarm::bench
