#pragma once
/// Speed against error: runs of known problems with many schemes, meshes, steps and tolerances.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/run.h"
#include "flexarm/accuracy/trajectory.h"

namespace flexarm::bench {

// ---------------------------------------------------------------- problems

/// How a run discretises its problem.
struct Discretisation {
  std::string scheme;
  int order;     ///< of all beam elements; 0: the scene file's
  int elements;  ///< in all beams together, in proportion to those of the scene file; 0: those
  double step;   ///< [s]
  double tolerance = IntegratorDescription().tolerance;  ///< of Newton's method
  bool may_be_planar = true;                             ///< see IntegratorDescription

  std::string mesh() const;  ///< "8 x 2": elements and their order; "–": the scene file's
};

struct SpeedProblem {
  std::string name, title;
  std::string scene, commands;  ///< files below the folder of configuration; no commands: empty
  std::string probe;            ///< its positions are compared
  double until;                 ///< [s]
  double interval;              ///< of comparison, a multiple of all steps [s]
  Discretisation reference;     ///< finer than all runs
  std::vector<Discretisation> runs;
  std::string note = {};   ///< what the reader of the report should know
  std::string frame = {};  ///< link in whose frame the probe is compared; empty: the world

  bool has_beams() const { return reference.elements > 0; }
};

/// A figure that flexarm shall reach, and the best of the public programs: tuned for this error, on one machine in one
/// run with flexarm. Machines differ, so only these two compare.
struct SpeedTarget {
  std::string problem;
  double error;                           ///< trajectory_error
  double public_seconds, beside_seconds;  ///< for the whole problem; flexarm's in the same run
  double target_seconds;                  ///< the same
  std::string public_model;               ///< what was fastest there
};

/// Of MuJoCo's time for the same motion at the same error.
struct PeerTarget {
  std::string problem, variant;  ///< "RK4"
  double error, ratio;           ///< flexarm's time over MuJoCo's, at most
};

/// A scene as it is, with its own mesh, in steps of 1 ms: how fast is it for somebody who just runs it?
struct RealTimeScene {
  enum class Unit { TimesRealTime, MicrosecondsPerStep, MicrosecondsPerTwoIterations };

  std::string title, scene, commands, probe;  ///< see SpeedProblem
  std::string scheme;
  double until;  ///< [s]
  Unit unit;     ///< of the target
  double target;
};

std::vector<SpeedProblem> speed_problems();
std::vector<SpeedTarget> speed_targets();
PeerTarget peer_target();
std::vector<RealTimeScene> real_time_scenes();
/// Short runs, few of them: a test of the command, not a measurement.
SpeedProblem shortened(SpeedProblem problem);
RealTimeScene shortened(RealTimeScene scene);

// ---------------------------------------------------------------- runs

/// A point of the world in a frame.
Vector3 in_frame(const Pose& frame, const Vector3& point);

/// What one run of a discretisation gave.
struct SpeedRun {
  std::optional<Failure> failure;
  Trajectory trajectory;     ///< in the problem's frame
  std::vector<Pose> frames;  ///< that frame at the same times; empty: the world
  double build_seconds = 0;  ///< processor time of building the model from a scene that has been read
  double seconds = 0;        ///< processor time of stepping, all steps: the wall time of an idle machine
  double wall_seconds = 0;   ///< wall time of the same
  long steps = 0;
  long iterations = 0, factorisations = 0, halvings = 0;  ///< sums of StepResult's
};

/// `reuse_factorisation`: see StepSettings.
/// @throws std::runtime_error if a file cannot be read, std::invalid_argument if a beam cannot have its share of the
/// elements or the step does not divide the interval.
SpeedRun run_speed(const std::string& folder, const SpeedProblem& problem, const Discretisation& discretisation,
                   bool reuse_factorisation = true);

// ---------------------------------------------------------------- measurements

/// All runs of a discretisation: medians of their times, the counts of the first.
struct SpeedOutcome {
  Discretisation discretisation;
  SpeedRun run;  ///< without its trajectory
  int repetitions = 0;
  double error = 0;  ///< undefined after a failure
};

/// A run by another program.
struct PeerOutcome {
  std::string program, variant;
  int segments;          ///< per beam; 0: all is rigid
  double step, seconds;  ///< step; of the processor, for stepping [s]
  bool completed;
  double error;  ///< undefined unless completed
};

struct SpeedMeasurement {
  SpeedProblem problem;
  SpeedOutcome reference;
  double largest_displacement = 0;  ///< of the probe in the reference [m]: an error of 1
  /// Distance between the reference and the same with half of its elements; with twice its step.
  double mesh_error = 0, step_error = 0;
  std::vector<SpeedOutcome> outcomes;
  std::vector<PeerOutcome> peers;

  double reference_error() const { return mesh_error + step_error; }
  /// A run's own error is at most so large.
  double error_bound(double error) const { return error + reference_error(); }
  /// False where the error of the reference hides that of the run.
  bool resolves(double error) const { return error >= 2 * reference_error(); }
  /// The run with the next smaller step, all else equal; null if there is none.
  const SpeedOutcome* next_finer(const SpeedOutcome& outcome) const;
  /// The fastest run whose error surely is at most so large, by this scheme (empty: any); null if there is none. That
  /// of the next finer run must be, too: else errors of mesh and step happened to cancel.
  const SpeedOutcome* fastest(double error, const std::string& scheme = {}) const;
  /// The fastest of the other programs' runs whose error surely is at most so large; null if there is none.
  const PeerOutcome* fastest_peer(double error, const std::string& variant) const;
};

/// Time per element and full Newton iteration, all included: steps of 0.05 s of the right-angle cantilever.
struct IterationCost {
  std::string scheme;
  int order, elements;
  double seconds;  ///< of the processor
};

/// The same run in a plane and in three dimensions.
struct PlanarComparison {
  std::string problem;
  double error;  ///< that both have, at most
  Discretisation discretisation;
  double plane_seconds, space_seconds;  ///< of the processor
  long steps;
  double difference;  ///< trajectory_error of one beside the other
};

/// The run of median time.
struct RealTimeOutcome {
  RealTimeScene scene;
  SpeedRun run;

  /// In the scene's unit.
  double measured() const;
};

/// Rigid bodies that touch: a run of flexarm or of another program, with steps of 1 ms.
struct ContactRun {
  std::string scene, program;
  double seconds;  ///< of the processor, for all steps [s]
  long steps;
  int most_contacts;  ///< points that touch at a time
  double deepest;     ///< penetration [m]
  double gained;      ///< most that the mechanical energy, less the work from outside, is above its start [J]
  bool completed;
  double crept = 0;        ///< by the last body, up or down, from 1 s to the end [m]
  bool is_driven = false;  ///< there is work from outside, which other programs do not tell
};

struct SpeedReport {
  std::vector<SpeedMeasurement> measurements;
  std::vector<IterationCost> iteration_costs;
  std::vector<RealTimeOutcome> real_time;
  std::vector<PlanarComparison> planar;
  std::vector<ContactRun> contacts;
  bool quick = false;
};

/// Measures problems one after another; `folder`: of configuration, config/ in the sources. Runs of a problem take
/// turns, so that a change of the machine's speed meets all. `progress(part, label)`: part done, in [0, 1].
SpeedReport measure_speed(const std::string& folder, const std::vector<SpeedProblem>& problems, bool quick,
                          const std::function<void(double, const std::string&)>& progress);

/// The fastest runs for some errors, in turns with the same in three dimensions; of problems in a plane.
std::vector<PlanarComparison> compare_planar(const std::string& folder, const SpeedReport& report);
std::string planar_table(const std::vector<PlanarComparison>& comparisons);

/// A chain that falls, a stack and a grasp, of flexarm and, where it is built with it, MuJoCo with its defaults; and
/// scenes of flexarm with contacts that are far, and without.
std::vector<ContactRun> compare_contacts(bool quick);
std::string contact_table(const std::vector<ContactRun>& runs);

/// The tables. `picture`: file name of the picture next to them; empty if there is none.
std::string to_markdown(const SpeedReport& report, const std::string& picture);
/// One row per discretisation, then those of other programs, the references and the targets: see the header line.
std::string runs_to_csv(const SpeedReport& report);

}  // namespace flexarm::bench
