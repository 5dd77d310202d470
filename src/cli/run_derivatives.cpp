#include "cli/run_derivatives.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "cli/commands.h"

namespace flexarm::cli {
namespace {

/// Of doubtful events.
constexpr int kMostWarnings = 10;

}  // namespace

void add_derivatives(CLI::App& command, DerivativeOptions& options, CLI::Option* time) {
  command
      .add_option("--sensitivities", options.parameters,
                  "derivatives of the states and outputs at --time with respect to these parameters of the scene")
      ->delimiter(',')
      ->needs(time);
  command
      .add_flag("--transition", options.by_initial_state,
                "derivatives of the states at --time with respect to those of the start")
      ->needs(time);
}

std::unique_ptr<Sensitivities> sensitivities_of(Simulation& simulation, const SceneInput& input,
                                                const DerivativeOptions& options) {
  if (!options.are_wanted()) return nullptr;
  SensitivityRequest request;
  request.parameters = options.parameters;
  request.initial_state = options.by_initial_state;
  request.read = [input](const std::string& parameter, double value) {
    scene::ReadOptions others = input.options;
    others.parameters[parameter] = value;
    return scene::read_scene_file(input.path, others);
  };
  try {
    return std::make_unique<Sensitivities>(simulation, request);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("flexarm: --sensitivities: {}", error.what()));
  }
}

RunDerivatives derivatives_of(const Sensitivities& sensitivities, const LinearModel& model,
                              const DerivativeOptions& options) {
  if (!sensitivities.lost().empty()) throw std::runtime_error("no sensitivities: " + sensitivities.lost());
  RunDerivatives run;
  run.events = sensitivities.events();
  const Eigen::MatrixXd states = sensitivities.states();
  const Eigen::Index count = static_cast<Eigen::Index>(options.parameters.size());
  run.parameters = options.parameters;
  run.states = states.leftCols(count);
  try {
    if (count > 0) run.outputs = sensitivities.outputs(model.outputs).leftCols(count);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("flexarm: {}", error.what()));
  }
  run.initial_states.assign(sensitivities.directions().begin() + count, sensitivities.directions().end());
  run.transition = states.rightCols(states.cols() - count);
  return run;
}

void warn_of_events(const RunDerivatives& run) {
  int hidden = 0, shown = 0;
  for (const RunEvent& event : run.events) {
    if (event.doubt.empty()) continue;
    if (++shown > kMostWarnings)
      ++hidden;
    else
      fmt::print(stderr, "flexarm: warning: sensitivities behind t = {:.9g} s are doubtful: '{}' {}: {}\n", event.time,
                 event.joint, event.what, event.doubt);
  }
  if (hidden > 0) fmt::print(stderr, "flexarm: warning: and {} more such events\n", hidden);
}

void print_derivatives(const RunDerivatives& run, const LinearModel& model, int count) {
  if (run.parameters.empty()) return;
  fmt::print("derivatives with respect to parameters\n{:<32}", "");
  for (const std::string& name : run.parameters) fmt::print(" {:>14}", name);
  fmt::print("\n");
  const auto print = [](const std::string& name, const Eigen::RowVectorXd& row) {
    fmt::print("{:<32}", name);
    for (const double number : row) fmt::print(" {:>14.7g}", number);
    fmt::print("\n");
  };
  for (std::size_t i = 0; i < model.outputs.size(); ++i)
    print(model.outputs[i], run.outputs.row(static_cast<Eigen::Index>(i)));
  const Eigen::Index shown = std::min<Eigen::Index>(run.states.rows(), count);
  for (Eigen::Index i = 0; i < shown; ++i)
    print("state " + model.states[static_cast<std::size_t>(i)], run.states.row(i));
}

}  // namespace flexarm::cli
