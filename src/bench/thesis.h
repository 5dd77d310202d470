#pragma once
/// The five examples of Muñoz 2004, chapter 12: all runs that the text describes, and further ones.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/run.h"

namespace flexarm::bench {

/// Sets the number of elements of a link's beam.
struct MeshChange {
  std::string link;
  int elements;
};

/// The definition of a run.
struct ThesisRun {
  std::string scene;    ///< file in the folder of scenes, without its extension
  std::string label;    ///< for example "node-to-element, alg1"
  std::string scheme;   ///< of the integrator
  std::string contact;  ///< contact scheme of the slide; empty: the scene's
  bool smooth = false;  ///< whether the line is C1-continuous
  double step = 0;      ///< [s]
  std::vector<MeshChange> mesh;
  double stiffness = 1;   ///< factor on all section stiffnesses
  std::string statement;  ///< what the thesis says about the run; empty: it has no such run
};

/// The result of a run.
struct ThesisOutcome {
  std::optional<double> arrival;   ///< when the slider passed the end of its travel, interpolated between two steps [s]
  std::optional<Failure> failure;  ///< before that, and before the end of the example
  double end = 0;                  ///< time reached [s]
  int halvings = 0;
  double iterations = 0;          ///< of Newton's method per sub-step, including rejected ones
  std::vector<double> crossings;  ///< times at which borders between elements were passed [s]
  /// Largest |E - E_0 - work + dissipated| over the largest kinetic, strain and (change of) potential energy.
  double energy_defect = 0;
  double angular_momentum_defect =
      0;               ///< the same for the angular momentum about the origin, relative to its largest value
  double seconds = 0;  ///< computing time
  /// Rows {time, energy defect, angular momentum defect, then the example's observables}.
  std::vector<std::vector<double>> history;
};

struct ThesisExample {
  std::string number, title;
  double until;                          ///< [s]
  bool ends_at_zero;                     ///< whether a run ends when the travel is zero; otherwise it ends at `until`
  bool conserves_angular_momentum;       ///< about the world's origin
  double cost;                           ///< relative cost per simulated second and step, for the progress bar
  std::vector<std::string> observables;  ///< names of the further columns of the history
  std::vector<std::string> notes;        ///< interpretations of the text, and reasons why results differ
  std::vector<ThesisRun> runs;
  /// The arc length at the slider; node-to-node, the corresponding distance [m].
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

/// `quick`: only ten steps per run.
ThesisReport measure_thesis(const std::string& scene_folder, bool quick, const std::function<void(double)>& progress);

/// `picture(number)`: file name of an example's plot; empty: none.
std::string to_markdown(const ThesisReport& report, const std::function<std::string(const std::string&)>& picture);
/// A CSV table with the columns run, step, time, energy_defect, angular_momentum_defect (if it is conserved), and the
/// observables.
std::string histories_to_csv(const ThesisExample& example, const std::vector<ThesisOutcome>& outcomes);

}  // namespace flexarm::bench
