#pragma once
/// Measures speed and error: runs of known problems with many schemes, meshes, steps and tolerances.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/run.h"
#include "flexarm/accuracy/trajectory.h"

namespace flexarm::bench {

// ---------------------------------------------------------------- problems

/// The discretisation of a problem in a run.
struct Discretisation {
  std::string scheme;
  int order;     ///< of all beam elements; 0: as in the scene file
  int elements;  ///< in all beams together, distributed as in the scene file; 0: as in the scene file
  double step;   ///< [s]
  double tolerance = IntegratorDescription().tolerance;  ///< of Newton's method
  bool may_be_planar = true;                             ///< see IntegratorDescription

  std::string mesh() const;  ///< "8 x 2": elements and their order; "–": as in the scene file
};

struct SpeedProblem {
  std::string name, title;
  std::string scene, commands;  ///< files below the configuration folder; empty: no commands
  std::string probe;            ///< the probe whose positions are compared
  double until;                 ///< [s]
  double interval;              ///< interval between comparisons, a multiple of all steps [s]
  Discretisation reference;     ///< finer than all runs
  std::vector<Discretisation> runs;
  std::string note = {};   ///< what readers of the report should know
  std::string frame = {};  ///< link in whose frame the probe's positions are compared; empty: the world

  bool has_beams() const { return reference.elements > 0; }
};

/// A target for flexarm, and the result of the best public program. Both were tuned for this error, and measured on the
/// same machine at the same time as flexarm. Times on other machines cannot be compared with these.
struct SpeedTarget {
  std::string problem;
  double error;                           ///< trajectory_error
  double public_seconds, beside_seconds;  ///< for the whole problem; of flexarm in the same session
  double target_seconds;                  ///< for the whole problem
  std::string public_model;               ///< the fastest model of the public program
};

/// A target relative to MuJoCo's time for the same motion with the same error.
struct PeerTarget {
  std::string problem, variant;  ///< "RK4"
  double error, ratio;           ///< largest ratio of flexarm's time to MuJoCo's
};

/// A scene with its own mesh and steps of 1 ms: measures the speed that a user gets without tuning.
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
std::vector<PeerTarget> peer_targets();
std::vector<RealTimeScene> real_time_scenes();
/// Fewer and shorter runs, to test the command rather than to measure.
SpeedProblem shortened(SpeedProblem problem);
RealTimeScene shortened(RealTimeScene scene);

// ---------------------------------------------------------------- runs

/// Converts a point of the world to a frame.
Vector3 in_frame(const Pose& frame, const Vector3& point);

/// The result of one run of a discretisation.
struct SpeedRun {
  std::optional<Failure> failure;
  Trajectory trajectory;     ///< in the problem's frame
  std::vector<Pose> frames;  ///< poses of that frame at the same times; empty: the world
  double build_seconds = 0;  ///< processor time to build the model from a scene that was already read
  double seconds = 0;        ///< processor time of all steps, which is the wall time on an idle machine
  double wall_seconds = 0;   ///< wall time of all steps
  long steps = 0;
  long iterations = 0, factorisations = 0, halvings = 0;  ///< sums over all StepResults
};

/// @param reuse_factorisation  see StepSettings
/// @throws std::runtime_error if a file cannot be read, std::invalid_argument if the elements cannot be distributed
/// over the beams, or if the step does not divide the interval
SpeedRun run_speed(const std::string& folder, const SpeedProblem& problem, const Discretisation& discretisation,
                   bool reuse_factorisation = true);

// ---------------------------------------------------------------- measurements

/// The result of all runs of a discretisation: medians of their times, and the counts of the first run.
struct SpeedOutcome {
  Discretisation discretisation;
  SpeedRun run;  ///< without its trajectory
  int repetitions = 0;
  double error = 0;  ///< undefined if the run failed
};

/// A run by another program.
struct PeerOutcome {
  std::string program, variant;
  int segments;          ///< per beam; 0: everything is rigid
  double step, seconds;  ///< length of a step; processor time of all steps [s]
  bool completed;
  double error;  ///< undefined unless completed
};

struct SpeedMeasurement {
  SpeedProblem problem;
  SpeedOutcome reference;
  double largest_displacement = 0;  ///< of the probe in the reference [m]; errors are relative to it
  /// Differences between the reference and the same run with half of the elements, and with twice the step.
  double mesh_error = 0, step_error = 0;
  std::vector<SpeedOutcome> outcomes;
  std::vector<PeerOutcome> peers;

  double reference_error() const { return mesh_error + step_error; }
  /// Upper bound of a run's own error.
  double error_bound(double error) const { return error + reference_error(); }
  /// False if the error of the reference is too large to measure this error.
  bool resolves(double error) const { return error >= 2 * reference_error(); }
  /// The run with the next smaller step and otherwise equal settings; null if there is none.
  const SpeedOutcome* next_finer(const SpeedOutcome& outcome) const;
  /// The fastest run with this scheme (empty: any) whose error certainly is at most `error`; null if there is none.
  /// This must also hold for the next finer run: otherwise errors of mesh and step may have cancelled by chance.
  const SpeedOutcome* fastest(double error, const std::string& scheme = {}) const;
  /// The fastest run of other programs whose error certainly is at most `error`; null if there is none.
  const PeerOutcome* fastest_peer(double error, const std::string& variant) const;
};

/// Total time per element and full Newton iteration, in steps of 0.05 s of the right-angle cantilever.
struct IterationCost {
  std::string scheme;
  int order, elements;
  double seconds;  ///< of the processor
};

/// Times of the same run in a plane and in three dimensions.
struct PlanarComparison {
  std::string problem;
  double error;  ///< upper bound for both runs
  Discretisation discretisation;
  double plane_seconds, space_seconds;  ///< processor time
  long steps;
  double difference;  ///< trajectory_error between the two runs
};

/// The run with the median time.
struct RealTimeOutcome {
  RealTimeScene scene;
  SpeedRun run;

  /// The result in the scene's unit.
  double measured() const;
};

/// A run of rigid bodies with contacts, in flexarm or another program, with steps of 1 ms.
struct ContactRun {
  std::string scene, program;
  double seconds;  ///< processor time of all steps [s]
  long steps;
  int most_contacts;  ///< most contact points at a time
  double deepest;     ///< largest penetration [m]
  double
      gained;  ///< largest increase of the mechanical energy, without the work of external forces, since the start [J]
  bool completed;
  double crept = 0;        ///< vertical motion of the last body from 1 s to the end [m]
  bool is_driven = false;  ///< external forces do work, which other programs do not report
};

/// Arms that are stepped one after the other by one thread, and together by several (Batch). Medians of wall times.
struct BatchComparison {
  std::string scene;
  std::size_t arms;
  int threads;  ///< of the batch
  long steps;   ///< of each arm
  double alone_seconds, together_seconds;
};

struct SpeedReport {
  std::vector<SpeedMeasurement> measurements;
  std::vector<IterationCost> iteration_costs;
  std::vector<RealTimeOutcome> real_time;
  std::vector<PlanarComparison> planar;
  std::vector<ContactRun> contacts;
  std::vector<BatchComparison> batches;
  bool quick = false;
};

/// Measures problems one after another; `folder`: the configuration folder, config/ in the sources. The runs of a
/// problem are made in turns, so that changes of the machine's speed affect all. `progress(part, label)`: completed
/// fraction.
SpeedReport measure_speed(const std::string& folder, const std::vector<SpeedProblem>& problems, bool quick,
                          const std::function<void(double, const std::string&)>& progress);

/// For plane problems: the fastest runs for some errors, in turns with the same runs in three dimensions.
std::vector<PlanarComparison> compare_planar(const std::string& folder, const SpeedReport& report);
std::string planar_table(const std::vector<PlanarComparison>& comparisons);

/// Runs of flexarm and, if it is built with it, of MuJoCo with its defaults: a falling chain, a stack, and a grasp.
/// Also scenes of flexarm with contacts that are never close, and without contacts.
std::vector<ContactRun> compare_contacts(bool quick);
std::string contact_table(const std::vector<ContactRun>& runs);

/// Times of many arms. `folder`: as of measure_speed().
std::vector<BatchComparison> compare_batches(const std::string& folder, bool quick);
std::string batch_table(const std::vector<BatchComparison>& comparisons);

/// The tables. `picture`: file name of the plot in the same folder; empty: none.
std::string to_markdown(const SpeedReport& report, const std::string& picture);
/// A CSV table: one row per discretisation, then runs of other programs, references and targets; see its header line.
std::string runs_to_csv(const SpeedReport& report);

}  // namespace flexarm::bench
