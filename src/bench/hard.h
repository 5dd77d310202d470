#pragma once
/// Hard cases: scenes at which a simulator may break. Each is run with several schemes, in separate processes.

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bench/child_process.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::bench {

/// The result that a run should have at its end.
struct Target {
  std::string what;  ///< source of the target: "closed form"
  std::function<Vector3(const Simulation&)> observe;
  double scale = 1;                 ///< length by which errors are divided, in the unit of the observed quantity
  double tolerance = 0;             ///< largest relative error of a correct run
  std::optional<Vector3> expected;  ///< by a closed form; empty: the result of scheme `em` with `scene` and `step`
  std::string scene;                ///< scene of the reference run; empty: the case's own
  double step = 0;                  ///< [s]
};

/// A condition that must hold after each step: measure(simulation) <= 1.
struct Bound {
  std::string what;  ///< what has happened if it does not hold: "stop gives way by a tenth of the range"
  std::function<double(const Simulation&)> measure;
};

struct HardCase {
  std::string group, name;
  std::string scene;           ///< URDF, without an integrator
  double step = 0, until = 0;  ///< [s]
  /// Whether the mechanism is possible, and its motion is unique and can be represented by the mesh. An unsound case
  /// should be refused, or fail with a reason that says more than that the iteration did not converge.
  bool is_sound = true;
  bool touches = false;  ///< has a <contact>, which some schemes do not support; it must not create energy
  bool is_free = false;  ///< no external forces: momenta are conserved
  int load_steps = 0;    ///< > 0: the case is an equilibrium, found with this number of load steps
  std::optional<Target> target;
  std::optional<Bound> bound;
};

/// All hard cases, by groups. Names are unique.
std::vector<HardCase> hard_cases();

/// Outcome of a run; stored in memory that outlives the run's process.
struct HardOutcome {
  enum class End { Completed, Refused, Failed, OutOfTime, OutOfMemory, Crashed };
  using Text = std::array<char, 256>;

  End end = End::Crashed;
  Text reason{};          ///< why the run was not completed
  bool says_why = false;  ///< whether the reason says more than that the iteration did not converge
  double time = 0;        ///< simulated time that was reached [s]
  long steps = 0, iterations = 0, halvings = 0;
  int most_iterations = 0;  ///< in one step
  double seconds = 0;       ///< processor time, to build and to run
  double energy_gain = 0;   ///< largest increase of energy - work + dissipation since the start; with contacts also of
                            ///< energy - work alone; relative to the largest energy
  double energy_defect =
      0;  ///< largest change of energy - work + dissipation in either direction, relative to the largest energy
  double momentum_defect =
      std::numeric_limits<double>::quiet_NaN();  ///< for a free motion: largest change of momenta, relative
  double bound = 0;                              ///< largest value of the bound's measure
  double error =
      std::numeric_limits<double>::quiet_NaN();  ///< relative, at the end; NaN: no target, or end not reached
  std::array<double, 3> observed{};              ///< the quantity that the target observes, at the end
  Text warning{};                                ///< the first warning of RunSummary

  double iterations_per_step() const { return steps > 0 ? static_cast<double>(iterations) / steps : 0; }
};

/// The judgement on an outcome.
enum class Verdict {
  Right,
  Warned,      ///< like Wrong, but the run ended with a warning
  Wrong,       ///< completed, but misses its target, exceeds its bound, or creates energy
  LeftOut,     ///< the scheme does not support <contact> or <tendon>
  Failed,      ///< did not complete
  Diagnosed,   ///< unsound case: was refused, or ended with a reason
  Unnoticed,   ///< unsound case: was completed
  Undiagnosed  ///< unsound case: ended without a useful reason
};
Verdict verdict(const HardCase& hard, const HardOutcome& outcome);
/// Why an outcome is wrong; empty if it is correct.
std::string flaw(const HardCase& hard, const HardOutcome& outcome);

struct HardOptions {
  std::vector<std::string> schemes = {"em", "em0",     "edmc2", "std",
                                      "m1", "newmark", "hht3"};  ///< the first one is the default scheme
  bool quick = false;  ///< five steps of each case, as a test of the command; results are not compared with targets
  ProcessLimits limits;
};

/// Makes a run in a separate process. `expected`: the value of the target; empty: no comparison.
HardOutcome run_hard(const HardCase& hard, const std::string& scheme, const std::optional<Vector3>& expected,
                     const HardOptions& options);
/// The value of the target, by its closed form or by a run; empty if there is no target or its run fails.
std::optional<Vector3> find_target(const HardCase& hard, const HardOptions& options);

struct HardRow {
  HardCase hard;
  std::vector<HardOutcome> outcomes;  ///< in the order of the schemes
};

struct HardReport {
  HardOptions options;
  std::vector<HardRow> rows;
};

/// `progress(part, case)` is called with the completed fraction, in [0, 1].
HardReport measure_hard(const std::vector<HardCase>& cases, const HardOptions& options,
                        const std::function<void(double, const std::string&)>& progress);

/// The tables. `picture`: file name of the plot in the same folder; empty: none.
std::string to_markdown(const HardReport& report, const std::string& picture);
/// A CSV table with a row for each run.
std::string hard_to_csv(const HardReport& report);

}  // namespace flexarm::bench
