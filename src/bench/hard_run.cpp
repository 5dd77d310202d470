#include <algorithm>
#include <cstring>
#include <new>

#include "accuracy/processor_time.h"
#include "bench/hard.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/run_summary.h"
#include "simulation/inside.h"

namespace flexarm::bench {
namespace {

constexpr int kQuickSteps = 5;
/// Limits for created energy and for energy lost by the scheme's dissipation, relative to the largest energy of the
/// motion; and for changes of the momenta in a free motion, relative to these momenta.
constexpr double kLargestGain = 0.05, kLargestLoss = 1, kLargestMomentumDefect = 0.05;
/// Limit for created energy in contacts: round-off of halved steps, and errors of Newton's method relative to a tiny
/// body's depth.
constexpr double kLargestContactGain = 1e-4;

void write(HardOutcome::Text& text, const std::string& from) {
  text.fill(0);
  std::strncpy(text.data(), from.c_str(), text.size() - 1);
}

void note(HardOutcome& outcome, HardOutcome::End end, const std::string& reason, bool says_why = true) {
  outcome.end = end;
  outcome.says_why = says_why;
  write(outcome.reason, reason);
}

/// The first error of a scene that cannot be read.
std::string first_error(const scene::Diagnostics& findings) {
  for (const scene::Diagnostic& finding : findings)
    if (finding.severity == scene::Diagnostic::Severity::Error) return finding.text();
  return "cannot be read";
}

double total_mass(const Model& model) {
  double mass = 0;
  for (const NodalInertia& inertia : model.inertias) mass += inertia.total_mass;
  return mass;
}

/// Keeps the largest changes of quantities that a motion should conserve. If one is NaN, it stays NaN.
class Accounts {
 public:
  Accounts(const Simulation& simulation, const HardCase& hard)
      : is_free_(hard.is_free),
        touches_(hard.touches),
        mass_(total_mass(model_of(simulation))),
        start_(simulation.energies()),
        linear_(simulation.momentum()),
        angular_(simulation.angular_momentum()) {}

  void add(const Simulation& simulation, HardOutcome& outcome) {
    const Energies e = simulation.energies();
    const double change = (e.total() - e.work + e.dissipated) - (start_.total() - start_.work + start_.dissipated);
    scale_ = largest({scale_, start_.kinetic, start_.strain, e.kinetic, e.strain,
                      std::abs(e.potential - start_.potential), std::abs(e.work)});
    gain_ = largest({gain_, change});
    if (touches_) gain_ = largest({gain_, change - (e.dissipated - start_.dissipated)});
    defect_ = largest({defect_, std::abs(change)});
    outcome.energy_gain = relative(gain_, scale_);
    outcome.energy_defect = relative(defect_, scale_);
    if (!is_free_) return;
    const double kinetic = std::max(start_.kinetic, e.kinetic);
    momentum_ = largest({momentum_, relative((simulation.momentum() - linear_).norm(), std::sqrt(2 * mass_ * kinetic)),
                         relative((simulation.angular_momentum() - angular_).norm(), angular_.norm())});
    outcome.momentum_defect = momentum_;
  }

 private:
  static double largest(std::initializer_list<double> values) {
    double out = 0;
    for (const double value : values)
      if (!(value <= out)) out = value;
    return out;
  }
  static double relative(double value, double scale) { return value == 0 ? 0 : value / scale; }

  bool is_free_, touches_;
  double mass_;
  Energies start_;
  Vector3 linear_, angular_;
  double scale_ = 0, gain_ = 0, defect_ = 0, momentum_ = 0;
};

void count(HardOutcome& outcome, const StepResult& result) {
  ++outcome.steps;
  outcome.iterations += result.iterations;
  outcome.halvings += result.halvings;
  outcome.most_iterations = std::max(outcome.most_iterations, result.iterations);
}

void note_failure(HardOutcome& outcome, const StepResult& result) {
  note(outcome, HardOutcome::End::Failed, to_string(result.reason), result.reason != StepResult::Reason::NoConvergence);
}

/// The work of the child process.
class Play {
 public:
  Play(const HardCase& hard, const HardOptions& options, HardOutcome& outcome)
      : hard_(hard), options_(options), outcome_(outcome), begin_(processor_seconds()) {}

  void run(const std::string& scheme, double step) {
    try {
      const scene::ReadResult read = scene::read_scene_text(hard_.scene, hard_.name);
      if (!read.scene) return note(outcome_, HardOutcome::End::Refused, first_error(read.diagnostics));
      SimulationOptions settings;
      settings.scheme = scheme;
      settings.step = step;
      Simulation simulation(*read.scene, settings);
      if (hard_.load_steps > 0 ? find_equilibrium(simulation) : go_through(simulation, step)) finish(simulation);
    } catch (const ModelError& error) {
      note(outcome_, HardOutcome::End::Refused, error.what());
    } catch (const std::bad_alloc&) {
      note(outcome_, HardOutcome::End::OutOfMemory, "out of memory");
    } catch (const std::exception& error) {
      note(outcome_, HardOutcome::End::Crashed, std::string("exception: ") + error.what(), false);
    }
    outcome_.seconds = processor_seconds() - begin_;
  }

 private:
  bool find_equilibrium(Simulation& simulation) {
    const StepResult result = simulation.solve_static(hard_.load_steps);
    count(outcome_, result);
    outcome_.steps = hard_.load_steps;
    if (!result.converged) note_failure(outcome_, result);
    watch(simulation);
    return result.converged;
  }

  bool go_through(Simulation& simulation, double step) {
    Accounts accounts(simulation, hard_);
    RunSummary summary(simulation);
    const long wanted = options_.quick ? kQuickSteps : std::lround(hard_.until / step);
    for (long n = 0; n < wanted; ++n) {
      const StepResult result = simulation.step();
      count(outcome_, result);
      summary.count(simulation, result);
      outcome_.time = simulation.time();
      outcome_.seconds = processor_seconds() - begin_;
      if (!result.converged) return note_failure(outcome_, result), false;
      accounts.add(simulation, outcome_);
      watch(simulation);
    }
    summary.look(simulation);
    if (const auto warnings = summary.warnings(simulation); !warnings.empty())
      write(outcome_.warning, warnings.front());
    return true;
  }

  void watch(const Simulation& simulation) {
    if (!hard_.bound) return;
    const double measure = hard_.bound->measure(simulation);
    if (!(measure <= outcome_.bound)) outcome_.bound = measure;
  }

  void finish(const Simulation& simulation) {
    outcome_.end = HardOutcome::End::Completed;
    if (hard_.target) Eigen::Map<Vector3>(outcome_.observed.data()) = hard_.target->observe(simulation);
  }

  const HardCase& hard_;
  const HardOptions& options_;
  HardOutcome& outcome_;
  double begin_;
};

HardOutcome run_apart(const HardCase& hard, const std::string& scheme, double step, const HardOptions& options) {
  Shared<HardOutcome> outcome;
  note(*outcome, HardOutcome::End::Crashed, "");
  const ChildEnd end = run_in_child([&] { Play(hard, options, *outcome).run(scheme, step); }, options.limits);
  if (end.ran_out_of_time) {
    note(*outcome, HardOutcome::End::OutOfTime, "not done in " + std::to_string(options.limits.seconds) + " s", false);
    outcome->seconds = options.limits.seconds;
  } else if (end.signal != 0) {
    note(*outcome, HardOutcome::End::Crashed, strsignal(end.signal), false);
  }
  return *outcome;
}

Vector3 observed(const HardOutcome& outcome) {
  return Eigen::Map<const Vector3>(outcome.observed.data());
}

/// Relative error of the observed quantity; infinite if the latter is NaN.
double error_of(const HardOutcome& outcome, const Vector3& expected, double scale) {
  const double error = (observed(outcome) - expected).norm() / scale;
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

}  // namespace

HardOutcome run_hard(const HardCase& hard, const std::string& scheme, const std::optional<Vector3>& expected,
                     const HardOptions& options) {
  HardOutcome outcome = run_apart(hard, scheme, hard.step, options);
  if (expected && outcome.end == HardOutcome::End::Completed)
    outcome.error = error_of(outcome, *expected, hard.target->scale);
  return outcome;
}

std::optional<Vector3> find_target(const HardCase& hard, const HardOptions& options) {
  if (!hard.target || options.quick) return std::nullopt;
  if (hard.target->expected) return hard.target->expected;
  HardCase reference = hard;
  if (!hard.target->scene.empty()) reference.scene = hard.target->scene;
  const HardOutcome outcome = run_apart(reference, "em", hard.target->step, options);
  if (outcome.end != HardOutcome::End::Completed) return std::nullopt;
  return observed(outcome);
}

std::string flaw(const HardCase& hard, const HardOutcome& outcome) {
  if (outcome.end != HardOutcome::End::Completed) return "";
  if (hard.target && !std::isnan(outcome.error) && !(outcome.error <= hard.target->tolerance))
    return "off its target (" + hard.target->what + ")";
  if (hard.bound && !(outcome.bound <= 1)) return hard.bound->what;
  if (!(outcome.energy_gain <= (hard.touches ? kLargestContactGain : kLargestGain))) return "energy from nowhere";
  if (!(outcome.energy_defect <= kLargestLoss)) return "more energy lost than there was";
  if (hard.is_free && !(outcome.momentum_defect <= kLargestMomentumDefect)) return "momentum lost";
  return "";
}

/// Whether a scheme refuses a scene because it does not support contacts or tendons.
bool is_left_out(const HardOutcome& outcome) {
  const char* reason = outcome.reason.data();
  return outcome.end == HardOutcome::End::Refused && std::strstr(reason, "scheme") &&
         (std::strstr(reason, "has no <") || std::strstr(reason, "have no <"));
}

Verdict verdict(const HardCase& hard, const HardOutcome& outcome) {
  const bool is_complete = outcome.end == HardOutcome::End::Completed;
  if (is_left_out(outcome)) return Verdict::LeftOut;
  if (hard.is_sound)
    return !is_complete                  ? Verdict::Failed
           : flaw(hard, outcome).empty() ? Verdict::Right
           : outcome.warning[0] != 0     ? Verdict::Warned
                                         : Verdict::Wrong;
  if (is_complete) return Verdict::Unnoticed;
  return outcome.says_why ? Verdict::Diagnosed : Verdict::Undiagnosed;
}

HardReport measure_hard(const std::vector<HardCase>& cases, const HardOptions& options,
                        const std::function<void(double, const std::string&)>& progress) {
  HardReport report{options, {}};
  const double whole = static_cast<double>(cases.size() * options.schemes.size());
  double done = 0;
  for (const HardCase& hard : cases) {
    progress(done / whole, hard.name);
    HardRow row{hard, {}};
    const std::optional<Vector3> expected = find_target(hard, options);
    for (const std::string& scheme : options.schemes) {
      row.outcomes.push_back(run_hard(hard, scheme, expected, options));
      progress(++done / whole, hard.name);
    }
    report.rows.push_back(std::move(row));
  }
  return report;
}

}  // namespace flexarm::bench
