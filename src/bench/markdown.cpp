// Writes the properties report as text.
#include <cmath>

#include <fmt/format.h>

#include "bench/markdown_table.h"
#include "bench/report.h"

namespace flexarm::bench {
namespace {

/// Smaller drifts count as conservation: they are round-off and errors of Newton's method over 2000 steps.
constexpr double kConserved = 1e-9;
/// Limit for kinematic identities, which hold up to round-off.
constexpr double kExact = 1e-11;
constexpr double kOrderTolerance = 0.2;

std::string number(double value) {
  return fmt::format("{:.1e}", value);
}
std::string percent(double part) {
  return fmt::format("{:.2g} %", std::abs(part) < kConserved ? 0.0 : 100 * part);
}
/// Text of a cell; bold if the scheme claims the property, with a cross if it then does not have it.
std::string claim(const std::string& text, bool is_claimed, bool is_kept) {
  if (!is_claimed) return text;
  return "**" + text + "**" + (is_kept ? "" : " ✗");
}
std::string failed(const Failure& failure, bool is_claimed) {
  return claim(failure.time > 0 ? fmt::format("fails at t = {:.2g}", failure.time) : "fails at the start", is_claimed,
               false);
}

/// A cell for a quantity that is zero if the scheme has a claimed property.
template <class Value>
std::string zero_cell(const Measured<Value>& measured, double quantity, bool is_claimed, double limit) {
  if (measured.failure) return failed(*measured.failure, is_claimed);
  return claim(number(quantity), is_claimed, quantity < limit);
}
template <class Value>
std::string plain_cell(const Measured<Value>& measured, const std::string& text) {
  return measured.failure ? failed(*measured.failure, false) : text;
}

std::string order_cell(const Properties& p) {
  if (p.order.failure) return failed(*p.order.failure, true);
  return claim(fmt::format("{:.2f}", p.order.value.slope), true,
               std::abs(p.order.value.slope - p.variant.scheme.order) < kOrderTolerance);
}

std::string time_asymmetry_cell(const Properties& p) {
  if (!p.time_asymmetry) return "–";
  return zero_cell(*p.time_asymmetry, p.time_asymmetry->value, p.variant.claims_time_symmetry(), kConserved);
}

std::string drift_cell(const Properties& p, double InvariantDrift::*quantity, bool is_claimed) {
  return zero_cell(p.drift, p.drift.value.*quantity, is_claimed, kConserved);
}

std::vector<std::string> property_cells(const Properties& p, double newmark_seconds) {
  const Scheme& scheme = p.variant.scheme;
  // Schemes with numerical dissipation promise that the energy never grows.
  const bool never_grows = scheme.conserves_energy || scheme.dissipation.any();
  const bool ignores_spin = p.variant.claims_spin_independence();
  const SpinDependence& spin = p.spin_dependence.value;
  return {p.variant.name(),
          order_cell(p),
          plain_cell(p.order, number(p.order.value.error)),
          drift_cell(p, &InvariantDrift::energy, scheme.conserves_energy),
          drift_cell(p, &InvariantDrift::growth, never_grows),
          drift_cell(p, &InvariantDrift::linear_momentum, scheme.conserves_momenta),
          drift_cell(p, &InvariantDrift::angular_momentum, scheme.conserves_momenta),
          time_asymmetry_cell(p),
          claim(number(p.strain_change), p.variant.claims_invariance(), p.strain_change < kExact),
          zero_cell(p.static_path_dependence, p.static_path_dependence.value, p.variant.claims_path_independence(),
                    kConserved),
          zero_cell(p.spin_dependence, spin.twist, ignores_spin, kExact),
          zero_cell(p.spin_dependence, spin.angular_velocity, ignores_spin, kExact),
          plain_cell(p.at_low_frequency, percent(p.at_low_frequency.value.loss_per_period())),
          plain_cell(p.at_high_frequency, fmt::format("{:.2f}", p.at_high_frequency.value.spectral_radius)),
          plain_cell(p.cost, fmt::format("{:.2g}", p.cost.value.seconds / newmark_seconds)),
          plain_cell(p.cost, fmt::format("{:.1f}", p.cost.value.iterations))};
}

std::string property_table(const Report& report) {
  std::string text = head({"scheme", "order", "error", "energy drift", "energy growth", "momentum drift",
                           "angular momentum drift", "time asymmetry", "strain change", "path: static", "spin: twist",
                           "spin: angular velocity", "loss per period", "radius at ωh = 100", "cost", "iterations"});
  double newmark_seconds = 1;
  for (const Properties& p : report.rows)
    if (p.variant.name() == "newmark") newmark_seconds = p.cost.value.seconds;
  for (const Properties& p : report.rows) text += row(property_cells(p, newmark_seconds));
  return text;
}

/// Measured counterpart of Muñoz 2004, table 5.3.
std::string path_table() {
  const auto cell = [](double difference) {
    return (difference < kExact ? "no (" : "**yes** (") + number(difference) + ")";
  };
  std::string text =
      head({"interpolation", "additive update: curvature", "rotation", "spin update: curvature", "rotation"});
  for (const Interpolation interpolation :
       {Interpolation::Total, Interpolation::Incremental, Interpolation::Iterative, Interpolation::Local}) {
    const PathDifference additive = path_dependence(interpolation, RotationUpdate::Additive).largest(),
                         spin = path_dependence(interpolation, RotationUpdate::Spin).largest();
    text += row({to_string(interpolation), cell(additive.curvature), cell(additive.rotation), cell(spin.curvature),
                 cell(spin.rotation)});
  }
  return text;
}

std::string hard_scene_table(const Report& report) {
  std::vector<std::string> columns = {"scheme"};
  for (const HardScene& scene : hard_scenes())
    for (const char* what : {": done", "halved", "iterations", "energy defect"})
      columns.push_back(what[0] == ':' ? scene.name + what : what);
  std::string text = head(columns);
  for (const SchemeReport& scheme : report.schemes) {
    std::vector<std::string> cells = {scheme.name};
    for (const Robustness& r : scheme.robustness) {
      cells.push_back(fmt::format("{}/{}", r.completed, r.runs));
      if (r.completed < r.runs) cells.back() += fmt::format(" ({:.2f})", r.time_reached);
      cells.push_back(percent(r.halved));
      cells.push_back(fmt::format("{:.1f}", r.iterations));
      cells.push_back(number(r.energy_defect));
    }
    text += row(cells);
  }
  return text;
}

const char* const kPropertyLegend = R"(
Column by column (`src/bench`, one file each). Energies and lengths are relative to their largest values; a run that
ends early says when [s].

- **order**: slope of the error over the step, 10 and 5 ms, of points of a loaded tree of beams and bodies with revolute
  and spherical joints, against a limit extrapolated from 2.5 and 1.25 ms of the same scheme. **error**: at 20 ms.
- **energy, momentum, angular momentum drift**: largest change over a free flight of the same tree, 2000 steps of 10 ms.
  **energy growth**: largest rise of the energy above an earlier value; round-off where it never grows. The energy of
  the dissipative schemes contains what their memory of past strains stores.
- **time asymmetry**: the same flight, 40 steps of 50 ms, velocities reversed, 40 steps: distance from the start. Not
  defined (–) for schemes with a memory.
- **strain change**: how much the curvature of a bent element changes when its motion, two steps of two iterates each,
  is superposed by a rigid rotation.
- **path: static**: distance between the tips of a loaded cantilever in equilibrium, found in 1, 4 and 16 load steps.
- **spin**: change of the twist, and of the difference of the angular velocities, of a free two-node bar that twists to
  and fro, when it spins as a whole by half a radian a step.
- **loss per period**: part of the energy that an undamped oscillator loses in a period of 21 steps (ωh = 0.3);
  **radius**: factor of its amplitude per step at ωh = 100.
- **cost**: processor time per step relative to `newmark`, **iterations** of Newton's method per step: an arm of three
  beams of eight elements, steps of 2 ms. Times are the only figures that another run changes.
)";

const char* const kPathLegend = R"(
## Path dependence

Do the points of a three-node element depend on the way by which its nodes came to their rotations: in 1, 2 or 8
increments, by 1 or 4 iterates? Largest angle [rad] and relative difference of curvatures: Muñoz' table 5.3, measured.
Below it the local interpolation.

)";

const char* const kHardSceneLegend = R"(
## Hard scenes

Default options, tolerance 10⁻⁸, at most five halvings; five runs each, steps of 3, 5, 7, 10 and 14 ms. Runs that came
to the end (and the mean part of the time that was reached), part of the steps that were halved, Newton iterations per
step, largest error of energy - work + dissipation.

- **whip**: a beam with EA/(EI/L²) = 10⁶, stretched by a heavy ball, whipped, then let go at 0.3 s: it goes slack.
- **whip pulled again**: from 0.5 s on the ball is pulled again, and the slack beam snaps taut.
- **damped chain**: four stiff links on universal and revolute joints with strong dampers, dropped.
- **release**: a bent cantilever, let go at once.

)";

}  // namespace

std::string to_markdown(const Report& report, const std::string& picture) {
  std::string text = "# Properties of the time integration schemes\n\n";
  text += report.quick ? "Written by `flexarm bench properties --quick`: a test of the command, not a measurement.\n"
                       : "Written by `flexarm bench properties`.\n";
  text += "**Bold**: the scheme claims it (its order, zero). ✗: and does not keep it.\n\n";
  text += property_table(report) + kPropertyLegend + kPathLegend + path_table() + kHardSceneLegend;
  text += hard_scene_table(report);
  if (!picture.empty())
    text += fmt::format(
        "\n## Numerical dissipation\n\nOf an oscillator without damping, over angular frequency times step.\n\n"
        "![Amplitude factor per step and energy lost per period]({})\n",
        picture);
  return text;
}

}  // namespace flexarm::bench
