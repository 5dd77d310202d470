#pragma once
/// Hard cases: scenes at which a simulator may break, each run with several schemes in a process of its own.

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

/// Where a run should have come to at its end.
struct Target {
  std::string what;  ///< where it is from: "closed form"
  std::function<Vector3(const Simulation&)> observe;
  double scale = 1;                 ///< errors are relative to it, in units of what is observed
  double tolerance = 0;             ///< largest error of a right run, relative
  std::optional<Vector3> expected;  ///< by a closed form; empty: what `em` comes to with `scene` and `step`
  std::string scene;                ///< empty: the case's own
  double step = 0;                  ///< [s]
};

/// What may never be exceeded: measure(simulation) <= 1 after each step.
struct Bound {
  std::string what;  ///< what is so if it is exceeded: "stop gives way by a tenth of the range"
  std::function<double(const Simulation&)> measure;
};

struct HardCase {
  std::string group, name;
  std::string scene;           ///< URDF, without an integrator
  double step = 0, until = 0;  ///< [s]
  /// The mechanism could be built and has one motion, which the mesh can describe; else it is to be refused, or to fail
  /// with a reason that says more than that the iteration did not converge.
  bool is_sound = true;
  bool touches = false;  ///< has a <contact>, which not all schemes have, and from which no energy may come
  bool is_free = false;  ///< nothing acts on it from outside: momenta are kept
  int load_steps = 0;    ///< > 0: an equilibrium is asked for, with so many steps of the load
  std::optional<Target> target;
  std::optional<Bound> bound;
};

/// All of them, group by group. Names are unique.
std::vector<HardCase> hard_cases();

/// What a run came to; stands in memory that outlives its process.
struct HardOutcome {
  enum class End { Completed, Refused, Failed, OutOfTime, OutOfMemory, Crashed };
  using Text = std::array<char, 256>;

  End end = End::Crashed;
  Text reason{};          ///< why it did not complete
  bool says_why = false;  ///< the reason is more than that the iteration did not converge
  double time = 0;        ///< reached [s]
  long steps = 0, iterations = 0, halvings = 0;
  int most_iterations = 0;   ///< of a step
  double seconds = 0;        ///< of the processor, to build and to run
  double energy_gain = 0;    ///< largest of energy - work + dissipation above its start, of what touches without the
                             ///< dissipation, too; relative to the largest energy
  double energy_defect = 0;  ///< largest change of the same in either direction
  double momentum_defect = std::numeric_limits<double>::quiet_NaN();  ///< of a free motion, relative
  double bound = 0;                                                   ///< largest of the bound's measure
  double error = std::numeric_limits<double>::quiet_NaN();  ///< relative, at the end; NaN: no target, or not reached
  std::array<double, 3> observed{};                         ///< what the target observes, at the end
  Text warning{};                                           ///< the first of RunSummary

  double iterations_per_step() const { return steps > 0 ? static_cast<double>(iterations) / steps : 0; }
};

/// How an outcome is to be taken.
enum class Verdict {
  Right,
  Warned,      ///< the same as Wrong, but the run ended with a warning
  Wrong,       ///< completed, but off its target, out of bounds, or with energy from nowhere
  LeftOut,     ///< the scheme has no <contact>
  Failed,      ///< did not complete
  Diagnosed,   ///< unsound, and refused or ended with a reason
  Unnoticed,   ///< unsound, and completed
  Undiagnosed  ///< unsound, and ended without a word of use
};
Verdict verdict(const HardCase& hard, const HardOutcome& outcome);
/// Why an outcome is wrong; empty if it is not.
std::string flaw(const HardCase& hard, const HardOutcome& outcome);

struct HardOptions {
  std::vector<std::string> schemes = {"em", "em0",     "edmc2", "std",
                                      "m1", "newmark", "hht3"};  ///< the first: the default
  bool quick = false;  ///< five steps of each, to see that it works; targets are not compared
  ProcessLimits limits;
};

/// One run, in a process of its own. `expected`: where the target is; empty: it is not compared.
HardOutcome run_hard(const HardCase& hard, const std::string& scheme, const std::optional<Vector3>& expected,
                     const HardOptions& options);
/// Where the target is, by its closed form or a run; empty if there is none, or its run fails.
std::optional<Vector3> find_target(const HardCase& hard, const HardOptions& options);

struct HardRow {
  HardCase hard;
  std::vector<HardOutcome> outcomes;  ///< in the order of the schemes
};

struct HardReport {
  HardOptions options;
  std::vector<HardRow> rows;
};

/// `progress(part, case)` is called with the part done, in [0, 1].
HardReport measure_hard(const std::vector<HardCase>& cases, const HardOptions& options,
                        const std::function<void(double, const std::string&)>& progress);

/// The tables. `picture`: file name of the picture next to them; empty if there is none.
std::string to_markdown(const HardReport& report, const std::string& picture);
/// A row for each run.
std::string hard_to_csv(const HardReport& report);

}  // namespace flexarm::bench
